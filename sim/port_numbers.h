// Layout of numbers in the ports of Verilated models.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace raygate {

/// Returns the address of slot `n` of a port with `size` bytes per slot. Requires a little-endian
/// host: Verilator stores the lowest bits at the lowest address.
template <class Port>
char* slot(Port& port, int n, std::size_t size) {
  static_assert(std::endian::native == std::endian::little);
  return reinterpret_cast<char*>(&port) + size * static_cast<std::size_t>(n);
}

/// Packs binary32 numbers: floats pass unchanged. host/variants packs other formats.
struct Binary32Numbers {
  /// Writes `count` numbers to the slot of lane `lane`; every lane's slot has `count` numbers.
  template <class Port>
  void write(Port& port, int lane, const float* x, int count) const {
    const std::size_t size = sizeof(float) * static_cast<std::size_t>(count);
    std::memcpy(slot(port, lane, size), x, size);
  }
  template <class Port>
  void read(Port& port, int lane, float* x, int count) const {
    const std::size_t size = sizeof(float) * static_cast<std::size_t>(count);
    std::memcpy(x, slot(port, lane, size), size);
  }

  [[nodiscard]] std::uint32_t to_word(float x) const { return std::bit_cast<std::uint32_t>(x); }
  [[nodiscard]] float from_word(std::uint32_t word) const { return std::bit_cast<float>(word); }
};

}  // namespace raygate
