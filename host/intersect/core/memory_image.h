// Memory image: the nodes and triangles that the ray core reads.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/core/memory_line.h"

namespace raygate {

/// The lines of a scene, the root's at kRoot. Triangles have the names of their primitives in the
/// Bvh. The same whatever the number of threads that make it.
class MemoryImage {
 public:
  static constexpr std::uint32_t kRoot = 0;

  /// Throws std::invalid_argument for a tree with instances: they are to be written out.
  explicit MemoryImage(const Bvh& bvh, int threads = 1);

  [[nodiscard]] std::span<const MemoryLine> lines() const { return lines_; }
  /// The memory byte by byte, as --dump-image writes it: line n is at byte 64 n.
  [[nodiscard]] std::string_view bytes() const;
  /// Nodes on the longest way from the root to a leaf; 1 at least.
  [[nodiscard]] int depth() const { return depth_; }

 private:
  friend class ImageWriter;

  std::vector<MemoryLine> lines_;
  int depth_ = 0;
};

}  // namespace raygate
