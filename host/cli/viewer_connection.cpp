#include "host/cli/viewer_connection.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include "host/base/input_error.h"
#include "host/cli/process.h"
#include "host/options/option_table.h"

namespace raygate {
namespace {

enum class PacketType : std::uint8_t { kCreateImage = 4, kUpdateImage = 6 };

constexpr int kRows = 64;  // a packet, so that a viewer begins to show before all is there
constexpr timeval kPatience{.tv_sec = 10, .tv_usec = 0};

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are in memory");

template <class T>
void append(std::string& packet, const T& value) {
  packet.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Type, whether the viewer shall turn to it, and the picture's name.
std::string packet_of(PacketType type, bool turn_to, const std::string& name) {
  std::string packet(1, static_cast<char>(type));
  append(packet, turn_to);
  packet.append(name).push_back('\0');
  return packet;
}

void append_names(std::string& packet, const std::vector<Channel>& channels) {
  for (const Channel& channel : channels) packet.append(channel.name).push_back('\0');
}

float value_of(const Channel& channel, std::size_t pixel) {
  const char* const at = static_cast<const char*>(channel.first) + pixel * channel.stride;
  if (channel.type == Channel::Type::kUint) {
    std::uint32_t value = 0;
    std::memcpy(&value, at, sizeof value);
    return static_cast<float>(value);
  }
  float value = 0.0f;
  std::memcpy(&value, at, sizeof value);
  return value;
}

}  // namespace

ViewerConnection::ViewerConnection(const std::string& address) : address_(address) {
  const std::size_t colon = std::min(address.rfind(':'), address.size());
  const std::string host = address.substr(0, colon);
  const std::string port = colon == address.size() ? "" : address.substr(colon + 1);
  if (host.empty() || port.empty()) fail_value("--display-server", address, "HOST:PORT");
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int status = getaddrinfo(host.c_str(), port.c_str(), &hints, &found);
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> list(found, freeaddrinfo);
  std::string why = status != 0 ? gai_strerror(status) : "";
  for (const addrinfo* at = found; status == 0 && at != nullptr; at = at->ai_next) {
    socket_ = socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, at->ai_protocol);
    if (socket_ < 0) continue;
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
    if (connect(socket_, at->ai_addr, at->ai_addrlen) == 0) return;
    why = std::strerror(errno);
    close(socket_);
  }
  fail_value("--display-server", address, "a viewer such as tev that listens there (" + why + ")");
}

ViewerConnection::~ViewerConnection() {
  if (socket_ >= 0) close(socket_);
}

void ViewerConnection::show(const Film& film, const std::string& name) {
  const std::vector<Channel> channels = channels_of(film);
  const auto count = static_cast<std::int32_t>(channels.size());
  const int width = film.window.width(), height = film.window.height();
  if (created_ != name) {
    std::string packet = packet_of(PacketType::kCreateImage, true, name);
    append(packet, std::int32_t{width});
    append(packet, std::int32_t{height});
    append(packet, count);
    append_names(packet, channels);
    send(std::move(packet));
    created_ = name;
  }
  for (int y = 0; y < height && socket_ >= 0; y += kRows) {
    const int rows = std::min(kRows, height - y);
    const std::size_t first = std::size_t(y) * width, pixels = std::size_t(rows) * width;
    std::string packet = packet_of(PacketType::kUpdateImage, false, name);
    append(packet, count);
    append_names(packet, channels);
    for (const std::int32_t number : {0, y, width, rows}) append(packet, number);
    // Where a channel begins, and how far apart its numbers are: one after the other.
    for (std::int32_t k = 0; k < count; ++k) append(packet, static_cast<std::int64_t>(k * pixels));
    for (std::int32_t k = 0; k < count; ++k) append(packet, std::int64_t{1});
    for (const Channel& channel : channels) {
      for (std::size_t i = 0; i < pixels; ++i) append(packet, value_of(channel, first + i));
    }
    send(std::move(packet));
  }
}

void ViewerConnection::send(std::string packet) {
  if (socket_ < 0) return;
  const auto length = static_cast<std::uint32_t>(sizeof(std::uint32_t) + packet.size());
  packet.insert(0, reinterpret_cast<const char*>(&length), sizeof length);
  for (std::size_t sent = 0; sent < packet.size();) {
    const ssize_t part = ::send(socket_, packet.data() + sent, packet.size() - sent, MSG_NOSIGNAL);
    if (part < 0 && errno == EINTR) continue;
    if (part <= 0) {
      print_warning("--display-server: " + address_ +
                    " takes no more of the picture: " + std::strerror(errno));
      close(socket_);
      socket_ = -1;
      return;
    }
    sent += static_cast<std::size_t>(part);
  }
}

}  // namespace raygate
