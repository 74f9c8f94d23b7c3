#include "host/intersect/intersector.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "host/base/lanes.h"
#include "host/intersect/polygon_record.h"

namespace raygate {
namespace {

bool overlap(const Interval& a, const Interval& b) { return a.low <= b.high && b.low <= a.high; }

/// Returns whether the interval decides on which side of t_max the hit is.
bool tells(const Interval& t, float t_max) { return t.high < t_max || t.low >= t_max; }

}  // namespace

void Intersector::clear(const RayQuery& query, std::span<NearestHit> hits) {
  for (NearestHit& hit : hits) hit.primitive = NearestHit::kNone;  // other members are not valid
  std::ranges::fill(query.work, RayWork{});
}

void throw_unscaled(const Ray& ray) {
  const glm::vec3& d = ray.direction;
  char text[160];
  std::snprintf(text, sizeof text,
                "direction (%g, %g, %g): found unscaled, expected a largest component in [1, 2)",
                d.x, d.y, d.z);
  throw std::invalid_argument(text);
}

bool is_before(const Bvh& bvh, const Ray& ray, const NearestHit& hit, float t_max) {
  if (t_max == std::numeric_limits<float>::infinity()) return true;
  if (tells(hit.t, t_max)) return hit.t.high < t_max;
  return compare_hit_to_limit(ray, bvh.corners_of(hit.primitive), t_max) < 0;
}

bool is_nearer(const Bvh& bvh, const Ray& ray, const NearestHit& a, const NearestHit& b) {
  if (!overlap(a.t, b.t)) return a.t.high < b.t.low;
  const int order = compare_hits(ray, bvh.corners_of(a.primitive), bvh.corners_of(b.primitive));
  return order < 0 || (order == 0 && bvh.triangle_of(a.primitive) <= bvh.triangle_of(b.primitive));
}

bool take_if_nearest(const Bvh& bvh, const Ray& ray, float t_max, NearestHit hit, bool is_sure,
                     NearestHit& best, IntersectCounters& counters) {
  const bool is_first = best.primitive == NearestHit::kNone;
  if (!is_sure) {
    const Corners corners = bvh.corners_of(hit.primitive);
    hit.t = hit_distance(ray, corners);
    if (hit.t.low >= t_max || (!is_first && hit.t.low > best.t.high)) return false;
    ++counters.exact_inside;
    if (!hits_triangle(ray, corners)) return false;
  }
  const bool has_limit = t_max != std::numeric_limits<float>::infinity();
  counters.exact_depth += has_limit && !tells(hit.t, t_max);
  if (!is_before(bvh, ray, hit, t_max)) return false;
  if (!is_first) {
    counters.exact_depth += overlap(hit.t, best.t);
    if (!is_nearer(bvh, ray, hit, best)) return false;
    hit.t.high = std::min(hit.t.high, best.t.high);  // nearer than the best
  }
  best = hit;
  return true;
}

namespace {

/// Up to kMost hits on at most four planes, whose P is computed together.
struct PointBatch {
  static constexpr std::size_t kMost = 32;

  PlaneViews views;
  std::uint32_t primitives[kPlanes] = {};
  std::size_t planes = 0, count = 0;
  std::uint32_t numbers[kMost] = {};  // of rays
  std::uint8_t plane_of[kMost] = {};  // by hit

  /// Adds the hit of a ray. Returns false if there is no room for its plane.
  bool add(const Bvh& bvh, const Ray& ray, bool is_common, std::uint32_t number,
           std::uint32_t primitive) {
    std::size_t plane = planes;
    for (std::size_t i = 0; is_common && i < planes; ++i) {
      if (primitives[i] == primitive) plane = i;
    }
    if (plane == kPlanes || count == kMost) return false;
    if (plane == planes) {
      views.origins[planes] = ray.origin;
      views.triangles[planes] = bvh.corners_of(primitive);
      primitives[planes++] = primitive;
    }
    numbers[count] = number;
    plane_of[count++] = static_cast<std::uint8_t>(plane);
    return true;
  }

  void write(std::span<const Ray> rays, std::span<NearestHit> hits) {
    Planes made;
    make_planes(views, made);
    in_vectors([&](auto) RAYGATE_BODY {
      for (std::size_t first = 0; first < count; first += kQuad) {
        FloatQuad rows[kQuad], n[kQuad], point[3];  // n[3]: d of the plane
        std::uint32_t number[kQuad];
        for (std::size_t i = 0; i < kQuad; ++i) {
          const std::size_t at = std::min(first + i, count - 1);
          number[i] = numbers[at];
          rows[i] = load<FloatQuad>(reinterpret_cast<const float*>(&rays[number[i]] + 1) - kQuad);
          for (int k = 0; k < 4; ++k) n[k][static_cast<int>(i)] = made.words[k][plane_of[at]];
        }
        transpose(rows);  // rows[0] is unused: the last coordinate of the origins
        IntQuad largest = {}, error;
        for (int k = 0; k < 3; ++k) largest = maximum(largest, bits_in(n[k]) >> 23 & 0xFF);
        plane_points({n[0], n[1], n[2]}, n[3], largest, {rows[1], rows[2], rows[3]}, point, error);
        std::copy_n(point, 3, rows);
        rows[3] = float_of(error);
        transpose(rows);
        static_assert(offsetof(NearestHit, point_error) ==
                      offsetof(NearestHit, point) + 3 * sizeof(float));
        for (std::size_t i = 0; i < kQuad; ++i) std::memcpy(&hits[number[i]].point, &rows[i], 16);
      }
    });
    planes = count = 0;
  }
};

}  // namespace

std::uint64_t add_points(const Bvh& bvh, std::span<const Ray> rays, bool is_common,
                         std::span<NearestHit> hits) {
  std::uint64_t found = 0;
  PointBatch batch;
  for (std::uint32_t i = 0; i < hits.size(); ++i) {
    const std::uint32_t primitive = hits[i].primitive;
    if (primitive == NearestHit::kNone) continue;
    ++found;
    if (batch.add(bvh, rays[i], is_common, i, primitive)) continue;
    batch.write(rays, hits);
    batch.add(bvh, rays[i], is_common, i, primitive);
  }
  if (batch.count != 0) batch.write(rays, hits);
  return found;
}

}  // namespace raygate
