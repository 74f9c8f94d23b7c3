#include "host/intersect/intersector.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <utility>

#include "host/base/lanes.h"
#include "host/intersect/polygon_record.h"

namespace raygate {
namespace {

bool overlap(const Interval& a, const Interval& b) { return a.low <= b.high && b.low <= a.high; }

/// Returns whether the interval decides on which side of t_max the hit is.
bool tells(const Interval& t, float t_max) { return t.high < t_max || t.low >= t_max; }

}  // namespace

void Intersector::nearest(std::span<const Ray> rays, const RayQuery& query,
                          std::span<NearestHit> hits) {
  assert(hits.size() == rays.size());
  for (NearestHit& hit : hits) hit.primitive = NearestHit::kNone;  // other members are not valid
  std::ranges::fill(query.work, RayWork{});
  trace(rays, query, hits);
}

void Intersector::occluded(std::span<const Ray> rays, RayQuery query, std::span<NearestHit> hits) {
  query.with_points = false;
  nearest(rays, query, hits);
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

namespace {

constexpr std::size_t kPointBatch = 256;  // hits whose points are computed together

/// Sets the points of the hits with these indices, at most kPointBatch.
void write_batch(const Bvh& bvh, std::span<const Ray> rays, bool is_common,
                 std::span<const std::uint32_t> numbers, std::span<NearestHit> hits) {
  // By plane: its primitive, a ray that hits it, N and d. By hash: the last plane of a primitive.
  // Plane indices have 16 bits, as bytes might alias any other variable.
  std::uint32_t primitives[kPointBatch + 1] = {}, firsts[kPointBatch + 1];
  float words[4][kPointBatch];
  std::uint16_t last[kPointBatch] = {}, plane_of[kPointBatch];
  std::size_t planes = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::uint32_t primitive = hits[numbers[i]].primitive;
    std::uint16_t unused = 0xFFFF;
    std::uint16_t& plane = is_common ? last[primitive % kPointBatch] : unused;
    // Branchless, as a branch would be unpredictable.
    const bool known = (plane < planes) & (primitives[plane % kPointBatch] == primitive);
    plane_of[i] = plane = static_cast<std::uint16_t>(known ? plane : planes);
    primitives[planes] = primitive;
    firsts[planes] = numbers[i];
    planes += known ? 0 : 1;
  }
  for (std::size_t first = 0; first < planes; first += kPlanes) {
    PlaneViews views;
    for (std::size_t i = 0; i < kPlanes; ++i) {
      const std::size_t plane = std::min(first + i, planes - 1);
      views.origins[i] = rays[firsts[plane]].origin;
      views.triangles[i] = bvh.corners_of(primitives[plane]);
    }
    Planes four;
    make_planes(views, four);
    for (int k = 0; k < 4; ++k) std::memcpy(&words[k][first], four.words[k], sizeof four.words[k]);
  }
  in_vectors([&](auto) RAYGATE_BODY {
    for (std::size_t first = 0; first < numbers.size(); first += kQuad) {
      FloatQuad rows[kQuad], n[kQuad], point[3];  // n[3]: d of the plane
      std::uint32_t number[kQuad];
      std::uint16_t plane[kQuad];
      for (std::size_t i = 0; i < kQuad; ++i) {
        const std::size_t at = std::min(first + i, numbers.size() - 1);
        number[i] = numbers[at];
        rows[i] = load<FloatQuad>(reinterpret_cast<const float*>(&rays[number[i]] + 1) - kQuad);
        plane[i] = plane_of[at];
      }
      for (int k = 0; k < 4; ++k) {
        const float* const of = words[k];
        n[k] = FloatQuad{of[plane[0]], of[plane[1]], of[plane[2]], of[plane[3]]};
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
}

}  // namespace

void write_points(const Bvh& bvh, std::span<const Ray> rays, bool is_common,
                  std::span<const std::uint32_t> numbers, std::span<NearestHit> hits) {
  for (std::size_t first = 0; first < numbers.size(); first += kPointBatch) {
    const std::size_t count = std::min(kPointBatch, numbers.size() - first);
    write_batch(bvh, rays, is_common, numbers.subspan(first, count), hits);
  }
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

bool same_bits(const glm::vec3& a, const glm::vec3& b) {
  using Bits = std::array<std::uint32_t, 3>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

std::string hex(const glm::vec3& v) { return hex_words({&v.x, 3}); }

std::string describe(const Bvh& bvh, const NearestHit& hit) {
  if (hit.primitive == NearestHit::kNone) return "no hit";
  char t[64];
  std::snprintf(t, sizeof t, ", t in [%.17g, %.17g]", hit.t.low, hit.t.high);
  return "triangle " + std::to_string(bvh.triangle_of(hit.primitive)) + ", P" + hex(hit.point) +
         " within " + hex_words({&hit.point_error, 1}) + t;
}

}  // namespace

CheckIntersector::CheckIntersector(const Bvh& bvh, std::unique_ptr<Intersector> intersector,
                                   std::unique_ptr<Intersector> reference)
    : Intersector(intersector->traits()),
      bvh_(bvh),
      intersector_(std::move(intersector)),
      reference_(std::move(reference)) {}

void CheckIntersector::trace(std::span<const Ray> rays, const RayQuery& query,
                             std::span<NearestHit> hits) {
  intersector_->trace(rays, query, hits);
  RayQuery same = query;
  same.work = {};
  same.source_ids = {};  // do not affect results
  expected_.assign(rays.size(), {});
  reference_->trace(rays, same, expected_);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (agree(rays[i], query, i, hits[i], expected_[i])) continue;
    const float limit = query.t_max_of(i);
    throw EngineMismatch("the intersectors differ: ray" + hex(rays[i].origin) + "," +
                         hex(rays[i].direction) + ", limit" + hex_words({&limit, 1}) + ": " +
                         describe(bvh_, hits[i]) + "; reference: " + describe(bvh_, expected_[i]));
  }
}

bool CheckIntersector::agree(const Ray& ray, const RayQuery& query, std::size_t number,
                             const NearestHit& a, const NearestHit& b) const {
  if (a.primitive == NearestHit::kNone || b.primitive == NearestHit::kNone)
    return a.primitive == b.primitive;
  if (!query.any_hit_before.empty() && a.primitive != b.primitive) {
    const float enough = query.any_hit_before[number];
    return is_before(bvh_, ray, a, enough) && is_before(bvh_, ray, b, enough);
  }
  return a.primitive == b.primitive && a.t.low <= b.t.high && b.t.low <= a.t.high &&
         (!query.with_points || (same_bits(a.point, b.point) && a.point_error == b.point_error));
}

}  // namespace raygate
