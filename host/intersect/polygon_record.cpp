#include "host/intersect/polygon_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

// The bound of an edge test
//
// Let u = 2^-24, E the exact edge plane A x B (times the record's power of two, if any), D the
// double we round, F the record's float words, I a direction with |I_i| < 2, so that
// |I . X| < 2 |X|_1 for any X. |.|_1 is the sum of magnitudes.
//
// 1. Double. edge_normal promises |D_i - E_i| <= 2^-34 |D|_1, cancellation in the cross product
//    included: it falls back on exact arithmetic where double is not that good. Together:
//    |D - E|_1 <= 3 * 2^-34 |D|_1.
// 2. Rounding to float. |F_i - D_i| <= u |F_i|, or 2^-150 where F_i is subnormal. Together:
//    |F - D|_1 <= u |F|_1 + 3 * 2^-150, and so |D|_1 < 1.001 |F|_1.
//    1 and 2:  |I . F - I . E| < (2 + 6.006 * 2^-10) u |F|_1 + 6 * 2^-150.
// 3. The dot product in float, in any order: a product takes part in at most three roundings (its
//    own and two sums), so the result is off by (3 u / (1 - 3 u)) |I|.|F| < 6.00001 u |F|_1;
//    a product that underflows adds at most 2^-150 (sums do not underflow), three of them 2^-148.
// 4. make_record keeps max |F_i| between 2^-60 and 2^61. So nothing overflows, and the underflow
//    terms, less than 2^-146 in all, are under 2^-62 u |F|_1.
//
// Sum: less than (8 + 0.00587 + 0.00001 + 2^-62) u |F|_1 < kEdgeBound u |F|_1, with room for
// evaluating the latter in double; the rounding to float goes up.

namespace raygate {
namespace {

// Words whose exponents are in here are far enough from under- and overflow for all that follows.
constexpr double kSmallest = 0x1p-60, kLargest = 0x1p61;

/// Not so for a NaN.
bool ordinary(double x) {
  const double size = std::abs(x);
  return size == 0.0 || (size >= kSmallest && size < kLargest);
}

/// By which power of two `v` is to be multiplied for its largest component to be in [1, 2).
int to_unit(const glm::dvec3& v) {
  const double size = largest(v);
  return size > 0.0 && std::isfinite(size) ? -std::ilogb(size) : 0;
}

glm::dvec3 scaled(const glm::dvec3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest >= x ? nearest : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

bool lower(const glm::vec3& a, const glm::vec3& b) {
  return std::pair(a.x, std::pair(a.y, a.z)) < std::pair(b.x, std::pair(b.y, b.z));
}

/// A x B in float. Computed from the lower vertex, A x B = A x (B - A), whichever way the edge
/// runs: neighbours get exactly opposite numbers. The difference, small where the triangle is far
/// away, spares the digits that A x B would cancel.
glm::vec3 edge_words(const glm::vec3& origin, const glm::vec3& a, const glm::vec3& b) {
  glm::dvec3 edge = lower(a, b) ? edge_normal(origin, a, b) : -edge_normal(origin, b, a);
  if (!ordinary(largest(edge))) edge = scaled(edge, to_unit(edge));
  return glm::vec3(edge);
}

float edge_bound(const glm::vec3& edge) {
  const glm::dvec3 e = glm::abs(glm::dvec3(edge));
  return rounded_up(kEdgeBound * 0x1p-24 * (e.x + e.y + e.z));
}

/// A plane of the record's scale.
struct Plane {
  glm::dvec3 normal;
  double d;

  Plane(const glm::vec3& origin, const Corners& t)
      : normal(triangle_normal(t)), d(plane_distance(origin, t)) {
    if (ordinary(largest(normal)) && ordinary(d)) return;
    const int exponent = to_unit(normal);
    normal = scaled(normal, exponent);
    d = std::ldexp(d, exponent);
  }

  /// Whether float cannot hold the distance.
  [[nodiscard]] bool is_beyond_float() const {
    return d != 0.0 && !std::isnormal(static_cast<float>(d));
  }

  void put(PolygonRecord& record) const {
    record.normal = glm::vec3(normal);
    record.d = static_cast<float>(d);
    if (!is_beyond_float()) return;
    // Its sign counts.
    record.d = std::copysign(std::clamp(std::abs(record.d), std::numeric_limits<float>::min(),
                                        std::numeric_limits<float>::max()),
                             static_cast<float>(d < 0.0 ? -1.0 : 1.0));
  }
};

}  // namespace

PolygonRecord make_plane(const glm::vec3& origin, const Corners& t) {
  PolygonRecord record;
  Plane(origin, t).put(record);
  return record;
}

PolygonRecord make_record(const glm::vec3& origin, const Corners& t) {
  PolygonRecord record;
  const Plane plane(origin, t);
  plane.put(record);
  for (int k = 0; k < 3; ++k) {
    record.edges[k] = edge_words(origin, t[k], t[(k + 1) % 3]);
    record.bounds[k] = edge_bound(record.edges[k]);
  }
  // Then exact arithmetic has the last word.
  if (plane.is_beyond_float()) record.bounds.fill(std::numeric_limits<float>::infinity());
  return record;
}

}  // namespace raygate
