// What of a scene's lights a path tracer chooses from.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/exact/exact.h"
#include "host/light/light_values.h"
#include "host/light/lights.h"
#include "host/light/outer_sides.h"
#include "host/scene/bounds.h"

namespace raygate {
namespace {

/// What the back of a closed light is worth, where nothing else is within the box around it: next
/// to nothing, but not nothing.
constexpr double kBackOfClosed = 1.0 / 16.0;

/// Lengths in units.
LightBounds light_bounds(const PointLight& light, double unit) {
  LightBounds source;
  source.middle = glm::dvec3(light.position) / unit;
  source.power = mean(light.intensity) / unit / unit;
  if (light.spot) {
    source.axis = light.spot->axis;
    source.spread = sine_cosine(light.spot->outer / 360.0).cosine;
  }
  return source;
}

double diagonal_of(const Scene& scene) {
  const auto [low, high] = position_bounds(scene);
  return glm::length(high - low);
}

/// A source that is as likely wherever it is asked for: as bright as it is on the average there.
LightBounds placeless(const LightBounds& source, double scene_radius) {
  LightBounds everywhere;
  everywhere.is_far = true;
  everywhere.radius = 1.0;
  everywhere.power = source.power;
  if (source.is_far) return everywhere;
  // Of all it sends out, what falls on the ball around the scene.
  const double spread = source.reach < 1.0 ? 2.0 : 2.0 * (1.0 - source.spread);
  everywhere.power *= spread / (scene_radius * scene_radius);
  return everywhere;
}

}  // namespace

/// Lengths in units.
LightBounds Lights::light_bounds(const Patch& patch, const AreaLight& light, double unit,
                                 OuterSide side) {
  const glm::dvec3 corner(patch.corner), u(patch.u), v(patch.v);
  LightBounds source;
  source.axis = glm::dvec3(patch.normal);
  source.spread = 1.0;
  source.reach = 0.0;
  source.back = 1.0;
  if (side != OuterSide::kBoth) source.back = kBackOfClosed;
  if (side == OuterSide::kAgainstNormal) source.axis = -source.axis;
  source.middle = (corner + (u + v) * (patch.is_triangle ? 1.0 / 3.0 : 0.5)) / unit;
  for (const glm::dvec3& other : {corner, corner + u, corner + v, corner + u + v}) {
    if (patch.is_triangle && other == corner + u + v) continue;
    source.radius = std::max(source.radius, glm::distance(source.middle, other / unit));
  }
  source.power = patch.area / unit / unit * mean(light.radiance);
  return source;
}

/// Of area lights each patch, of others the whole.
void Lights::add_sources(LightSampling choice, double unit) {
  std::vector<LightBounds> sources;
  std::uint32_t number = 0;
  const auto add = [&](const LightBounds& source, std::uint32_t patch = kNoIndex,
                       double area = 0.0) {
    sources.push_back(source);
    sources_.push_back({number, patch, area > 0.0 ? finite_float(unit * unit / area) : 0.0f});
  };
  for (const PointLight& light : scene_.lights) {
    add(raygate::light_bounds(light, unit));
    ++number;
  }
  std::vector<std::uint32_t> primitives;
  for (const AreaLight& light : areas_)
    primitives.insert(primitives.end(), light.primitives.begin(), light.primitives.end());
  const std::vector<OuterSide> sides = outer_sides(bvh_, primitives);
  if (!areas_.empty()) source_of_slot_.assign(bvh_.primitive_count(), kNoIndex);
  std::vector<OuterSide> side_of_slot(source_of_slot_.size());
  for (std::size_t i = 0; i < primitives.size(); ++i) side_of_slot[primitives[i]] = sides[i];
  for (const AreaLight& light : areas_) {
    const std::uint32_t first = lights_[number].first_patch;
    for (std::uint32_t i = first; i < first + lights_[number].patches; ++i) {
      const Patch& patch = patches_[i];
      source_of_slot_[patch.primitive] = source_of_slot_[patch.slot_beyond] =
          static_cast<std::uint32_t>(sources.size());
      add(light_bounds(patch, light, unit, side_of_slot[patch.primitive]), i, patch.area);
    }
    ++number;
  }
  for (const DirectionalLight& light : scene_.directional_lights) {
    add({.middle = -glm::dvec3(light.direction),
         .is_far = true,
         .power = mean(glm::dvec3(light.irradiance))});
    ++number;
  }
  if (environment_) {
    add({.radius = 1.0,
         .is_far = true,
         .power = std::numbers::pi * mean(environment_->mean_radiance())});
  }
  any_power_ = std::ranges::any_of(sources, [](const auto& source) { return source.power > 0.0; });
  if (choice == LightSampling::kPower) {
    const double radius = is_empty(scene_) ? 1.0 : 0.5 * diagonal_of(scene_) / unit;
    for (LightBounds& source : sources) source = placeless(source, radius);
  }
  tree_ = LightTree(sources);
}

}  // namespace raygate
