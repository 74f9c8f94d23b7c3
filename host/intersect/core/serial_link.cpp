#include "host/intersect/core/serial_link.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "host/base/input_error.h"

namespace raygate {
namespace {

// As many words of zero end whatever message was cut off, and say nothing themselves.
constexpr std::size_t kLongestMessage = 17;

}  // namespace

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
  tcflush(file_, TCIOFLUSH);
  out_.assign(4 * kLongestMessage, 0);
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
