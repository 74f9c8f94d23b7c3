#include "host/light/lights.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "host/exact/exact.h"
#include "host/scene/bounds.h"
#include "host/scene/camera.h"
#include "host/scene/instances.h"
#include "host/scene/material_lookup.h"

namespace raygate {
namespace {

/// Returns the ambient radiance F r / ((1 - r) pi A). F is the flux of the area lights, counting
/// one side of each; r is the mean diffuse reflectance, and A the area, of all faces.
glm::dvec3 guessed_ambient(const Scene& scene, const std::vector<AreaLight>& lights) {
  glm::dvec3 flux(0.0), reflecting(0.0);
  double area = 0.0;
  for (const AreaLight& light : lights) flux += std::numbers::pi * light.area * light.radiance;
  if (flux == glm::dvec3(0.0)) return flux;
  for_each_face(scene, [&](const Corners& corners, const Triangle& face) {
    const double own = 0.5 * glm::length(triangle_normal(corners));
    area += own;
    reflecting += own * glm::dvec3(scene.materials[face.material].diffuse);
  });
  const glm::dvec3 mean = glm::clamp(reflecting / area, glm::dvec3(0.0), glm::dvec3(0.9));
  return flux * mean / (1.0 - mean) / (std::numbers::pi * area);
}

/// Returns a power of two of about the size of the scene, including its lights.
double unit_of(const Scene& scene, const std::vector<PointLight>& lights) {
  float size = 0.0f;
  if (!is_empty(scene)) {
    const Bounds3 box = position_bounds(scene);
    size = static_cast<float>(std::max(largest(box.low), largest(box.high)));
  }
  for (const PointLight& light : lights) size = std::max(size, largest(light.position));
  constexpr int kMostExponent = 126;  // the inverse is also a float
  return size > 0.0f ? std::ldexp(1.0, std::clamp(std::ilogb(size), -kMostExponent, kMostExponent))
                     : 1.0;
}

/// A corner of a parallelogram and the two sides that start there. The diagonal from this corner
/// separates two triangles; the first is on the side of u.
struct Parallelogram {
  glm::vec3 corner, u, v;
};

/// Returns the parallelogram formed by two triangles with the same orientation, if any.
std::optional<Parallelogram> parallelogram(const Corners& first, const Corners& second) {
  for (std::size_t k = 0; k < 3; ++k) {
    // `second` traverses the shared edge, from corner k + 2 to corner k of `first`, in reverse.
    const glm::dvec3 &corner = first[k], &side = first[(k + 1) % 3], &end = first[(k + 2) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      if (second[j] != corner || second[(j + 1) % 3] != end) continue;
      const glm::dvec3 u = side - corner, v = end - side, other = second[(j + 2) % 3] - corner;
      if (largest(other - v) > 0x1p-20 * std::max(largest(u), largest(v))) return std::nullopt;
      return Parallelogram{glm::vec3(corner), glm::vec3(u), glm::vec3(other)};
    }
  }
  return std::nullopt;
}

/// LightBounds::back of closed lights: a small, but positive fraction for the inner side.
constexpr double kInnerSide = 1.0 / 16.0;

/// Returns bounds with lengths in units of `unit`.
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

/// Returns whether emissive triangles light the scene. Without `is_preview`, one triangle without
/// an emission texture suffices. Otherwise, the sum of radiance times area must be large, unlike
/// that of glowing labels and screens. `size` is the scene's diagonal.
bool is_lit_by_emitters(const Scene& scene, double size, bool is_preview) {
  // Thresholds of radiance * area / size^2, relative to the main light: 1/100, or about 1/6 for
  // emission with a texture, which is meant to be looked at.
  constexpr double kGlow = 0.01, kPicture = 0.15;
  const auto is_picture = [](const Material& material) {
    return material.emission_map.texture != kNoIndex;
  };
  std::vector<double> radiance;
  radiance.reserve(scene.materials.size());
  for (const Material& material : scene.materials) {
    radiance.push_back(mean(mean_emission(scene, material)) /
                       (is_picture(material) ? kPicture : kGlow));
  }
  double sum = 0.0;
  for (const Triangle& face : scene.triangles) {
    const Material& material = scene.materials[face.material];
    if (is_left_out(face) || !emits(material)) continue;
    if (!is_preview && !is_picture(material)) return true;
    const auto& [a, b, c] = face.vertices;
    const Corners corners{scene.vertex(a), scene.vertex(b), scene.vertex(c)};
    sum += 0.5 * radiance[face.material] * glm::length(triangle_normal(corners));
  }
  return sum > size * size;
}

constexpr glm::vec3 kDimSky(0.18f, 0.2f, 0.24f);

}  // namespace

std::optional<CameraLights> default_lights(const Scene& scene, const Camera& camera,
                                           bool is_preview) {
  const bool is_dark = scene.background == glm::vec3(0.0f);
  if (is_empty(scene) || !scene.lights.empty() || !scene.directional_lights.empty() ||
      scene.environment || (!is_preview && !is_dark)) {
    return {};
  }
  const auto [low, high] = position_bounds(scene);
  const glm::dvec3 eye(camera.eye()), middle = 0.5 * (low + high);
  const double size = glm::length(high - low);
  if (is_lit_by_emitters(scene, size, is_preview)) return {};
  CameraLights lights;
  lights.background = is_preview && !is_dark ? scene.background : kDimSky;
  // `radiance`: of a facing white wall at `distance`.
  const auto add = [&](const glm::dvec3& at, double distance, double radiance) {
    lights.points.push_back({glm::vec3(glm::clamp(at, -kMostCoordinate, kMostCoordinate)),
                             glm::dvec3(radiance * std::numbers::pi * distance * distance)});
  };
  if (glm::all(glm::lessThanEqual(low, eye)) && glm::all(glm::lessThanEqual(eye, high))) {
    add(eye, 0.35 * size, 0.8);
    return lights;
  }
  const auto add_far = [&](double right, double up, double radiance) {
    constexpr double kFar = 4.0;  // all parts of the scene are at about the same distance
    const glm::dvec3 at =
        middle + kFar * size * (up * camera.up() + right * camera.right() - 1.3 * camera.forward());
    add(at, glm::length(at - middle), radiance);
  };
  // White surfaces stay below 1, with sky and interreflection added.
  add_far(-0.8, 1.2, is_preview ? 0.4 : 0.6);
  if (is_preview) add_far(1.4, 0.3, 0.16);
  lights.radius = 0.5 * size;  // penumbra width: 1/8 of the occluder's distance
  return lights;
}

Lights::Lights(const Scene& scene, const Bvh& bvh, Sampling sampling,
               const std::optional<CameraLights>& camera_lights)
    : scene_(scene),
      bvh_(bvh),
      own_(camera_lights.value_or(CameraLights{scene.lights, scene.background})) {
  const double unit = unit_of(scene, own_.points);
  per_unit_ = static_cast<float>(1.0 / unit);
  for (const PointLight& light : own_.points) {
    Light& record = lights_.emplace_back();
    record.emission = finite_floats(light.intensity / unit / unit);
    record.position = light.position;
    record.radius = static_cast<float>(own_.radius);
    record.is_spot = light.spot.has_value();
    if (!record.is_spot) continue;
    constexpr double kLeastRamp = 1e-6;
    const double inner = sine_cosine(light.spot->inner / 360.0).cosine;
    const double outer = sine_cosine(light.spot->outer / 360.0).cosine;
    const double slope = 1.0 / std::max(inner - outer, kLeastRamp);
    record.spot_axis = light.spot->axis;
    record.spot_scale = static_cast<float>(slope);
    record.spot_offset = static_cast<float>(-outer * slope);
  }
  find_areas();
  for (const AreaLight& light : areas_) {
    Light& record = lights_.emplace_back();
    record.kind = Kind::kArea;
    record.emission = finite_floats(light.radiance);
    record.is_textured = light.is_textured;
    record.area = finite_float(light.area / unit / unit);
    add_patches(light, record);
  }
  for (const DirectionalLight& light : scene.directional_lights) {
    lights_.push_back({.kind = Kind::kDirection,
                       .emission = light.irradiance,
                       .position = glm::vec3(-light.direction)});
  }
  if (scene.environment) {
    environment_.emplace(*scene.environment);
    lights_.emplace_back().kind = Kind::kEnvironment;
  }
  if (sampling == Sampling::kOne) {
    add_sources(unit);
  } else {
    ambient_ =
        background() != glm::vec3(0.0f) ? glm::dvec3(background()) : guessed_ambient(scene, areas_);
  }
}

glm::vec3 Lights::textured_radiance(std::uint32_t primitive, const glm::vec3& point) const {
  const Corners corners = bvh_.corners_of(primitive);
  const glm::dvec3 normal = triangle_normal(corners);
  glm::dvec3 weights;  // areas of the triangles that the point forms with the sides
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &from = corners[(k + 1) % 3], &to = corners[(k + 2) % 3];
    weights[static_cast<int>(k)] =
        std::max(glm::dot(glm::cross(to - from, glm::dvec3(point) - from), normal), 0.0);
  }
  weights /= weights.x + weights.y + weights.z;
  const Triangle& face = scene_.triangles[bvh_.triangle_of(primitive)];
  return scene_.materials[face.material].emission * emission_factor_at(scene_, face, weights);
}

/// Groups the emissive triangles into area lights.
void Lights::find_areas() {
  std::vector<std::uint32_t> emitting;
  for (std::uint32_t primitive = 0; primitive < bvh_.primitive_count(); ++primitive) {
    const Triangle& face = scene_.triangles[bvh_.triangle_of(primitive)];
    if (emits(scene_.materials[face.material])) emitting.push_back(primitive);
  }
  // In the scene's order, lights do not depend on how the BVH is built.
  std::ranges::sort(emitting, {}, [&](std::uint32_t each) { return bvh_.triangle_of(each); });
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> known;
  for (const std::uint32_t primitive : emitting) {
    const Triangle& face = scene_.triangles[bvh_.triangle_of(primitive)];
    const Material& material = scene_.materials[face.material];
    const Corners corners = bvh_.corners_of(primitive);
    const glm::vec3 corner(corners[0]);
    const auto [at, is_new] = known.try_emplace({face.object, face.material}, areas_.size());
    if (is_new) {
      areas_.push_back({.low = corner,
                        .high = corner,
                        .radiance = mean_emission(scene_, material),
                        .is_textured = material.emission_map.texture != kNoIndex});
    }
    AreaLight& light = areas_[at->second];
    for (const glm::dvec3& corner : corners) {
      light.low = glm::min(light.low, glm::vec3(corner));
      light.high = glm::max(light.high, glm::vec3(corner));
    }
    light.area += 0.5 * glm::length(triangle_normal(corners));
    light.primitives.push_back(primitive);
  }
}

/// Adds the patches of a light. Two successive triangles that form a parallelogram become one
/// patch, onto which the unit square is mapped without a kink.
void Lights::add_patches(const AreaLight& light, Light& record) {
  record.first_patch = static_cast<std::uint32_t>(patches_.size());
  double before = 0.0;
  for (std::size_t i = 0; i < light.primitives.size(); ++i) {
    const Corners t = bvh_.corners_of(light.primitives[i]);
    const glm::dvec3 normal = triangle_normal(t);
    double end = before + 0.5 * glm::length(normal);
    Patch patch;
    patch.primitive = patch.primitive_beyond = light.primitives[i];
    patch.begin = static_cast<float>(before / light.area);
    patch.normal = glm::vec3(glm::normalize(normal));
    patch.corner = glm::vec3(t[0]);
    patch.u = glm::vec3(t[1] - t[0]);
    patch.v = glm::vec3(t[2] - t[0]);
    if (i + 1 < light.primitives.size()) {
      const Corners next = bvh_.corners_of(light.primitives[i + 1]);
      const auto sides = parallelogram(t, next);
      if (sides) {
        ++i;
        end += 0.5 * glm::length(triangle_normal(next));
        patch.is_triangle = false;
        patch.corner = sides->corner;
        patch.u = sides->u;
        patch.v = sides->v;
        patch.primitive_beyond = light.primitives[i];
      }
    }
    patch.end = static_cast<float>(end / light.area);
    patch.area = end - before;
    before = end;
    patches_.push_back(patch);
    ++record.patches;
  }
}

/// Returns bounds with lengths in units of `unit`.
LightBounds Lights::light_bounds(const Patch& patch, const AreaLight& light, double unit,
                                 OuterSide side) {
  const glm::dvec3 corner(patch.corner), u(patch.u), v(patch.v);
  LightBounds source;
  source.axis = glm::dvec3(patch.normal);
  source.spread = 1.0;
  source.reach = 0.0;
  source.back = side == OuterSide::kBoth ? 1.0 : kInnerSide;
  if (side == OuterSide::kAgainstNormal) source.axis = -source.axis;
  source.middle = (corner + (u + v) * (patch.is_triangle ? 1.0 / 3.0 : 0.5)) / unit;
  for (const glm::dvec3& other : {corner, corner + u, corner + v, corner + u + v}) {
    if (patch.is_triangle && other == corner + u + v) continue;
    source.radius = std::max(source.radius, glm::distance(source.middle, other / unit));
  }
  source.power = patch.area / unit / unit * mean(light.radiance);
  return source;
}

/// Adds the sources: each patch of area lights, and each other light.
void Lights::add_sources(double unit) {
  std::vector<LightBounds> sources;
  std::uint32_t number = 0;
  const auto add = [&](const LightBounds& source, std::uint32_t patch = kNoIndex,
                       double area = 0.0) {
    sources.push_back(source);
    sources_.push_back({number, patch, area > 0.0 ? finite_float(unit * unit / area) : 0.0f});
  };
  for (const PointLight& light : own_.points) {
    add(raygate::light_bounds(light, unit));
    ++number;
  }
  if (!areas_.empty()) source_of_primitive_.assign(bvh_.primitive_count(), kNoIndex);
  for (const AreaLight& light : areas_) {
    const std::vector<OuterSide> sides = outer_sides(bvh_, light.primitives);
    const std::uint32_t first = lights_[number].first_patch;
    std::size_t triangle = 0;
    for (std::uint32_t i = first; i < first + lights_[number].patches; ++i) {
      const Patch& patch = patches_[i];
      source_of_primitive_[patch.primitive] = source_of_primitive_[patch.primitive_beyond] =
          static_cast<std::uint32_t>(sources.size());
      add(light_bounds(patch, light, unit, sides[triangle]), i, patch.area);
      triangle += patch.is_triangle ? 1 : 2;
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
  tree_ = LightTree(sources);
}

std::vector<OuterSide> outer_sides(const Bvh& bvh, std::span<const std::uint32_t> primitives) {
  struct Edge {
    std::array<double, 6> ends;  // of the edge; the smaller end is first
    std::uint32_t triangle;
    bool is_reversed;
  };
  std::vector<Edge> edges;
  std::vector<std::uint32_t> parents(primitives.size());  // union-find
  std::iota(parents.begin(), parents.end(), 0u);
  const auto part_of = [&](std::uint32_t i) {
    while (parents[i] != i) i = parents[i] = parents[parents[i]];
    return i;
  };
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const Corners corners = bvh.corners_of(primitives[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &a = corners[k], &b = corners[(k + 1) % 3];
      const std::array<double, 6> ends{a.x, a.y, a.z, b.x, b.y, b.z},
          back{b.x, b.y, b.z, a.x, a.y, a.z};
      edges.push_back({std::min(ends, back), i, back < ends});
    }
  }
  std::ranges::sort(edges, {}, &Edge::ends);
  std::vector<std::uint32_t> at_borders;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    for (end = i + 1; end < edges.size() && edges[end].ends == edges[i].ends; ++end) {
      parents[part_of(edges[end].triangle)] = part_of(edges[i].triangle);
    }
    if (end - i != 2 || edges[i].is_reversed == edges[i + 1].is_reversed) {
      at_borders.push_back(edges[i].triangle);
    }
  }
  std::vector<bool> is_open(primitives.size());
  for (const std::uint32_t triangle : at_borders) is_open[part_of(triangle)] = true;

  std::vector<double> volumes(primitives.size());  // times six; negative: triangles face inwards
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const Corners t = bvh.corners_of(primitives[i]);
    const glm::dvec3 origin = bvh.corners_of(primitives[part_of(i)])[0];
    volumes[part_of(i)] += glm::dot(t[0] - origin, triangle_normal(t));
  }
  std::vector<OuterSide> sides(primitives.size());
  for (std::uint32_t i = 0; i < primitives.size(); ++i) {
    const double volume = volumes[part_of(i)];
    if (is_open[part_of(i)] || volume == 0.0) continue;
    sides[i] = volume > 0.0 ? OuterSide::kAlongNormal : OuterSide::kAgainstNormal;
  }
  return sides;
}

}  // namespace raygate
