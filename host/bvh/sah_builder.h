// SAH builder: splits triangles into a binary tree by the surface area heuristic.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "host/bvh/box.h"
#include "host/bvh/bvh.h"
#include "host/scene/scene.h"

namespace raygate {

/// What a tree is built around; faces without area are left out (see is_left_out).
struct TreeContent {
  /// Whatever has a tree of its own: an instance.
  struct Other {
    Box box;
    std::uint32_t root;  ///< the number of its tree's root, as a node
  };
  std::span<const glm::vec3> positions;
  std::span<const Triangle> triangles;  ///< of these positions
  std::vector<Other> others = {};

  [[nodiscard]] std::size_t size() const { return triangles.size() + others.size(); }
};

/// A triangle and its grown box; or, of a number beyond those of triangles, one of the others.
struct Primitive {
  float low[3];
  std::uint32_t triangle;
  float turned_high[3];
  std::uint32_t unused;

  RAYGATE_INLINE void get(Box& box) const { std::memcpy(&box, this, sizeof box); }
  /// The box's along an axis; halved before it is added up, so that it is finite.
  [[nodiscard]] RAYGATE_INLINE float middle(int axis) const {
    return 0.5f * low[axis] - 0.5f * turned_high[axis];
  }
};

/// A binary tree of boxes with one triangle to a leaf, split top-down by the surface area heuristic
/// (Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007). Its nodes are
/// runs of `primitives`, which it has put in order; the node whose run is cut in two at m is
/// nodes[m]. So each thread knows where its nodes go, and the tree does not depend on which thread
/// made what.
struct BinaryBvh {
  /// A node's number; from `size()` on: that of a leaf's primitive, plus size().
  using Ref = std::uint32_t;

  struct Node {
    Box box;
    Ref child[2];
    std::uint32_t first, count;  ///< the run
  };

  /// All positions finite, of magnitude at most 2^126; fewer than 2^31 primitives. No leaf is
  /// deeper than `max_depth`, the root's depth being 0, if halves are not.
  BinaryBvh(const TreeContent& content, int max_depth, int threads);

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(primitives.size()); }
  [[nodiscard]] bool is_leaf(Ref ref) const { return ref >= size(); }
  RAYGATE_INLINE void get_box(Ref ref, Box& box) const {
    if (is_leaf(ref)) {
      primitives[ref - size()].get(box);
    } else {
      box = nodes[ref].box;
    }
  }
  [[nodiscard]] std::uint32_t first(Ref ref) const {
    return is_leaf(ref) ? ref - size() : nodes[ref].first;
  }
  [[nodiscard]] std::uint32_t count(Ref ref) const { return is_leaf(ref) ? 1 : nodes[ref].count; }
  /// Of a tree that is not empty.
  [[nodiscard]] Ref root() const { return nodes[0].child[0]; }

  std::vector<Primitive> primitives;
  std::vector<Node> nodes;  ///< nodes[0] is above the root
};

/// Consecutive non-empty runs of numbers. Finding the run of a number takes one table lookup if the
/// runs are about equally long.
class RangeMap {
 public:
  RangeMap() = default;
  /// Runs of these lengths, the first from `begin` on; their end is below 2^32.
  RangeMap(std::uint32_t begin, const std::vector<std::uint32_t>& lengths) : begins_{begin} {
    begins_.reserve(lengths.size() + 1);
    for (const std::uint32_t length : lengths) begins_.push_back(begins_.back() + length);
    if (lengths.empty()) return;
    const std::uint32_t size = end() - begin;
    shift_ = std::bit_width(size / static_cast<std::uint32_t>(lengths.size()));
    for (std::uint32_t chunk = 0, run = 0; chunk <= (size - 1) >> shift_; ++chunk) {
      while (begins_[run + 1] - begin <= chunk << shift_) ++run;
      first_.push_back(run);
    }
    first_.push_back(static_cast<std::uint32_t>(lengths.size() - 1));
  }

  [[nodiscard]] std::uint32_t begin() const { return begins_.front(); }
  [[nodiscard]] std::uint32_t end() const { return begins_.back(); }
  [[nodiscard]] std::uint32_t begin(std::uint32_t run) const { return begins_[run]; }

  /// The run that a number from begin() to before end() is in.
  [[nodiscard]] std::uint32_t find(std::uint32_t number) const {
    const std::uint32_t* const chunk = &first_[(number - begins_[0]) >> shift_];
    const auto first = begins_.begin() + chunk[0] + 1, last = begins_.begin() + chunk[1] + 1;
    return static_cast<std::uint32_t>(std::upper_bound(first, last, number) - begins_.begin()) - 1;
  }

 private:
  std::vector<std::uint32_t> begins_{0};  // of the runs, and their end
  std::vector<std::uint32_t> first_;      // the run of the first number of each 2^shift_, and more
  int shift_ = 0;
};

}  // namespace raygate
