// Linked core: a ray core with its own memory, behind a word link.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "host/intersect/core/core_unit.h"

namespace raygate {

/// Reads and writes the fields of a packed struct in 32-bit words, lowest bits first: the last
/// field of the struct comes first. `Words` has an operator [].
template <class Words>
class PackedFields {
 public:
  explicit PackedFields(Words& words) : words_(words) {}

  /// Writes the next field of `width` bits, at most 32. The bits must be 0 before.
  void put(std::uint32_t value, unsigned width = 32) {
    const std::uint64_t two = std::uint64_t{value} << at_ % 32;
    words_[at_ / 32] |= static_cast<std::uint32_t>(two);
    if (two >> 32 != 0) words_[at_ / 32 + 1] |= static_cast<std::uint32_t>(two >> 32);
    at_ += width;
  }
  void put(const glm::vec3& vector) {
    for (int k = 0; k < 3; ++k) put(std::bit_cast<std::uint32_t>(vector[k]));
  }

  /// Reads the next field.
  std::uint32_t take(unsigned width = 32) {
    std::uint64_t two = words_[at_ / 32];
    if (at_ % 32 + width > 32) two |= std::uint64_t{words_[at_ / 32 + 1]} << 32;
    two >>= at_ % 32;
    at_ += width;
    return static_cast<std::uint32_t>(two & ((std::uint64_t{1} << width) - 1));
  }
  float take_float() { return std::bit_cast<float>(take()); }

 private:
  Words& words_;
  unsigned at_ = 0;
};

/// Decodes ray_core_pkg::result_t.
template <class Words>
CoreResult unpack_result(const Words& words) {
  PackedFields fields(words);
  CoreResult result;
  result.error = static_cast<CoreResult::Error>(fields.take(3));
  result.tests = fields.take(28);
  for (int k = 0; k < 3; ++k) result.point[k] = fields.take_float();
  result.t_error = fields.take(5);
  result.t = fields.take_float();
  result.triangle = fields.take();
  result.found = fields.take(1) != 0;
  result.tag = fields.take();
  result.kind = static_cast<CoreResult::Kind>(fields.take(1));
  return result;
}

/// A result of core_link.
using ResultWords = std::array<std::uint32_t, 8>;

/// Message formats of core_link.
using LineMessage = std::array<std::uint32_t, 17>;
using RayMessage = std::array<std::uint32_t, 11>;

[[nodiscard]] inline LineMessage line_message(std::uint32_t number, const MemoryLine& line) {
  LineMessage message{1u << 28 | number};
  std::ranges::copy(line.words, message.begin() + 1);
  return message;
}
/// Returns the message that the memory has changed and has `lines` lines.
[[nodiscard]] inline std::uint32_t lines_message(std::uint32_t lines) { return 2u << 28 | lines; }
[[nodiscard]] inline RayMessage ray_message(const CoreRay& ray) {
  RayMessage message{(4u | (ray.any_hit ? 1u : 0u) | (ray.no_cull ? 2u : 0u)) << 28, ray.tag,
                     ray.source_id, ray.skip_id, std::bit_cast<std::uint32_t>(ray.t_max)};
  for (int k = 0; k < 3; ++k) {
    message[5 + static_cast<unsigned>(k)] = std::bit_cast<std::uint32_t>(ray.ray.direction[k]);
    message[8 + static_cast<unsigned>(k)] = std::bit_cast<std::uint32_t>(ray.ray.origin[k]);
  }
  return message;
}

/// An ordered link of words to and from a board (hw/board/core_link.sv).
class WordLink {
 public:
  virtual ~WordLink() = default;

  /// Sends a word; returns false if it was not accepted and must be sent again.
  virtual bool send(std::uint32_t word) = 0;
  /// Returns the next received word, or none.
  virtual std::optional<std::uint32_t> receive() = 0;
  /// Waits: one clock in simulation. Throws if the board is silent for too long.
  virtual void wait() = 0;
  /// Sends a break, which aborts the board's message and rays, and drops input until it is quiet.
  virtual void restart() = 0;
  /// Returns simulated clocks since construction; 0 without simulation.
  [[nodiscard]] virtual std::uint64_t clocks() const { return 0; }
};

/// A ray core with its own memory, behind a link. Sends the memory when it has changed, then rays,
/// at most as many as the core holds, since a link may have no back-pressure. The board reports
/// only the counts of rays, triangles, doubts and busy clocks.
class LinkedCore : public CoreUnit {
 public:
  LinkedCore(std::unique_ptr<WordLink> link, std::size_t rays)
      : link_(std::move(link)), most_(rays) {
    link_->restart();
  }

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override;
  [[nodiscard]] CoreCounters counters() const override { return counters_; }

 private:
  void load(std::span<const MemoryLine> lines);
  /// Returns a result if all its words have arrived.
  std::optional<CoreResult> take_result();
  void count(const CoreResult& result);

  std::unique_ptr<WordLink> link_;
  std::size_t most_;
  std::vector<MemoryLine> memory_;    ///< contents of the board's memory
  std::vector<std::uint32_t> words_;  ///< words of an incomplete result
  CoreCounters counters_;
};

/// A serial port: four bytes per word, lowest first, 8N1, 2 Mbaud. Throws InputError with the
/// port's name if it cannot be opened, or if the board is silent for kPatience seconds.
class SerialLink : public WordLink {
 public:
  explicit SerialLink(std::filesystem::path port);
  SerialLink(const SerialLink&) = delete;
  SerialLink& operator=(const SerialLink&) = delete;
  ~SerialLink() override;

  bool send(std::uint32_t word) override;
  std::optional<std::uint32_t> receive() override;
  void wait() override;
  void restart() override;

 private:
  static constexpr int kPatience = 30;
  static constexpr int kQuiet = 100;            ///< ms without input after a break
  static constexpr std::size_t kBuffer = 4096;  ///< bytes to be written

  [[noreturn]] void fail(const std::string& what) const;
  void write_some();
  void read_some();

  std::filesystem::path port_;
  int file_;
  std::vector<unsigned char> out_, in_;
  std::size_t taken_ = 0;  ///< bytes taken from in_
};

}  // namespace raygate
