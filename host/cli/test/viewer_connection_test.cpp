// --display-server: what a viewer of tev's protocol gets.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <future>
#include <map>

#include "host/cli/test/render_run.h"
#include "host/film/exr.h"

namespace raygate {
namespace {

/// A viewer on a port of its own, which takes one connection.
class Viewer {
 public:
  Viewer() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const at = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(socket_, at, size), 0);
    EXPECT_EQ(listen(socket_, 1), 0);
    EXPECT_EQ(getsockname(socket_, at, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~Viewer() { close(socket_); }

  [[nodiscard]] std::string address() const { return "localhost:" + std::to_string(port_); }

  /// All that comes, up to so many bytes.
  std::string take(std::size_t most = std::string::npos) const {
    const int connection = accept(socket_, nullptr, nullptr);
    std::string all;
    char part[65536];
    for (ssize_t size = 0; all.size() < most && (size = read(connection, part, sizeof part)) > 0;) {
      all.append(part, static_cast<std::size_t>(size));
    }
    close(connection);
    return all;
  }

 private:
  int socket_ = socket(AF_INET, SOCK_STREAM, 0), port_ = 0;
};

/// A packet's fields, one after the other.
struct Fields {
  std::string_view left;

  template <class T>
  T next() {
    T value{};
    EXPECT_LE(sizeof value, left.size());
    std::memcpy(&value, left.data(), sizeof value);
    left.remove_prefix(sizeof value);
    return value;
  }
  std::string text() {
    std::string found(left.substr(0, left.find('\0')));
    left.remove_prefix(found.size() + 1);
    return found;
  }
};

/// What the viewer shows in the end: of each channel, its numbers.
std::map<std::string, std::vector<float>> shown(std::string_view packets, int width, int height) {
  std::map<std::string, std::vector<float>> picture;
  while (!packets.empty()) {
    const auto length = Fields{packets}.next<std::uint32_t>();
    Fields fields{packets.substr(4, length - 4)};
    packets.remove_prefix(length);
    const int type = fields.next<char>();
    fields.next<char>();
    EXPECT_EQ(fields.text(), "cornell.obj");
    std::int32_t place[4] = {0, 0, width, height};
    if (type == 4) {
      EXPECT_TRUE(picture.empty());
      EXPECT_EQ(fields.next<std::int32_t>(), width);
      EXPECT_EQ(fields.next<std::int32_t>(), height);
    }
    std::vector<std::string> names(fields.next<std::uint32_t>());
    for (std::string& name : names) name = fields.text();
    if (type == 4) {
      for (const std::string& name : names) picture[name].resize(std::size_t(width) * height);
      continue;
    }
    EXPECT_EQ(type, 6);
    for (std::int32_t& number : place) number = fields.next<std::int32_t>();
    std::vector<std::int64_t> first(names.size()), stride(names.size());
    for (std::int64_t& number : first) number = fields.next<std::int64_t>();
    for (std::int64_t& number : stride) number = fields.next<std::int64_t>();
    for (std::size_t k = 0; k < names.size(); ++k) {
      for (std::int64_t i = 0; i < std::int64_t{place[2]} * place[3]; ++i) {
        Fields number{fields.left.substr(4 * static_cast<std::size_t>(first[k] + i * stride[k]))};
        const auto at = (place[1] + i / place[2]) * width + place[0] + i % place[2];
        picture.at(names[k]).at(static_cast<std::size_t>(at)) = number.next<float>();
      }
    }
  }
  return picture;
}

class ViewerConnection : public Render {
 protected:
  static std::vector<std::string> command(const std::string& address, const std::string& size) {
    return {kCornell, "--engine=cpu", "--size", size, "--display-server=" + address};
  }
};

TEST_F(ViewerConnection, ShowsWhatTheFileHas) {
  const Viewer viewer;
  auto packets = std::async(std::launch::async, [&] { return viewer.take(); });
  render(command(viewer.address(), "40x100"));
  const std::string all = packets.get();
  const auto picture = shown(all, 40, 100);
  const std::vector<std::string> names = {"R", "G", "B", "A", "Z", "id"};
  const ChannelPicture file = read_exr(folder_.path() / "cornell.exr", names);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::vector<float>& channel = picture.at(names[k]);
    EXPECT_TRUE(std::ranges::equal(channel, file.channels[k], {}, {}, [](double value) {
      return static_cast<float>(value);
    })) << names[k];
  }
}

TEST_F(ViewerConnection, OneThatGoesAwayIsWarnedAbout) {
  const Viewer viewer;
  auto packets = std::async(std::launch::async, [&] { return viewer.take(1); });
  // More than the system keeps for a reader.
  const Outcome outcome = render(command(viewer.address(), "640x480"));
  EXPECT_NE(outcome.err.find("warning: --display-server: "), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "cornell.exr"));
}

TEST_F(ViewerConnection, WhereNobodyListensIsOneLine) {
  const auto said = [&](const std::string& address) {
    const Outcome outcome =
        run_program({.arguments = command(address, "8x8"), .folder = folder_.path()});
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  EXPECT_NE(said("localhost:1").find("expected a viewer such as tev that listens there"),
            std::string::npos);
  EXPECT_NE(said("localhost").find("expected HOST:PORT"), std::string::npos);
}

}  // namespace
}  // namespace raygate
