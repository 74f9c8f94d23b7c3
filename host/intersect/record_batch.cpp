#include "host/intersect/record_batch.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>

#include "host/base/lanes.h"

// The operations are those of exact.cpp and polygon_record.cpp, in their order, so the bits are
// theirs, as long as double is accurate enough and all exponents are ordinary. Where that is not
// so for a triangle, make_record has it.

namespace raygate {
namespace {

constexpr int kBatch = kPlanes;

using Doubles = DoubleQuad;
using Longs = LongQuad;
using Floats = FloatQuad;
using Ints = IntQuad;

constexpr double kU = 0x1p-53;  // as in exact.cpp

using Points = Doubles[3];

RAYGATE_INLINE void subtract(const Points& a, const Points& b, Points& result) {
  for (int k = 0; k < 3; ++k) result[k] = a[k] - b[k];
}

RAYGATE_INLINE Doubles largest_of(const Points& p) { return maximum(maximum(p[0], p[1]), p[2]); }

/// The exponent of each is in [-60, 60], or it is 0.
RAYGATE_INLINE void require_ordinary(const Doubles& size, Longs& good) {
  good &= ((size >= 0x1p-60) & (size < 0x1p61)) | (size == 0.0);
}

/// u x v; leaves those lanes good in which it is accurate enough and of an ordinary size.
RAYGATE_INLINE void accurate_cross(const Points& u, const Points& v, Points& value, Points& size,
                                   Longs& good) {
  cross(u, v, value, size);
  Points s;
  for (int k = 0; k < 3; ++k) s[k] = absolute(value[k]);
  good &= 8.0 * kU * largest_of(size) <= 0x1p-34 * (s[0] + s[1] + s[2]);
  require_ordinary(largest_of(s), good);
}

/// Four words of four records each, from four vectors of one word each; words[i] begins record i.
template <std::size_t kWords>
RAYGATE_INLINE void store_words(const Floats& a, const Floats& b, const Floats& c, const Floats& d,
                                float (&words)[kBatch][kWords], std::size_t first = 0) {
  Floats record[kBatch] = {a, b, c, d};
  transpose(record);
  for (int i = 0; i < kBatch; ++i) std::memcpy(&words[i][first], &record[i], 16);
}

RAYGATE_INLINE void to_floats(const Points& p, Floats (&words)[3]) {
  for (int k = 0; k < 3; ++k) words[k] = narrow(p[k]);
}

/// The bound of an edge: its sum of magnitudes times a constant, rounded up.
RAYGATE_INLINE Floats edge_bound(const Floats (&words)[3]) {
  Doubles e[3];
  for (int k = 0; k < 3; ++k) e[k] = absolute(wide(words[k]));
  const Doubles exact = kEdgeBound * 0x1p-24 * (e[0] + e[1] + e[2]);
  const Floats nearest = narrow(exact);
  return float_of(bits_in(nearest) - whole(wide(nearest) < exact));
}

/// The corners of four triangles. (Lane by lane: words that were stored one by one do not reach a
/// vector's load before they are in the cache.)
RAYGATE_INLINE void load_corners(const PlaneViews& views, Points (&t)[3]) {
  const Corners(&of)[kBatch] = views.triangles;
  for (int v = 0; v < 3; ++v) {
    for (int k = 0; k < 3; ++k) {
      t[v][k] = wide(Floats{of[0][v][k], of[1][v][k], of[2][v][k], of[3][v][k]});
    }
  }
}

/// N and d, from the corners and the first one seen from the origin; leaves those lanes good in
/// which they are right.
RAYGATE_INLINE void find_planes(const Points (&t)[3], const Points& a, Points& normal, Doubles& d,
                                Longs& good) {
  Points to_b, to_c, size, far;
  subtract(t[1], t[0], to_b);
  subtract(t[2], t[0], to_c);
  accurate_cross(to_b, to_c, normal, size, good);
  d = a[0] * normal[0] + a[1] * normal[1] + a[2] * normal[2];
  for (int k = 0; k < 3; ++k) far[k] = absolute(a[k]);
  const Doubles error = 10.0 * kU * (far[0] * size[0] + far[1] * size[1] + far[2] * size[2]);
  const Doubles distance = absolute(d);
  good &= (error <= 0x1p-32 * distance) & (distance > error);
  require_ordinary(distance, good);
}

}  // namespace

/// Four words of 16 each, and bit i of the result where record i is right.
LaneMask make_four(const glm::vec3& origin, const PlaneViews& views, float (&words)[kBatch][16]) {
  return in_vectors([&](auto) RAYGATE_BODY {
    Points t[3], from_o[3];
    load_corners(views, t);
    const Points o = {Doubles{} + origin.x, Doubles{} + origin.y, Doubles{} + origin.z};
    for (int v = 0; v < 3; ++v) subtract(t[v], o, from_o[v]);
    Longs good = Longs{} - 1;
    Points normal, size;
    Doubles d;
    find_planes(t, from_o[0], normal, d, good);
    Floats n[3], edges[3][3], bounds[3];
    to_floats(normal, n);

    for (int k = 0; k < 3; ++k) {
      const Points &p = t[k], &q = t[(k + 1) % 3];
      const Longs lower =
          (p[0] < q[0]) | ((p[0] == q[0]) & ((p[1] < q[1]) | ((p[1] == q[1]) & (p[2] < q[2]))));
      const Points &pf = from_o[k], &qf = from_o[(k + 1) % 3];
      Points start, way, edge;
      for (int i = 0; i < 3; ++i) {
        start[i] = lower ? pf[i] : qf[i];
        way[i] = lower ? q[i] - p[i] : p[i] - q[i];
      }
      accurate_cross(start, way, edge, size, good);
      for (int i = 0; i < 3; ++i) edge[i] = lower ? edge[i] : -edge[i];
      to_floats(edge, edges[k]);
      bounds[k] = edge_bound(edges[k]);
    }
    store_words(n[0], n[1], n[2], narrow(d), words);
    store_words(edges[0][0], edges[0][1], edges[0][2], edges[1][0], words, 4);
    store_words(edges[1][1], edges[1][2], edges[2][0], edges[2][1], words, 8);
    store_words(edges[2][2], bounds[0], bounds[1], bounds[2], words, 12);
    return sign_mask(whole(good));
  });
}

/// Bit i of the result where plane i is right.
LaneMask make_four_planes(const PlaneViews& views, Planes& planes) {
  return in_vectors([&](auto) RAYGATE_BODY {
    Points t[3], a, normal;
    load_corners(views, t);
    for (int k = 0; k < 3; ++k) {
      const glm::vec3(&from)[kBatch] = views.origins;
      a[k] = t[0][k] - wide(Floats{from[0][k], from[1][k], from[2][k], from[3][k]});
    }
    Longs good = Longs{} - 1;
    Doubles d;
    find_planes(t, a, normal, d, good);
    Floats words[4];
    for (int k = 0; k < 3; ++k) words[k] = narrow(normal[k]);
    words[3] = narrow(d);
    static_assert(sizeof words == sizeof planes.words);
    std::memcpy(planes.words, words, sizeof words);
    return sign_mask(whole(good));
  });
}

void make_planes(const PlaneViews& views, Planes& planes) {
  const LaneMask good = make_four_planes(views, planes);
  for (LaneMask left = ~good & ((1u << kPlanes) - 1); left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    const PolygonRecord plane = make_plane(views.origins[i], views.triangles[i]);
    for (int k = 0; k < 3; ++k) planes.words[k][i] = plane.normal[k];
    planes.words[3][i] = plane.d;
  }
}

void make_records(const glm::vec3& origin, std::span<const Corners> triangles,
                  std::span<PolygonRecord> records) {
  assert(triangles.size() == records.size());
  for (std::size_t first = 0; first < triangles.size(); first += kBatch) {
    const std::size_t count = std::min<std::size_t>(kBatch, triangles.size() - first);
    PlaneViews batch;
    for (std::size_t i = 0; i < kBatch; ++i) {
      batch.triangles[i] = triangles[first + std::min(i, count - 1)];
    }
    float words[kBatch][16];
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
