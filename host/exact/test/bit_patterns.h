// Compares the predicates with rationals for arbitrary bits.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "host/exact/test/rational_oracle.h"

namespace raygate::test {

/// Origin, direction and three corners, as bits of floats.
using Patterns = std::array<std::uint32_t, 15>;

/// Returns the name of the first predicate that is wrong for these words, or "". Coordinates that
/// are not finite or above 2^126 are replaced by valid ones; directions are not replaced.
inline std::string disagreement(const Patterns& words) {
  const auto vector = [&](std::size_t i, bool coordinate) {
    glm::vec3 v;
    for (int k = 0; k < 3; ++k) {
      v[k] = std::bit_cast<float>(words[i + k]);
      if (coordinate && !(std::abs(v[k]) <= 0x1p126f)) {
        v[k] = std::bit_cast<float>(words[i + k] & 0xBFFFFFFF);
      }
    }
    return v;
  };
  const Ray ray = {vector(0, true), vector(3, false)};
  const Corners t = {vector(6, true), vector(9, true), vector(12, true)};
  const Ray finite = {ray.origin, is_usable(ray.direction) ? ray.direction : glm::vec3(1, 0, 0)};
  const RationalOracle oracle(finite, t);
  if (orient3d(ray.origin, t) != sgn(oracle.plane())) return "orient3d";
  for (int k = 0; k < 3; ++k) {
    if (edge_side(finite, t[k], t[(k + 1) % 3]) != oracle.side(k)) return "edge_side";
  }
  const auto slope = dot(oracle.direction,
                         cross(minus(oracle.v[1], oracle.v[0]), minus(oracle.v[2], oracle.v[0])));
  if (direction_side(finite.direction, t) != sgn(slope)) return "direction_side";
  if (hits_triangle(finite, t) != oracle.hit()) return "hits_triangle";
  if (!is_usable(ray.direction) && hits_triangle(ray, t)) return "hits_triangle, useless direction";
  if (!oracle.hit()) return "";
  const mpq_class exact = oracle.t();
  const Interval interval = hit_distance(finite, t);
  if (mpq_class(interval.low) > exact || mpq_class(interval.high) < exact) return "hit_distance";
  const auto limit = static_cast<float>(exact.get_d());
  if (limit > 0.0f && std::isfinite(limit)) {
    const int order = cmp(exact, mpq_class(limit));
    if (compare_hit_to_limit(finite, t, limit) != (order > 0) - (order < 0)) return "limit";
  }
  return compare_hits(finite, t, {t[1], t[2], t[0]}) == 0 ? "" : "compare_hits";
}

}  // namespace raygate::test
