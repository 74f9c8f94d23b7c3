// Winding numbers of meshes that may be open or self-intersecting. Included by module.cpp only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <numbers>

#include "host/bvh/closest_point.h"
#include "host/exact/expansion.h"
#include "host/scene/bounds.h"

namespace raygate {

class WindingNumbers {
 public:
  struct Number {
    double value, error;  ///< `error` bounds the error of `value`
  };

  /// The references must outlive this object. Merges vertices with equal coordinates.
  WindingNumbers(const Scene& scene, const Bvh& bvh) : bvh_(bvh), origin_(scene.origin) {
    for_each_face(scene, [&](const Corners& t, const Triangle&) {
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3];
        const Ends ends{a.x, a.y, a.z, b.x, b.y, b.z}, back{b.x, b.y, b.z, a.x, a.y, a.z};
        ends < back ? ++open_edges_[ends] : --open_edges_[back];
      }
    });
    std::erase_if(open_edges_, [](const auto& edge) { return edge.second == 0; });
  }

  /// Returns how often the triangles wind around `point`. The error is 0 if no edge is open, and
  /// infinite if rounding relative to the scene's origin may move the point across a triangle.
  /// `crossings`: number of triangles that a ray from the point leaves minus those it enters.
  /// `away`: the unit vector opposite to the ray.
  ///
  /// The crossings are exact for a mesh whose open edges are closed by strips to infinity in
  /// direction `away`. The result excludes the solid angles of these strips.
  [[nodiscard]] Number at(const glm::dvec3& point, double crossings, const glm::dvec3& away) const {
    glm::dvec3 at, rounding;
    for (int k = 0; k < 3; ++k) {
      const ExactPair difference = two_sum(point[k], -origin_[k]);
      at[k] = difference.value;
      rounding[k] = difference.error;
    }
    const double moved = glm::length(rounding);
    Number result{crossings, 0.0};
    if (moved > 0.0 && closest_point(bvh_, at).distance <= 0x1p-40 * glm::length(at)) {
      result.error = std::numeric_limits<double>::infinity();
    }
    for (const auto& [ends, times] : open_edges_) {
      const glm::dvec3 a = glm::dvec3(ends[0], ends[1], ends[2]) - at,
                       b = glm::dvec3(ends[3], ends[4], ends[5]) - at;
      const double size_a = glm::length(a), size_b = glm::length(b);
      // Half of the solid angle of a, b and `away` (Van Oosterom and Strackee, 1983).
      const double y = glm::dot(glm::cross(a, b), away);
      const double x = size_a * size_b + glm::dot(a, b) + glm::dot(b, away) * size_a +
                       glm::dot(a, away) * size_b;
      result.value += std::atan2(y, x) * times / (2.0 * std::numbers::pi);
      // `off` bounds the error of (x, y). Rounding adds less than 2^-47 |a| |b|. The point is off
      // by `moved`, so each of the four terms of x is off by at most moved (|a| + |b| + moved), and
      // y by moved (|a| + |b|): together less than 4.2 moved (|a| + |b| + moved). The angle over 2
      // pi is then off by off / 4 / |(x, y)|, or by 1 where atan2 may give -pi for pi. The rest of
      // the bound covers the rounding of atan2 and of the sums.
      const double off = 0x1p-46 * size_a * size_b + 4.2 * moved * (size_a + size_b + moved);
      const bool may_jump = x <= off && std::abs(y) <= off;
      result.error +=
          std::abs(times) * (may_jump ? 1.0 : off / std::max(std::hypot(x, y), 1e-300)) +
          0x1p-52 * std::abs(result.value);
    }
    return result;
  }

 private:
  using Ends = std::array<double, 6>;

  const Bvh& bvh_;
  glm::dvec3 origin_;
  std::map<Ends, int> open_edges_;  // by edge: triangles along it minus against it
};

}  // namespace raygate
