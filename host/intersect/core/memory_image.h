// Memory image: the nodes and triangles that the ray core reads.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/core/memory_line.h"

namespace raygate {

/// The lines of a scene, the root's at kRoot. Triangles are named by their lines, and ranked as the
/// Bvh's scene numbers them. The same whatever the number of threads that make it.
class MemoryImage {
 public:
  static constexpr std::uint32_t kRoot = 0;
  static constexpr int kMostDepth = Bvh::kMaxDepth;  ///< ray_core_pkg::Levels

  /// Throws std::invalid_argument for a tree with instances: they are to be written out.
  explicit MemoryImage(const Bvh& bvh, int threads = 1);

  [[nodiscard]] std::span<const MemoryLine> lines() const { return lines_; }
  /// The triangle's line of a primitive of the Bvh, and the other way round: kNoTriangle for what
  /// is none.
  static constexpr std::uint32_t kNoTriangle = 0xFFFFFFFF;
  [[nodiscard]] std::uint32_t line_of(std::uint32_t primitive) const {
    return primitive < primitive_lines_.size() ? primitive_lines_[primitive] : kNoTriangle;
  }
  [[nodiscard]] std::uint32_t primitive_at(std::uint32_t line) const {
    const std::uint32_t primitive =
        line < lines_.size() ? TriangleLine(lines_[line]).primitive : kNoTriangle;
    return line_of(primitive) == line ? primitive : kNoTriangle;
  }
  /// The memory byte by byte, as --dump-image writes it: line n is at byte 64 n.
  [[nodiscard]] std::string_view bytes() const;
  /// Nodes on the longest way from the root to a leaf; 1 at least, kMostDepth at most.
  [[nodiscard]] int depth() const { return depth_; }

 private:
  friend class ImageWriter;

  std::vector<MemoryLine> lines_;
  std::vector<std::uint32_t> primitive_lines_;
  int depth_ = 0;
};

}  // namespace raygate
