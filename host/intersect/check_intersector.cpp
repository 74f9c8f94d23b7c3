#include "host/intersect/check_intersector.h"

#include <array>
#include <utility>

namespace raygate {
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
