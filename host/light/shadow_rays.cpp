#include "host/light/shadow_rays.h"

#include <algorithm>
#include <cmath>

#include "host/light/bsdf.h"
#include "host/light/surface.h"

namespace raygate {
namespace {

constexpr double kWholeWay = 1.0;
constexpr double kSureOfLight = 1.0 - 0x1p-10;  // hits of a ray from a light that surely count
constexpr double kBeforeAreaLight = 1.0 - 0x1p-16;

/// The t at which a ray in the scaled direction of `way` has gone all of it, times `share`.
float scaled_way(const glm::dvec3& way, double share) {
  const double size = largest(way);
  const int exponent = std::ilogb(size);
  // As in scaled_direction: 1.99999999 becomes 2 as a float, and then 1.
  const bool carries = static_cast<float>(std::scalbn(size, -exponent)) >= 2.0f;
  return static_cast<float>(std::ldexp(share, exponent + (carries ? 1 : 0)));
}

}  // namespace

ShadowRays::ShadowRays(const Scene& scene, const Clearances& clearances, const Lights& lights,
                       Finder& finder, const Skips& skips, bool through_refraction)
    : scene_(scene),
      bvh_(clearances.bvh()),
      lights_(lights),
      finder_(finder),
      departure_(clearances),
      culling_(skips.culling),
      through_refraction_(through_refraction),
      any_clear_(std::ranges::any_of(scene.materials, is_clear)) {
  // The first occluder may be a clear one: then the nearest one must be known.
  first_occluder_ = skips.first_occluder && !any_clear_;
}

void ShadowRays::resolve(std::span<ShadowRay> rays, const TracedFunction& traced) {
  traced_ = traced ? &traced : nullptr;
  next_.clear();
  for (std::uint32_t light = 0; light < lights_.points().size(); ++light) {
    trace_from_light(rays, light);
  }
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    if (rays[i].point_light == ShadowRay::kNoPoint) {
      next_.push_back(from_surface(lights_, rays[i], i));
    }
  }
  while (!next_.empty()) trace_from_surface(rays);
}

ShadowRays::Segment ShadowRays::from_surface(const Lights& lights, const ShadowRay& ray,
                                             std::uint32_t index) {
  if (ray.point_light == ShadowRay::kNoPoint) {
    return {index, ray.surface, ray.lamp, ray.lamp_slot, kBeforeAreaLight};
  }
  return {index, ray.surface, lights.points()[ray.point_light].position, NearestHit::kNone,
          kWholeWay};
}

void ShadowRays::trace_from_light(std::span<ShadowRay> rays, std::uint32_t point_light) {
  segments_.clear();
  const glm::vec3& position = lights_.points()[point_light].position;
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    if (rays[i].point_light != point_light) continue;
    segments_.push_back({i, position, rays[i].surface, rays[i].surface_slot, kWholeWay});
  }
  if (segments_.empty()) return;
  trace(true, kSureOfLight);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const NearestHit& hit = hits_[i];
    if (hit.slot == NearestHit::kNone) continue;
    ShadowRay& ray = rays[segments_[i].index];
    const bool is_sure = is_before(bvh_, wave_[i], hit, enough_[i]);
    if (is_sure && (!any_clear_ || transmittance(i) == glm::dvec3(0.0))) {
      ray.light = glm::dvec3(0.0);
    } else {
      next_.push_back(from_surface(lights_, ray, segments_[i].index));
    }
  }
}

void ShadowRays::trace_from_surface(std::span<ShadowRay> rays) {
  segments_.swap(next_);
  next_.clear();
  trace(false, kWholeWay);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const NearestHit& hit = hits_[i];
    if (hit.slot == NearestHit::kNone) continue;
    Segment segment = segments_[i];
    ShadowRay& ray = rays[segment.index];
    ray.light *= any_clear_ ? transmittance(i) : glm::dvec3(0.0);
    if (ray.light == glm::dvec3(0.0)) continue;
    const auto beyond = departure_.find(wave_[i], hit.slot, Departure::kAfter);
    if (!beyond) {
      ray.light = glm::dvec3(0.0);
      continue;
    }
    segment.from = *beyond;
    next_.push_back(segment);
  }
}

/// Of all segments. Searches may end at hits before the share `enough` of the way.
void ShadowRays::trace(bool from_light, double enough) {
  wave_.clear();
  limits_.clear();
  enough_.clear();
  ignored_.clear();
  for (const Segment& segment : segments_) {
    const glm::dvec3 way = glm::dvec3(segment.to) - glm::dvec3(segment.from);
    if (way == glm::dvec3(0.0)) {
      wave_.push_back({segment.from, glm::vec3(0.0f)});  // hits nothing
      limits_.push_back(1.0f);
      enough_.push_back(1.0f);
    } else {
      wave_.push_back({segment.from, scaled_direction(way)});
      limits_.push_back(scaled_way(way, segment.share));
      enough_.push_back(scaled_way(way, std::min(enough, segment.share)));
    }
    ignored_.push_back(segment.ignored);
  }
  Search search{
      .common_origin = from_light, .limits = limits_, .ignored = ignored_, .culling = culling_};
  if (first_occluder_) search.enough_before = enough_;
  work_.resize(traced_ != nullptr ? wave_.size() : 0);
  search.work = work_;
  hits_.resize(wave_.size());
  finder_.find(wave_, search, hits_);
  rays_ += wave_.size();
  for (std::size_t i = 0; i < work_.size(); ++i) (*traced_)(work_[i], segments_[i].index);
}

glm::dvec3 ShadowRays::transmittance(std::size_t number) const {
  const std::uint32_t slot = hits_[number].slot;
  const Material& material = scene_.materials[scene_.triangles[bvh_.triangle_of(slot)].material];
  if (!is_clear(material)) return glm::dvec3(0.0);
  return shadow_transmittance(Surface(scene_, bvh_, wave_[number], slot, nullptr),
                              through_refraction_);
}

}  // namespace raygate
