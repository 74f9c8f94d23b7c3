#include "host/intersect/core/linked_core.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <string>
#include <utility>

#include "host/base/input_error.h"

namespace raygate {
namespace {

constexpr std::size_t kResultWords = 8;

void send_all(WordLink& link, std::span<const std::uint32_t> words) {
  for (const std::uint32_t word : words) {
    while (!link.send(word)) link.wait();
  }
}

/// See open_serial_link.
class SerialLink : public WordLink {
 public:
  explicit SerialLink(std::filesystem::path port)
      : port_(std::move(port)),
        file_(open(port_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    termios settings{};
    if (file_ < 0) fail(std::strerror(errno));
    if (tcgetattr(file_, &settings) != 0) {
      const std::string what = errno == ENOTTY ? "expected a serial port" : std::strerror(errno);
      close(file_);
      fail(what);
    }
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    cfsetspeed(&settings, B2000000);
    tcsetattr(file_, TCSANOW, &settings);
  }

  SerialLink(const SerialLink&) = delete;
  SerialLink& operator=(const SerialLink&) = delete;
  ~SerialLink() override { close(file_); }

  bool send(std::uint32_t word) override {
    if (out_.size() + 4 > kBuffer) return false;
    for (unsigned byte = 0; byte < 4; ++byte) {
      out_.push_back(static_cast<unsigned char>(word >> 8 * byte));
    }
    return true;
  }

  std::optional<std::uint32_t> receive() override {
    if (in_.size() < 4) return std::nullopt;
    std::uint32_t word = 0;
    for (unsigned byte = 0; byte < 4; ++byte) word |= std::uint32_t{in_[byte]} << 8 * byte;
    in_.erase(in_.begin(), in_.begin() + 4);
    return word;
  }

  void wait() override {
    pollfd ready{.fd = file_, .events = POLLIN, .revents = 0};
    if (!out_.empty()) ready.events |= POLLOUT;
    const int found = poll(&ready, 1, 1'000 * kPatience);
    if (found < 0 && errno != EINTR) fail(std::strerror(errno));
    if (found == 0) fail("no word of the board for " + std::to_string(kPatience) + " s");
    if ((ready.revents & POLLIN) != 0) read_some();
    if ((ready.revents & POLLOUT) != 0) write_some();
    if ((ready.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) fail("the board is gone");
  }

  void restart() override {
    out_.clear();
    tcflush(file_, TCIOFLUSH);
    if (tcsendbreak(file_, 0) != 0) fail(std::strerror(errno));
    pollfd ready{.fd = file_, .events = POLLIN, .revents = 0};
    for (int reads = 0; poll(&ready, 1, kQuiet) > 0; ++reads) {
      if (reads == 1'000) fail("found input after a break, expected a board that waits");
      read_some();
    }
    in_.clear();
  }

 private:
  static constexpr int kPatience = 30;
  static constexpr int kQuiet = 100;            // ms without input after a break
  static constexpr std::size_t kBuffer = 4096;  // capacity of out_ in bytes

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(port_.string() + ": " + what);
  }

  /// Returns the byte count of a read or write; 0 if it must be repeated. Throws for other errors.
  [[nodiscard]] std::ptrdiff_t checked(std::ptrdiff_t count) const {
    if (count < 0 && errno != EAGAIN && errno != EINTR) fail(std::strerror(errno));
    return std::max<std::ptrdiff_t>(count, 0);
  }

  void write_some() {
    out_.erase(out_.begin(), out_.begin() + checked(write(file_, out_.data(), out_.size())));
  }

  void read_some() {
    std::array<unsigned char, 4096> bytes{};
    in_.insert(in_.end(), bytes.begin(),
               bytes.begin() + checked(read(file_, bytes.data(), bytes.size())));
  }

  std::filesystem::path port_;
  int file_;
  std::deque<unsigned char> in_;
  std::vector<unsigned char> out_;
};

}  // namespace

std::array<std::uint32_t, 11> ray_message(const CoreRay& ray) {
  std::array<std::uint32_t, 11> message{};
  PackedFields fields(message);
  fields.put((4u | (ray.any_hit ? 1u : 0u)) << 28);
  for (const std::uint32_t word : {ray.tag, ray.source_id, ray.skip_id}) fields.put(word);
  fields.put(std::bit_cast<std::uint32_t>(ray.t_max));
  fields.put(ray.ray.direction);
  fields.put(ray.ray.origin);
  return message;
}

void LinkedCore::load(std::span<const MemoryLine> lines) {
  const auto same = [](const MemoryLine& a, const MemoryLine& b) { return a.words == b.words; };
  if (!memory_.empty() && std::ranges::equal(lines, memory_, same)) return;
  memory_.assign(lines.begin(), lines.end());
  for (std::uint32_t number = 0; number < lines.size(); ++number) {
    const std::uint32_t head = 1u << 28 | number;
    send_all(*link_, {&head, 1});
    send_all(*link_, lines[number].words);
  }
  // Tells the core that its memory has changed.
  const std::uint32_t changed = 2u << 28 | static_cast<std::uint32_t>(lines.size());
  send_all(*link_, {&changed, 1});
}

std::size_t LinkedCore::take_results(std::vector<CoreResult>& results) {
  std::size_t ended = 0;
  while (const std::optional<std::uint32_t> word = link_->receive()) {
    words_.push_back(*word);
    if (words_.size() < kResultWords) continue;
    const CoreResult& result = results.emplace_back(unpack_result(words_));
    words_.clear();
    const bool is_end = result.kind == CoreResult::Kind::kEnd;
    ended += is_end ? 1 : 0;
    counters_.edge_doubts += is_end ? 0 : 1;
    counters_.tests += is_end ? result.tests : 0;
  }
  counters_.rays += ended;
  return ended;
}

void LinkedCore::trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
                       std::vector<CoreResult>& results) {
  load(lines);
  const std::uint64_t begin = link_->clocks();
  std::size_t sent = 0, ended = 0;
  std::vector<std::uint32_t> out;  // words of the ray being sent, in reverse
  for (;;) {
    ended += take_results(results);  // comes first, because results free capacity for rays
    if (ended == rays.size()) break;
    if (out.empty() && sent < rays.size() && sent - ended < most_) {
      const auto message = ray_message(rays[sent++]);
      out.assign(message.rbegin(), message.rend());
    }
    if (!out.empty() && link_->send(out.back())) out.pop_back();
    link_->wait();
  }
  counters_.clocks += link_->clocks() - begin;
}

std::unique_ptr<WordLink> open_serial_link(const std::filesystem::path& port) {
  return std::make_unique<SerialLink>(port);
}

}  // namespace raygate
