#include "host/intersect/core/linked_core.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "host/base/input_error.h"

namespace raygate {
namespace {

void send_all(WordLink& link, std::span<const std::uint32_t> words) {
  for (const std::uint32_t word : words) {
    while (!link.send(word)) link.wait();
  }
}

}  // namespace

void LinkedCore::load(std::span<const MemoryLine> lines) {
  const auto same = [](const MemoryLine& a, const MemoryLine& b) { return a.words == b.words; };
  if (!memory_.empty() && std::ranges::equal(lines, memory_, same)) return;
  memory_.assign(lines.begin(), lines.end());
  for (std::uint32_t number = 0; number < lines.size(); ++number) {
    send_all(*link_, line_message(number, lines[number]));
  }
  const std::uint32_t changed = lines_message(static_cast<std::uint32_t>(lines.size()));
  send_all(*link_, {&changed, 1});
}

std::optional<CoreResult> LinkedCore::take_result() {
  while (const std::optional<std::uint32_t> word = link_->receive()) {
    words_.push_back(*word);
    if (words_.size() < std::tuple_size_v<ResultWords>) continue;
    const CoreResult result = unpack_result(words_);
    words_.clear();
    return result;
  }
  return std::nullopt;
}

void LinkedCore::count(const CoreResult& result) {
  switch (result.kind) {
    case CoreResult::Kind::kEnd:
      ++counters_.rays;
      counters_.triangles += result.tests;
      break;
    case CoreResult::Kind::kDoubt:
      ++counters_.doubts;
      break;
  }
}

void LinkedCore::trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
                       std::vector<CoreResult>& results) {
  load(lines);
  const std::uint64_t begin = link_->clocks();
  std::size_t sent = 0, ended = 0;
  std::vector<std::uint32_t> out;  // words of the ray being sent, in reverse
  for (;;) {
    // Results first: they free capacity for rays.
    while (const std::optional<CoreResult> result = take_result()) {
      count(*result);
      ended += result->kind == CoreResult::Kind::kEnd;
      results.push_back(*result);
    }
    if (ended == rays.size()) break;
    if (out.empty() && sent < rays.size() && sent - ended < most_) {
      const RayMessage message = ray_message(rays[sent++]);
      out.assign(message.rbegin(), message.rend());
    }
    if (!out.empty() && link_->send(out.back())) out.pop_back();
    link_->wait();
  }
  counters_.clocks += link_->clocks() - begin;
}

SerialLink::SerialLink(std::filesystem::path port)
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

SerialLink::~SerialLink() { close(file_); }

void SerialLink::fail(const std::string& what) const {
  throw InputError(port_.string() + ": " + what);
}

bool SerialLink::send(std::uint32_t word) {
  if (out_.size() + 4 > kBuffer) return false;
  for (unsigned byte = 0; byte < 4; ++byte) {
    out_.push_back(static_cast<unsigned char>(word >> 8 * byte));
  }
  return true;
}

std::optional<std::uint32_t> SerialLink::receive() {
  if (in_.size() - taken_ < 4) return std::nullopt;
  std::uint32_t word = 0;
  for (unsigned byte = 0; byte < 4; ++byte) word |= std::uint32_t{in_[taken_++]} << 8 * byte;
  if (taken_ == in_.size()) {
    in_.clear();
    taken_ = 0;
  }
  return word;
}

void SerialLink::wait() {
  pollfd ready{.fd = file_, .events = POLLIN, .revents = 0};
  if (!out_.empty()) ready.events |= POLLOUT;
  const int found = poll(&ready, 1, 1'000 * kPatience);
  if (found < 0 && errno != EINTR) fail(std::strerror(errno));
  if (found == 0) fail("no word of the board for " + std::to_string(kPatience) + " s");
  if ((ready.revents & POLLIN) != 0) read_some();
  if ((ready.revents & POLLOUT) != 0) write_some();
  if ((ready.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) fail("the board is gone");
}

void SerialLink::restart() {
  out_.clear();
  tcflush(file_, TCIOFLUSH);
  if (tcsendbreak(file_, 0) != 0) fail(std::strerror(errno));
  pollfd ready{.fd = file_, .events = POLLIN, .revents = 0};
  for (int reads = 0; poll(&ready, 1, kQuiet) > 0; ++reads) {
    if (reads == 1'000) fail("found input after a break, expected a board that waits");
    read_some();
  }
  in_.clear();
  taken_ = 0;
}

void SerialLink::write_some() {
  const ssize_t count = write(file_, out_.data(), out_.size());
  if (count < 0 && errno != EAGAIN && errno != EINTR) fail(std::strerror(errno));
  if (count > 0) out_.erase(out_.begin(), out_.begin() + count);
}

void SerialLink::read_some() {
  std::array<unsigned char, 4096> bytes{};
  const ssize_t count = read(file_, bytes.data(), bytes.size());
  if (count < 0 && errno != EAGAIN && errno != EINTR) fail(std::strerror(errno));
  if (count > 0) in_.insert(in_.end(), bytes.begin(), bytes.begin() + count);
}

}  // namespace raygate
