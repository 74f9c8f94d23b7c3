#include "host/intersect/polygon_record.h"

#include <cmath>
#include <limits>
#include <utility>

namespace raygate {

// The bound of an edge test
//
// Let u = 2^-24, E the exact edge plane A x B (times the record's power of two, if any), D the
// double before rounding, F the record's float words, I a direction with |I_i| < 2, so that |I . X|
// < 2 |X|_1 for any X. |.|_1 is the sum of magnitudes.
//
// 1. Double. edge_normal guarantees |D_i - E_i| <= 2^-34 |D|_1, including cancellation in the cross
//    product: it uses exact arithmetic if double is less accurate. Together: |D - E|_1 <= 3 * 2^-34
//    |D|_1.
// 2. Rounding to float. |F_i - D_i| <= u |F_i|, or 2^-150 if F_i is subnormal. Together: |F - D|_1
//    <= u |F|_1 + 3 * 2^-150, and so |D|_1 < 1.001 |F|_1. 1 and 2:  |I . F - I . E| < (2 + 6.006 *
//    2^-10) u |F|_1 + 6 * 2^-150.
// 3. The dot product in float, in any order: a product takes part in at most three roundings (its
//    own and two sums), so the error of the result is (3 u / (1 - 3 u)) |I|.|F| < 6.00001 u |F|_1;
//    a product that underflows adds at most 2^-150 (sums do not underflow), three of them 2^-148.
// 4. make_record keeps max |F_i| between 2^-60 and 2^61. So nothing overflows, and the underflow
//    terms, less than 2^-146 in all, are under 2^-62 u |F|_1.
//
// Sum: less than (8 + 0.00587 + 0.00001 + 2^-62) u |F|_1 < kEdgeBound u |F|_1. The margin covers
// evaluating the latter in double; the rounding to float is upwards.

namespace {

// Words with exponents in this range are safe from under- and overflow in all later steps.
constexpr double kSmallest = 0x1p-60, kLargest = 0x1p61;

/// Returns whether x is 0 or in that range; false for NaN.
bool ordinary(double x) {
  const double size = std::abs(x);
  return size == 0.0 || (size >= kSmallest && size < kLargest);
}

/// Returns the exponent of the power of two that scales the largest component of `v` into [1, 2).
int to_unit(const glm::dvec3& v) {
  const double size = largest(v);
  return size > 0.0 && std::isfinite(size) ? -std::ilogb(size) : 0;
}

glm::dvec3 scaled(const glm::dvec3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

bool lower(const glm::vec3& a, const glm::vec3& b) {
  return std::pair(a.x, std::pair(a.y, a.z)) < std::pair(b.x, std::pair(b.y, b.z));
}

/// Returns A x B in float. Computed from the lower vertex, A x B = A x (B - A), regardless of the
/// edge's direction, so neighbours get exactly opposite numbers. The difference, small for a
/// distant triangle, avoids cancellation in A x B.
glm::vec3 edge_words(const glm::vec3& origin, const glm::vec3& a, const glm::vec3& b) {
  glm::dvec3 edge = lower(a, b) ? edge_normal(origin, a, b) : -edge_normal(origin, b, a);
  if (!ordinary(largest(edge))) edge = scaled(edge, to_unit(edge));
  return glm::vec3(edge);
}

float edge_bound(const glm::vec3& edge) {
  const glm::dvec3 e = glm::abs(glm::dvec3(edge));
  return float_above(kEdgeBound * 0x1p-24 * (e.x + e.y + e.z));
}

/// A plane scaled by the record's power of two.
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

  /// Returns whether d is outside the range of normal floats.
  [[nodiscard]] bool is_beyond_float() const {
    return d != 0.0 && !std::isnormal(static_cast<float>(d));
  }

  void put(PolygonRecord& record) const {
    record.normal = glm::vec3(normal);
    record.d = static_cast<float>(d);
    if (!is_beyond_float()) return;
    // Only the sign is used.
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
  // Exact arithmetic then decides.
  if (plane.is_beyond_float()) record.bounds.fill(std::numeric_limits<float>::infinity());
  return record;
}

// Operations and their order are those of exact.cpp, so all bits are equal, as long as double is
// accurate enough and all exponents are ordinary. For other triangles make_plane computes the
// plane.

namespace {

using Points = DoubleQuad[3];

RAYGATE_INLINE DoubleQuad largest_of(const Points& p) { return maximum(maximum(p[0], p[1]), p[2]); }

/// Returns the lanes whose value is 0 or has an exponent in [-60, 60].
RAYGATE_INLINE LongQuad are_ordinary(const DoubleQuad& size) {
  return ((size >= kSmallest) & (size < kLargest)) | (size == 0.0);
}

/// Computes the planes in each lane. Bit i of the result is set if plane i is accurate.
LaneMask make_four_planes(const PlaneViews& views, Planes& planes) {
  constexpr double kU = 0x1p-53;  // as in exact.cpp
  return in_vectors([&](auto) RAYGATE_BODY {
    // The corners by lane, as vector loads after single stores would stall.
    const auto& t = views.triangles;
    const auto& o = views.origins;
    Points a, to_b, to_c, normal, size, magnitude, far;
    for (int k = 0; k < 3; ++k) {
      const auto corner = [&](std::size_t v) RAYGATE_BODY {
        return wide(FloatQuad{t[0][v][k], t[1][v][k], t[2][v][k], t[3][v][k]});
      };
      const DoubleQuad first = corner(0);
      a[k] = first - wide(FloatQuad{o[0][k], o[1][k], o[2][k], o[3][k]});
      to_b[k] = corner(1) - first;
      to_c[k] = corner(2) - first;
    }
    cross(to_b, to_c, normal, size);
    for (int k = 0; k < 3; ++k) {
      magnitude[k] = absolute(normal[k]);
      far[k] = absolute(a[k]);
    }
    const DoubleQuad d = a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2];
    const DoubleQuad error = 10.0 * kU * (far[0] * size[0] + far[1] * size[1] + far[2] * size[2]);
    const DoubleQuad distance = absolute(d);
    const LongQuad good =
        (8.0 * kU * largest_of(size) <= 0x1p-34 * (magnitude[0] + magnitude[1] + magnitude[2])) &
        are_ordinary(largest_of(magnitude)) & (error <= 0x1p-32 * distance) & (distance > error) &
        are_ordinary(distance);
    for (int k = 0; k < 3; ++k) store(planes.words[k], narrow(normal[k]));
    store(planes.words[3], narrow(d));
    return sign_mask(whole(good));
  });
}

}  // namespace

void make_planes(const PlaneViews& views, Planes& planes) {
  const LaneMask good = make_four_planes(views, planes);
  for (LaneMask left = ~good & ((1u << kPlanes) - 1); left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    const PolygonRecord plane = make_plane(views.origins[i], views.triangles[i]);
    for (int k = 0; k < 3; ++k) planes.words[k][i] = plane.normal[k];
    planes.words[3][i] = plane.d;
  }
}

}  // namespace raygate
