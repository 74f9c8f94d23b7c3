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
#include "host/exact/exact.h"

namespace raygate {

/// A 512-bit line; bit 0 is the lowest of words[0].
struct alignas(64) MemoryLine {
  std::array<std::uint32_t, 16> words{};

  /// Returns bits `first` to `first + width - 1`; width is 1 to 32.
  [[nodiscard]] std::uint32_t bits(unsigned first, unsigned width) const {
    std::uint64_t two = words[first / 32];
    if (first / 32 < 15) two |= std::uint64_t{words[first / 32 + 1]} << 32;
    return static_cast<std::uint32_t>(two >> first % 32 & ((std::uint64_t{1} << width) - 1));
  }
  /// Writes `value` at bit `first`. The bits must be 0 before.
  void set_bits(unsigned first, std::uint64_t value) {
    words[first / 32] |= static_cast<std::uint32_t>(value << first % 32);
    if (first % 32 != 0 && first / 32 < 15) {
      words[first / 32 + 1] |= static_cast<std::uint32_t>(value >> (32 - first % 32));
    }
  }
  [[nodiscard]] float number(unsigned word) const { return std::bit_cast<float>(words[word]); }
};
static_assert(sizeof(MemoryLine) == 64);

/// An inner node: up to seven children with their boxes on the node's grid. On axis k, the grid
/// coordinate q stands for exactly origin[k] + q 2^(exponent[k] - 127).
struct NodeLine {
  static constexpr int kChildren = 7;
  static constexpr std::uint32_t kAbsent = 0,
                                 kInner =
                                     8;  ///< kinds; other values: number of triangles of a leaf

  struct Child {
    std::uint32_t kind = kAbsent;
    std::array<std::uint8_t, 3> low{}, high{};

    /// Returns the number of lines in memory.
    [[nodiscard]] std::uint32_t size() const { return kind == kInner ? 1 : kind; }
  };

  glm::vec3 origin{0.0f};
  std::array<int, 3> exponent{1, 1, 1};  ///< 1 to 254
  std::uint32_t base = 0;                ///< line of the first child; the other children follow
  std::array<Child, kChildren> child{};

  NodeLine() = default;
  explicit NodeLine(const MemoryLine& line) : base(line.bits(120, 28)) {
    for (unsigned k = 0; k < 3; ++k) {
      origin[static_cast<int>(k)] = line.number(k);
      exponent[k] = static_cast<int>(line.bits(96 + 8 * k, 8));
    }
    for (unsigned i = 0; i < kChildren; ++i) {
      child[i].kind = line.bits(148 + 4 * i, 4);
      for (unsigned k = 0; k < 3; ++k) {
        child[i].low[k] = static_cast<std::uint8_t>(line.bits(176 + 48 * i + 8 * k, 8));
        child[i].high[k] = static_cast<std::uint8_t>(line.bits(200 + 48 * i + 8 * k, 8));
      }
    }
  }

  [[nodiscard]] MemoryLine line() const {
    MemoryLine line;
    for (unsigned k = 0; k < 3; ++k) {
      line.words[k] = std::bit_cast<std::uint32_t>(origin[static_cast<int>(k)]);
      line.set_bits(96 + 8 * k, static_cast<std::uint64_t>(exponent[k]));
    }
    line.set_bits(120, base);
    for (unsigned i = 0; i < kChildren; ++i) {
      line.set_bits(148 + 4 * i, child[i].kind);
      for (unsigned k = 0; k < 3; ++k) {
        line.set_bits(176 + 48 * i + 8 * k, child[i].low[k]);
        line.set_bits(200 + 48 * i + 8 * k, child[i].high[k]);
      }
    }
    return line;
  }
};

/// A triangle with its indices.
struct TriangleLine {
  Corners corners{};
  std::uint32_t index = 0;      ///< index of this line
  std::uint32_t rank = 0;       ///< of hits at equal t, the lowest rank is the nearest
  std::uint32_t primitive = 0;  ///< the host's primitive index, not read by the core

  TriangleLine() = default;
  explicit TriangleLine(const MemoryLine& line)
      : index(line.words[9]), rank(line.words[10]), primitive(line.words[11]) {
    for (unsigned i = 0; i < 9; ++i) corners[i / 3][static_cast<int>(i % 3)] = line.number(i);
  }

  [[nodiscard]] MemoryLine line() const {
    MemoryLine line;
    for (unsigned i = 0; i < 9; ++i) {
      line.words[i] = std::bit_cast<std::uint32_t>(corners[i / 3][static_cast<int>(i % 3)]);
    }
    line.words[9] = index;
    line.words[10] = rank;
    line.words[11] = primitive;
    return line;
  }
};

/// The memory lines of a scene, with the root at kRoot. Triangles are ranked by their index in the
/// scene. The image does not depend on the number of threads.
class MemoryImage {
 public:
  static constexpr std::uint32_t kRoot = 0;
  static constexpr int kMostDepth = Bvh::kMaxDepth;  ///< ray_core_pkg::MaxLevels

  /// Throws std::invalid_argument for a BVH with instances, which must be flattened.
  explicit MemoryImage(const Bvh& bvh, int threads = 1);

  [[nodiscard]] std::span<const MemoryLine> lines() const { return lines_; }
  /// Convert between a primitive of the BVH and the line of its triangle; kNoTriangle: none.
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
  /// Returns the number of nodes on the longest path from the root to a leaf, from 1 to kMostDepth.
  [[nodiscard]] int depth() const { return depth_; }

 private:
  friend class ImageWriter;

  std::vector<MemoryLine> lines_;
  std::vector<std::uint32_t> primitive_lines_;
  int depth_ = 0;
};

}  // namespace raygate
