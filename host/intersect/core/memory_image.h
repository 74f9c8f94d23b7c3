// Memory image: the nodes and triangles that a ray core reads.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "host/bvh/bvh.h"

namespace raygate {

/// Reads or writes the fields of a SystemVerilog packed struct in 32-bit words, beginning with the
/// struct's last field, which is in the lowest bits. `Words` has an operator [].
template <class Words>
class PackedFields {
 public:
  explicit PackedFields(Words& words) : words_(words) {}

  /// Writes the next field of `width` bits, at most 32. The words must be 0 before.
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
  glm::vec3 take_vector() {
    glm::vec3 vector;
    for (int k = 0; k < 3; ++k) vector[k] = take_float();
    return vector;
  }

 private:
  Words& words_;
  unsigned at_ = 0;
};

/// A 512-bit line; bit 0 is the lowest of words[0].
struct alignas(64) MemoryLine {
  std::array<std::uint32_t, 16> words{};
};
static_assert(sizeof(MemoryLine) == 64);

/// An inner node: up to seven children with their boxes on the node's grid. On axis k, the grid
/// coordinate q stands for exactly origin[k] + q 2^(exponent[k] - 127).
struct NodeLine {
  static constexpr int kChildren = 7;
  /// Kinds of children; other values are the number of triangles of a leaf.
  static constexpr std::uint32_t kAbsent = 0, kInner = 8;

  struct Child {
    std::uint32_t kind = kAbsent;
    std::array<std::uint8_t, 3> low{}, high{};

    /// Returns the number of memory lines that the child takes.
    [[nodiscard]] std::uint32_t size() const { return kind == kInner ? 1 : kind; }
  };

  glm::vec3 origin{0.0f};
  std::array<int, 3> exponent{1, 1, 1};  ///< 1 to 254
  std::uint32_t base = 0;                ///< line of the first child; the other children follow
  std::array<Child, kChildren> child{};

  NodeLine() = default;
  explicit NodeLine(const MemoryLine& line);
  [[nodiscard]] MemoryLine line() const;
};

/// A triangle with its indices.
struct TriangleLine {
  FloatCorners corners{};
  std::uint32_t index = 0;      ///< index of this line
  std::uint32_t rank = 0;       ///< a hit of lower rank is preferred among hits at equal t
  std::uint32_t primitive = 0;  ///< the host's primitive index, not read by the core

  TriangleLine() = default;
  explicit TriangleLine(const MemoryLine& line);
  [[nodiscard]] MemoryLine line() const;
};

/// The memory lines of a scene, with the root at kRoot. A triangle's rank is its index in the
/// scene. The image does not depend on the number of threads.
class MemoryImage {
 public:
  static constexpr std::uint32_t kRoot = 0;
  static constexpr int kMostDepth = Bvh::kMaxDepth;  ///< ray_core_pkg::MaxLevels

  /// Throws std::invalid_argument for a BVH with instances or with binary64 vertices.
  explicit MemoryImage(const Bvh& bvh, int threads = 1);

  [[nodiscard]] std::span<const MemoryLine> lines() const { return lines_; }
  /// Returned by line_of and primitive_at (its inverse) if there is no such line or primitive.
  static constexpr std::uint32_t kNoTriangle = 0xFFFFFFFF;
  [[nodiscard]] std::uint32_t line_of(std::uint32_t primitive) const {
    return primitive < primitive_lines_.size() ? primitive_lines_[primitive] : kNoTriangle;
  }
  [[nodiscard]] std::uint32_t primitive_at(std::uint32_t line) const {
    const std::uint32_t primitive =
        line < lines_.size() ? TriangleLine(lines_[line]).primitive : kNoTriangle;
    return line_of(primitive) == line ? primitive : kNoTriangle;
  }
  /// Returns the bytes of the memory, in the format of --dump-image: line n is at byte 64 n.
  [[nodiscard]] std::string_view bytes() const;

 private:
  friend class ImageWriter;

  std::vector<MemoryLine> lines_;
  std::vector<std::uint32_t> primitive_lines_;
};

}  // namespace raygate
