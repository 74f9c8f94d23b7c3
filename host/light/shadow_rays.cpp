#include "host/light/shadow_rays.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "host/light/bsdf.h"
#include "host/scene/material_lookup.h"

namespace raygate {
namespace {

constexpr float kWholeWay = 1.0f;
constexpr std::size_t kManyPoints = 64;  // beyond this, lights have too few rays each
// Hits of rays from a light below this fraction of the distance are conclusive.
constexpr float kSureOfLight = 1.0f - 0x1p-10f;
constexpr float kBeforeAreaLight = 1.0f - 0x1p-16f;
constexpr float kNoEnd = std::numeric_limits<float>::infinity();

}  // namespace

ShadowRays::ShadowRays(const PreparedScene& prepared, const Lights& lights,
                       Intersector& intersector, bool through_refraction)
    : scene_(prepared.scene),
      materials_(prepared.materials),
      bvh_(prepared.bvh),
      lights_(lights),
      intersector_(intersector),
      spawner_(prepared.clearances),
      through_refraction_(through_refraction),
      any_clear_(std::ranges::any_of(materials_, [](const MaterialParameters& material) {
        return material.has_mask || (material.kind & kTransmits) != 0;
      })) {}

void ShadowRays::resolve(std::span<ShadowRay> rays, std::span<RayWork> work) {
  work_of_samples_ = work;
  next_.clear();
  const std::size_t points = lights_.points().size();
  const bool from_points = points <= kManyPoints;
  for (std::uint32_t light = 0; from_points && light < points; ++light) {
    trace_from_light(rays, light);
  }
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    if (!from_points || rays[i].is_point_light == 0) {
      next_.emplace_back(i, rays[i].surface, rays[i].surface_primitive);
    }
  }
  while (!next_.empty()) trace_from_surface(rays);
}

void ShadowRays::trace_from_light(std::span<ShadowRay> rays, std::uint32_t point_light) {
  segments_.clear();
  const glm::vec3& position = lights_.points()[point_light].position;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    if (rays[i].is_point_light == 0 || rays[i].index != point_light) continue;
    segments_.emplace_back(i, position, NearestHit::kNone);
  }
  if (segments_.empty()) return;
  trace(rays, true, kSureOfLight);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const NearestHit& hit = hits_[i];
    if (hit.primitive == NearestHit::kNone) continue;
    ShadowRay& ray = rays[segments_[i].index];
    const bool is_sure = is_before(bvh_, batch_[i], hit, enough_[i]);
    if (is_sure && (!any_clear_ || transmittance(i) == glm::vec3(0.0f))) {
      ray.radiance = glm::vec3(0.0f);
    } else {
      next_.emplace_back(segments_[i].index, ray.surface, ray.surface_primitive);
    }
  }
}

void ShadowRays::trace_from_surface(std::span<ShadowRay> rays) {
  segments_.swap(next_);
  next_.clear();
  spawn_queries_.clear();
  trace(rays, false, kWholeWay);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const NearestHit& hit = hits_[i];
    if (hit.primitive == NearestHit::kNone) continue;
    ShadowRay& ray = rays[segments_[i].index];
    ray.radiance *= any_clear_ ? transmittance(i) : glm::vec3(0.0f);
    if (ray.radiance == glm::vec3(0.0f)) continue;
    spawn_queries_.push_back({&batch_[i], hit.primitive, SpawnSide::kTransmitted});
    next_.push_back(segments_[i]);
  }
  origins_.resize(spawn_queries_.size());
  spawner_.find(spawn_queries_, origins_);
  segments_.swap(next_);
  next_.clear();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    if (origins_[i]) {
      next_.emplace_back(segments_[i].index, *origins_[i], spawn_queries_[i].primitive);
    } else {
      rays[segments_[i].index].radiance = glm::vec3(0.0f);
    }
  }
}

/// Traces all segments. A search may end at any hit within the fraction `enough` of the distance.
void ShadowRays::trace(std::span<const ShadowRay> rays, bool from_light, float enough) {
  const std::size_t count = segments_.size();
  batch_.resize(count);
  limits_.resize(count);
  enough_.resize(count);
  ignored_.resize(count);
  sources_.resize(from_light || !intersector_.traits().wants_sources ? 0 : count);
  for (std::size_t i = 0; i < count; ++i) {
    const Segment& segment = segments_[i];
    const ShadowRay& ray = rays[segment.index];
    const bool is_point_light = ray.is_point_light != 0;
    const bool is_to_point = is_point_light || ray.is_to_camera != 0;
    const bool is_endless = !is_to_point && ray.index == NearestHit::kNone;
    // Fraction of the distance in which hits count.
    const float share = is_to_point ? kWholeWay : kBeforeAreaLight;
    const glm::vec3& to = from_light       ? ray.surface
                          : is_point_light ? lights_.points()[ray.index].position
                                           : ray.target;
    batch_[i].origin = segment.from;
    ignored_[i] = from_light       ? ray.surface_primitive
                  : is_point_light ? NearestHit::kNone
                                   : ray.index;
    const glm::vec3 way = is_endless ? to : to - segment.from;
    const float size = largest(way);
    // t of the end: the power of two by which `way` is divided. The direction equals the result of
    // scaled_direction(), which is slower.
    auto end = std::bit_cast<float>(std::bit_cast<std::uint32_t>(size) & 0x7F800000u);
    if (end != 0.0f) [[likely]] {
      batch_[i].direction = way * (1.0f / end);
    } else if (size != 0.0f) {  // subnormal
      batch_[i].direction = scaled_direction(glm::dvec3(way));
      end = size / largest(batch_[i].direction);
    } else {  // zero length, which hits nothing
      batch_[i].direction = way;
      end = 1.0f;
    }
    limits_[i] = is_endless ? kNoEnd : end * share;
    enough_[i] = is_endless ? kNoEnd : end * std::min(enough, share);
    // Rounding may turn a grazing ray back towards its own triangle.
    if (!sources_.empty()) {
      const bool leaves = !is_ahead(batch_[i], bvh_.corners_of(segment.source));
      sources_[i] = leaves ? segment.source : NearestHit::kNone;
    }
  }
  RayQuery search{.common_origin = from_light,
                  .t_max = limits_,
                  .source_ids = sources_,
                  .skip_ids = ignored_,
                  .with_points = false};
  if (!any_clear_) search.any_hit_before = enough_;  // any occluder ends the search
  work_.resize(work_of_samples_.empty() ? 0 : batch_.size());
  search.work = work_;
  hits_.resize(batch_.size());
  intersector_.nearest(batch_, search, hits_);
  rays_ += batch_.size();
  for (std::size_t i = 0; i < work_.size(); ++i) {
    work_of_samples_[rays[segments_[i].index].sample] += work_[i];
  }
}

glm::vec3 ShadowRays::transmittance(std::size_t number) const {
  const std::uint32_t primitive = hits_[number].primitive;
  const FaceRef stored = bvh_.face_of(primitive);
  const SurfaceHit place = {&batch_[number], primitive, &face_at(scene_, stored), nullptr,
                            instance_at(scene_, stored)};
  const MaterialParameters& material = materials_[place.face->material];
  if (material.has_mask && is_masked_out(scene_, bvh_, place)) return glm::vec3(1.0f);
  if ((material.kind & kTransmits) == 0 || (material.refracts && !through_refraction_)) {
    return glm::vec3(0.0f);
  }
  const Triple<float> through = bsdf_at(scene_, bvh_, place, material).transmission;
  return {through.x, through.y, through.z};
}

}  // namespace raygate
