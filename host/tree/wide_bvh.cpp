#include "host/tree/wide_bvh.h"

#include <limits>

namespace raygate {
namespace {

/// Two leaves are better one while its box has at most that many times their boxes' area: testing
/// up to four triangles costs one ray as much as testing one, and another box a little.
constexpr double kMergedArea = 1.5;

/// A child of a binary node, with its box.
struct Part {
  glm::vec3 low, high;
  Bvh::Ref ref;

  Part() = default;
  Part(const Bvh& bvh, const Bvh::Node& node, int side)
      : low(node.bounds[0][side]), high(node.bounds[1][side]), ref(node.child[side]) {
    if (ref.count != 0 || absent()) return;
    const Bvh::Node& inner = bvh.nodes()[ref.first];
    const auto& [first, second] = inner.child;
    const std::uint32_t count = first.count + second.count;
    if (first.count == 0 || second.count == 0 || count > WideBvh::kMaxLeafSize) return;
    const double parts = Part(bvh, inner, 0).half_area() + Part(bvh, inner, 1).half_area();
    if (half_area() > kMergedArea * parts) return;
    // Siblings have neighbouring slots.
    ref = {first.first, static_cast<std::uint16_t>(count), 0};
  }

  [[nodiscard]] bool absent() const { return low.x > high.x; }
  [[nodiscard]] double half_area() const {
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

}  // namespace

WideBvh::WideBvh(const Bvh& bvh) : corners_(9 * std::size_t{bvh.slot_count()} + kMaxLeafSize) {
  nodes_.emplace_back();
  fill(0, bvh, bvh.nodes()[bvh.root().first]);
}

void WideBvh::fill(std::uint32_t index, const Bvh& bvh, const Bvh::Node& from) {
  Part parts[kWidth];
  int count = 0;
  for (int side = 0; side < 2; ++side) {
    const Part part(bvh, from, side);
    if (!part.absent()) parts[count++] = part;
  }
  while (count < kWidth) {
    int largest = -1;
    for (int i = 0; i < count; ++i) {
      if (parts[i].ref.count != 0) continue;
      if (largest < 0 || parts[i].half_area() > parts[largest].half_area()) largest = i;
    }
    if (largest < 0) break;
    const Bvh::Node& opened = bvh.nodes()[parts[largest].ref.first];
    parts[largest] = Part(bvh, opened, 0);
    parts[count++] = Part(bvh, opened, 1);
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int i = 0; i < kWidth; ++i) {
    const bool present = i < count;
    for (int k = 0; k < 3; ++k) {
      nodes_[index].bounds[0][k][i] = present ? parts[i].low[k] : kInfinity;
      nodes_[index].bounds[1][k][i] = present ? parts[i].high[k] : -kInfinity;
    }
    nodes_[index].child[i] = present ? Child{parts[i].ref.first, parts[i].ref.count} : Child{};
    if (!present) continue;
    if (parts[i].ref.count != 0) {
      fill_corners(bvh, nodes_[index].child[i]);
      continue;
    }
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_[index].child[i].first = child;
    fill(child, bvh, bvh.nodes()[parts[i].ref.first]);
  }
}

void WideBvh::fill_corners(const Bvh& bvh, const Child& leaf) {
  float* next = &corners_[9 * std::size_t{leaf.first}];
  for (int v = 0; v < 3; ++v) {
    for (int k = 0; k < 3; ++k) {
      for (const Bvh::Corners& corners : bvh.corners_of(leaf.first, leaf.count)) {
        *next++ = corners[v][k];
      }
    }
  }
}

}  // namespace raygate
