// Test nodes and rays for the box unit, from ordinary ones to the limits of binary32.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "host/intersect/core/reference_core.h"

namespace raygate {

/// A node, and a ray towards it.
struct BoxCase {
  NodeLine node;
  Ray ray;  ///< scaled; read() returns the fields that the unit reads
  float limit = std::numeric_limits<float>::infinity();

  [[nodiscard]] BoxRay read() const { return {ray.origin, 1.0f / ray.direction, limit}; }
};

/// Generates cases. Equal seeds give equal cases.
class BoxCases {
 public:
  explicit BoxCases(std::uint32_t seed) : random_(seed) {}

  BoxCase next() {
    BoxCase box;
    const int scale = one_in(8) ? between(-60, 60) : between(-6, 6);
    NodeLine& node = box.node;
    for (int k = 0; k < 3; ++k) {
      node.origin[k] =
          one_in(8) ? 0.0f : std::ldexp(number(), scale + (one_in(8) ? between(-9, 9) : 3));
      node.exponent[k] =
          std::clamp(127 + scale - 6 - (one_in(8) ? between(0, 24) : between(0, 2)), 1, 254);
    }
    node.base = random_() & 0xFFFFFFF;
    for (NodeLine::Child& child : node.child) {
      child.kind = one_in(6) ? NodeLine::kAbsent : one_in(2) ? NodeLine::kInner : 1 + random_() % 7;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = static_cast<std::uint8_t>(random_()),
                   b = static_cast<std::uint8_t>(random_());
        child.low[k] = std::min(a, b);
        child.high[k] = one_in(6) ? child.low[k] : std::max(a, b);
      }
    }
    // Most rays go through a corner of a box, from any distance. Some are parallel to a plane.
    const NodeLine::Child& aim = node.child[random_() % NodeLine::kChildren];
    const float distance = std::ldexp(1.0f, one_in(8) ? between(-20, 20) : between(-2, 3));
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const std::uint8_t q = one_in(2) ? aim.low[at] : aim.high[at];
      const float cell = std::ldexp(1.0f, node.exponent[at] - 127),
                  target = node.origin[k] + static_cast<float>(q) * cell;
      box.ray.direction[k] =
          one_in(8) ? 0.0f : number() * (one_in(8) ? std::ldexp(1.0f, between(-149, 0)) : 1.0f);
      box.ray.origin[k] = target - box.ray.direction[k] * distance * 64.0f * cell;
    }
    const float size = largest(box.ray.direction);
    if (size == 0.0f) {
      box.ray.direction.x = 1.0f;
    } else {
      box.ray.direction = glm::vec3(std::ldexp(box.ray.direction.x, -std::ilogb(size)),
                                    std::ldexp(box.ray.direction.y, -std::ilogb(size)),
                                    std::ldexp(box.ray.direction.z, -std::ilogb(size)));
    }
    if (one_in(3))
      box.limit = std::abs(distance * 64.0f * std::ldexp(1.0f, node.exponent[0] - 127) * size *
                           (one_in(2) ? 1.0f : number()));
    if (one_in(3)) {  // near a plane of a box
      const NodeLine::Child& child = node.child[random_() % NodeLine::kChildren];
      const int k = between(0, 2);
      const auto at = static_cast<std::size_t>(k);
      const float cell = std::ldexp(1.0f, node.exponent[at] - 127);
      const float plane = node.origin[k] + static_cast<float>(child.low[at]) * cell;
      const float t = (plane - box.ray.origin[k]) / box.ray.direction[k];
      if (std::isfinite(t))
        box.limit = std::abs(t) * (1.0f + std::ldexp(number(), -between(8, 22)));
    }
    if (one_in(64)) box.limit = std::ldexp(1.0f, between(-149, 127));
    if (box.limit == 0.0f) box.limit = 1.0f;
    return box;
  }

 private:
  bool one_in(unsigned n) { return random_() % n == 0; }
  int between(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  /// Returns a number in [-1, 1], often a multiple of 1/8.
  float number() {
    const auto bits = static_cast<float>(between(-(1 << 23), 1 << 23));
    return one_in(4) ? std::ldexp(static_cast<float>(between(-8, 8)), -3) : std::ldexp(bits, -23);
  }

  std::mt19937 random_;
};

}  // namespace raygate
