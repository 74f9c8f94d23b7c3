#include "host/intersect/polygon_record.h"

#include <cassert>
#include <cstring>
#include <limits>
#include <utility>

namespace raygate {

// The bound of an edge test
//
// To show: |float32(I . F) - I . E| < kEdgeBound u |F|_1. Here u = 2^-24 is the unit roundoff of
// float, and |X|_1 the sum of the magnitudes of X's components. E is the exact edge plane A x B for
// corners A, B minus the origin (times the record's power of two, if any). D is E computed in
// double, and F is D rounded to float. I is a direction with |I_i| < 2, so |I . X| < 2 |X|_1.
//
// 1. Double: |D_i - E_i| <= 2^-34 |D|_1 by edge_normal. For all components together,
//    |D - E|_1 <= 3 * 2^-34 |D|_1.
// 2. Rounding to float: |F_i - D_i| <= u |F_i|, or 2^-150 if F_i is subnormal. Together,
//    |F - D|_1 <= u |F|_1 + 3 * 2^-150, and so |D|_1 < 1.001 |F|_1.
//    From 1 and 2: |I . F - I . E| < (2 + 6.006 * 2^-10) u |F|_1 + 6 * 2^-150.
// 3. The dot product in float, in any order: each product has at most three roundings (its own and
//    two sums). Their error is at most (3 u / (1 - 3 u)) |I|.|F| < 6.00001 u |F|_1. Products that
//    underflow add at most 2^-150 each, less than 2^-148 in all. Sums do not underflow.
// 4. make_record keeps max |F_i| between 2^-60 and 2^61. So nothing overflows, and the underflow
//    terms, less than 2^-146 in all, are under 2^-62 u |F|_1.
//
// Sum: less than (8 + 0.00587 + 0.00001 + 2^-62) u |F|_1. The margin up to kEdgeBound covers
// evaluating the bound in double. Its rounding to float is upwards.

namespace {

/// Returns whether x is 0 or has an exponent in [-60, 60], which is safe from under- and overflow
/// in all later steps; false for NaN.
bool ordinary(double x) { return x == 0.0 || (std::abs(x) >= 0x1p-60 && std::abs(x) < 0x1p61); }

bool lower(const glm::dvec3& a, const glm::dvec3& b) {
  return std::pair(a.x, std::pair(a.y, a.z)) < std::pair(b.x, std::pair(b.y, b.z));
}

/// Returns A x B in float for A = a - origin and B = b - origin, computed as A x (B - A), which
/// cancels less for a distant triangle. Always starts from the lower vertex, so that the two
/// triangles at an edge get exactly negated words.
glm::vec3 edge_words(const glm::dvec3& origin, const glm::dvec3& a, const glm::dvec3& b) {
  glm::dvec3 edge = lower(a, b) ? edge_normal(origin, a, b) : -edge_normal(origin, b, a);
  if (!ordinary(largest(edge))) edge = scaled_by(edge, to_unit(edge));
  return glm::vec3(edge);
}

float edge_bound(const glm::vec3& edge) {
  const glm::dvec3 e = glm::abs(glm::dvec3(edge));
  return float_above(kEdgeBound * 0x1p-24 * (e.x + e.y + e.z));
}

/// Sets the plane of a record. Returns whether d is 0 or in the range of normal floats; if not,
/// only the sign of d is right.
bool set_plane(const glm::dvec3& origin, const Corners& t, PolygonRecord& record) {
  glm::dvec3 normal = triangle_normal(t);
  double d = plane_distance(origin, t);
  if (!ordinary(largest(normal)) || !ordinary(d)) {
    const int exponent = to_unit(normal);
    normal = scaled_by(normal, exponent);
    d = std::ldexp(d, exponent);
  }
  record.normal = glm::vec3(normal);
  record.d = static_cast<float>(d);
  if (d == 0.0 || std::isnormal(record.d)) return true;
  record.d = std::copysign(std::clamp(std::abs(record.d), std::numeric_limits<float>::min(),
                                      std::numeric_limits<float>::max()),
                           record.d);
  return false;
}

// The functions below do the operations of exact.cpp and of the functions above, in the same order.
// So all bits are equal if double is accurate enough and exponents ordinary; else see make_record.

constexpr double kU = 0x1p-53;  // as in exact.cpp

using Points = Triple<DoubleQuad>;

/// Clears `good` in lanes in which `size` is neither 0 nor has an exponent in [-60, 60].
RAYGATE_INLINE void require_ordinary(const DoubleQuad& size, LongQuad& good) {
  good &= ((size >= 0x1p-60) & (size < 0x1p61)) | (size == 0.0);
}

/// Computes u x v; clears `good` in lanes whose product is not accurate enough or not ordinary.
RAYGATE_INLINE void accurate_cross(const Points& u, const Points& v, Points& value, Points& size,
                                   LongQuad& good) {
  value = cross(u, v, size);
  const Points s = absolute(value);
  good &= 8.0 * kU * largest(size) <= 0x1p-34 * (s.x + s.y + s.z);
  require_ordinary(largest(s), good);
}

/// Stores words a, b, c, d of each record i in words[i][first] to words[i][first + 3].
template <std::size_t kWords>
RAYGATE_INLINE void store_words(const FloatQuad& a, const FloatQuad& b, const FloatQuad& c,
                                const FloatQuad& d, float (&words)[kQuad][kWords],
                                std::size_t first = 0) {
  FloatQuad record[kQuad] = {a, b, c, d};
  transpose(record);
  for (int i = 0; i < kQuad; ++i) std::memcpy(&words[i][first], &record[i], 16);
}

/// Returns the same as edge_bound above, for four edges.
RAYGATE_INLINE FloatQuad edge_bound(const Triple<FloatQuad>& words) {
  const Points e = absolute(wide(words));
  const DoubleQuad exact = kEdgeBound * 0x1p-24 * (e.x + e.y + e.z);
  const FloatQuad nearest = narrow(exact);
  return float_of(bits_in(nearest) - whole(wide(nearest) < exact));
}

/// Loads the corners of four triangles, lane by lane: vector loads after single stores would stall.
RAYGATE_INLINE void load_corners(const PlaneViews& views, Points (&t)[3]) {
  const Corners(&of)[kQuad] = views.triangles;
  for (std::size_t v = 0; v < 3; ++v) {
    const auto axis = [&](int k) RAYGATE_BODY {
      return DoubleQuad{of[0][v][k], of[1][v][k], of[2][v][k], of[3][v][k]};
    };
    t[v] = {axis(0), axis(1), axis(2)};
  }
}

/// Computes N and d from the corners `t` and from `a`, the first corner minus the origin. Clears
/// `good` in lanes in which N or d is not accurate.
RAYGATE_INLINE void find_planes(const Points (&t)[3], const Points& a, Points& normal,
                                DoubleQuad& d, LongQuad& good) {
  Points size;
  accurate_cross(t[1] - t[0], t[2] - t[0], normal, size, good);
  d = dot(a, normal);
  const DoubleQuad error = 10.0 * kU * dot(absolute(a), size);
  const DoubleQuad distance = absolute(d);
  good &= (error <= 0x1p-32 * distance) & (distance > error);
  require_ordinary(distance, good);
}

/// Computes the 16 words of four records. Returns a mask: bit i is set if record i is valid.
LaneMask make_four(const glm::vec3& origin, const PlaneViews& views, float (&words)[kQuad][16]) {
  return in_vectors([&](auto) RAYGATE_BODY {
    Points t[3];
    load_corners(views, t);
    const Points o = wide(spread<FloatQuad>(origin));
    const Points from_o[3] = {t[0] - o, t[1] - o, t[2] - o};
    LongQuad good = LongQuad{} - 1;
    Points normal, size;
    DoubleQuad d;
    find_planes(t, from_o[0], normal, d, good);
    const Triple<FloatQuad> n = narrow(normal);
    Triple<FloatQuad> edges[3];
    FloatQuad bounds[3];
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const Points &p = t[k], &q = t[next];
      const LongQuad lower =
          (p.x < q.x) | ((p.x == q.x) & ((p.y < q.y) | ((p.y == q.y) & (p.z < q.z))));
      Points edge;
      accurate_cross(choose(lower, from_o[k], from_o[next]), choose(lower, q - p, p - q), edge,
                     size, good);
      edges[k] = narrow(choose(lower, edge, -edge));
      bounds[k] = edge_bound(edges[k]);
    }
    store_words(n.x, n.y, n.z, narrow(d), words);
    store_words(edges[0].x, edges[0].y, edges[0].z, edges[1].x, words, 4);
    store_words(edges[1].y, edges[1].z, edges[2].x, edges[2].y, words, 8);
    store_words(edges[2].z, bounds[0], bounds[1], bounds[2], words, 12);
    return sign_mask(whole(good));
  });
}

}  // namespace

PolygonRecord make_plane(const glm::dvec3& origin, const Corners& t) {
  PolygonRecord record;
  set_plane(origin, t, record);
  return record;
}

PolygonRecord make_record(const glm::dvec3& origin, const Corners& t) {
  PolygonRecord record;
  const bool is_in_range = set_plane(origin, t, record);
  for (int k = 0; k < 3; ++k) {
    record.edges[k] = edge_words(origin, t[k], t[(k + 1) % 3]);
    record.bounds[k] = edge_bound(record.edges[k]);
  }
  // Exact arithmetic decides if d is out of range.
  if (!is_in_range) record.bounds.fill(std::numeric_limits<float>::infinity());
  return record;
}

void make_planes(const PlaneViews& views, float (&words)[4][kQuad]) {
  const LaneMask good_lanes = in_vectors([&](auto) RAYGATE_BODY {
    Points t[3], normal;
    load_corners(views, t);
    const glm::vec3(&from)[kQuad] = views.origins;
    const auto axis = [&](int k) RAYGATE_BODY {
      return wide(FloatQuad{from[0][k], from[1][k], from[2][k], from[3][k]});
    };
    LongQuad good = LongQuad{} - 1;
    DoubleQuad d;
    find_planes(t, t[0] - Points{axis(0), axis(1), axis(2)}, normal, d, good);
    store(words[0], narrow(normal.x));
    store(words[1], narrow(normal.y));
    store(words[2], narrow(normal.z));
    store(words[3], narrow(d));
    return sign_mask(whole(good));
  });
  for (const int i : SetBits(~good_lanes & ((1u << kQuad) - 1))) {
    const PolygonRecord plane = make_plane(views.origins[i], views.triangles[i]);
    for (int k = 0; k < 3; ++k) words[k][i] = plane.normal[k];
    words[3][i] = plane.d;
  }
}

void make_records(const glm::vec3& origin, std::span<const Corners> triangles,
                  std::span<PolygonRecord> records) {
  assert(triangles.size() == records.size());
  for (std::size_t first = 0; first < triangles.size(); first += kQuad) {
    const std::size_t count = std::min<std::size_t>(kQuad, triangles.size() - first);
    PlaneViews batch;
    for (std::size_t i = 0; i < kQuad; ++i) {
      batch.triangles[i] = triangles[first + std::min(i, count - 1)];
    }
    float words[kQuad][16];
    const LaneMask good = make_four(origin, batch, words);
    for (std::size_t i = 0; i < count; ++i) {
      PolygonRecord& record = records[first + i];
      if ((good >> i & 1) != 0) {
        static_assert(sizeof record == sizeof words[i]);
        std::memcpy(static_cast<void*>(&record), words[i], sizeof record);
      } else {
        record = make_record(origin, triangles[first + i]);
      }
    }
  }
}

}  // namespace raygate
