// The surfaces at hits: point, normals, colour, and the side that was hit.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "host/base/triple.h"
#include "host/bvh/bvh.h"
#include "host/light/material_parameters.h"
#include "host/scene/instances.h"
#include "host/scene/material_lookup.h"

namespace raygate {

/// A hit, as returned by the intersector.
struct SurfaceHit {
  const Ray* ray = nullptr;
  std::uint32_t primitive = 0;
  const Triangle* face = nullptr;  ///< the primitive's triangle
  /// The hit-test unit's P, relative to the ray's origin; null: computed by the host.
  const glm::vec3* point = nullptr;
  const Instance* instance = nullptr;  ///< the triangle's instance, or null

  /// Returns the vertex colours, or null if there are none or the material ignores them.
  [[nodiscard]] const std::vector<glm::vec3>* vertex_colors(const Scene& scene) const {
    const auto& all = instance == nullptr ? scene.colors : scene.meshes[instance->mesh].colors;
    return all.empty() || !scene.materials[face->material].has_vertex_colors ? nullptr : &all;
  }

  [[nodiscard]] glm::vec3 normal(const Scene& scene, std::uint32_t index) const {
    const glm::vec3& own = scene.normals[index];
    return instance == nullptr ? own : transform_normal(*instance, own);
  }
};

/// Returns whether the face has a normal for each vertex.
[[nodiscard]] inline bool has_normals(const Triangle& face) {
  return face.normals[0] != kNoIndex && face.normals[1] != kNoIndex && face.normals[2] != kNoIndex;
}

/// Returns kInterpolates if shading needs the barycentric coordinates of the hit, or else 0.
[[nodiscard]] inline HitKind weights_needed(const Scene& scene, const SurfaceHit& place) {
  return place.point == nullptr || has_normals(*place.face) || place.vertex_colors(scene) != nullptr
             ? kInterpolates
             : 0;
}

/// The surface at each lane's hit. T is float or FloatLanes. Computed in float, except differences
/// of corners, which cancel in slender triangles and are computed in double.
template <class T>
struct Surface {
  Triple<T> point;        ///< in scene coordinates
  Triple<T> view;         ///< unit vector back along the ray
  Triple<T> flat_normal;  ///< unit geometric normal, on the side of the ray
  /// Unit shading normal on the side of the ray, interpolated if the face has normals. A normal
  /// that faces away from the ray is tilted until perpendicular to the ray.
  Triple<T> normal;
  Triple<T> untilted;  ///< the shading normal before tilting
  Triple<T> colour;    ///< Kd times the texture
  T opacity;           ///< texture's factor; 1 unless the kind interpolates and transmits
  /// Factors of the textures of a metallic-roughness material; unused for other kinds.
  T roughness, metallic, transmission, specular;
  Triple<T> specular_color;
  Triple<T> glow;  ///< emission texture's factor; unset unless the kind interpolates and emits
  /// Whether the ray arrives from outside: from the side to which the file's normals point or,
  /// without normals, from which the vertices are counter-clockwise.
  MaskOf<T> outside;

  /// Dot product of a direction and the triangle's normal, in double, and whether its sign is sure.
  struct Slope {
    T value;
    MaskOf<T> is_sure;

    RAYGATE_INLINE Slope(const Surface& surface, const Triple<T>& direction) {
      const Triple<WideOf<T>> way = wide(direction);
      const WideOf<T> product = dot(way, surface.own_normal);
      const WideOf<T> size = dot(absolute(way), surface.own_size);
      value = narrow(product);
      const MaskOf<T> is_far = narrow(absolute(product) - 0x1p-49 * size) > 0.0f;
      const MaskOf<T> is_some = absolute(value) > 0.0f;
      is_sure = is_far & is_some;
    }
  };
  /// Returns whether a direction with this slope leaves the triangle to the ray's side or, if
  /// `transmitted`, to the other side. Exact where the slope is sure.
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> leaves(const Slope& slope,
                                                const MaskOf<T>& transmitted) const {
    return ((slope.value < 0.0f) == (side < 0.0f)) == transmitted;
  }

  /// Tilts the shading normal so that it does not face away from the view.
  RAYGATE_INLINE void tilt() {
    const T facing = dot(untilted, view);
    const Triple<T> tilted = untilted - view * facing;
    const T tilted_size = dot(tilted, tilted);
    normal = choose(facing < 0.0f,
                    choose(tilted_size > 0.0f, tilted * (1.0f / root(tilted_size)), flat_normal),
                    untilted);
  }
  [[nodiscard]] RAYGATE_INLINE MaskOf<T> is_tilted() const { return dot(untilted, view) < 0.0f; }

  /// Returns this surface as seen from another direction on the same side.
  [[nodiscard]] RAYGATE_INLINE Surface seen_from(const Triple<T>& direction) const {
    Surface seen = *this;
    seen.view = direction;
    seen.tilt();
    return seen;
  }
  Triple<WideOf<T>> own_normal;  ///< (B - A) x (C - A), of any length
  Triple<WideOf<T>> own_size;    ///< per component of own_normal: sum of its terms' magnitudes
  T side;                        ///< ray's direction . own_normal, with exact sign
};

/// Returns the barycentric coordinates up to a common factor: I . (B x C), I . (C x A), I . (A x
/// B), with the ray's direction I and the corners A, B, C relative to the ray's origin. All have
/// the same sign, except for rounding.
template <class D>
RAYGATE_INLINE Triple<D> unscaled_weights(const Triple<D>& origin, const Triple<D>& direction,
                                          const Triple<D> (&corners)[3]) {
  D weights[3];
  for (int k = 0; k < 3; ++k) {
    const Triple<D>&from = corners[(k + 1) % 3], &to = corners[(k + 2) % 3];
    weights[k] = dot(direction, cross<D>(from - origin, to - from));
  }
  return {weights[0], weights[1], weights[2]};
}

/// Returns the surfaces at hits of one kind.
template <class T>
RAYGATE_INLINE Surface<T> surface_at(const Scene& scene, const Bvh& bvh, HitKind kind,
                                     const SurfaceHit (&places)[kLanesOf<T>]) {
  using Wide = WideOf<T>;
  constexpr int kCount = kLanesOf<T>;
  const Ray* rays[kCount];
  Corners own_corners[kCount];
  for (int k = 0; k < kCount; ++k) {
    rays[k] = places[k].ray;
    own_corners[k] = bvh.corners_of(places[k].primitive);
  }
  const Triple<T> origin = gather<T>(rays, &Ray::origin);
  const Triple<T> direction = gather<T>(rays, &Ray::direction);
  const auto corner = [&](std::size_t c) RAYGATE_BODY {
    return gather<T>([&](int k) RAYGATE_BODY -> const glm::dvec3& { return own_corners[k][c]; });
  };
  Surface<T> surface;
  surface.point = origin + gather<T>([&](int k) RAYGATE_BODY {
                    return places[k].point != nullptr ? *places[k].point : glm::vec3(0.0f);
                  });
  surface.view = -normalized(direction);
  surface.colour = gather<T>([&](int k) RAYGATE_BODY -> const glm::vec3& {
    return scene.materials[places[k].face->material].diffuse;
  });
  surface.opacity = spread<T>(1.0f);
  if ((kind & kMetallicRoughness) != 0) {
    surface.roughness = surface.metallic = surface.transmission = surface.specular =
        surface.opacity;
    surface.specular_color = spread<T>(glm::vec3(1.0f));
  }

  const Triple<Wide> corners[3] = {corner(0), corner(1), corner(2)};
  const Triple<Wide> normal =
      cross<Triple<Wide>>(corners[1] - corners[0], corners[2] - corners[0], surface.own_size);
  surface.own_normal = normal;
  surface.flat_normal = narrow(normal * (1.0 / root(dot(normal, normal))));

  // Decide the side in double, or exactly where double is not sure.
  const typename Surface<T>::Slope slope(surface, direction);
  const auto values = unpack(slope.value);
  const auto is_sure = unpack(slope.is_sure);
  surface.side = gather<T>([&](int k) RAYGATE_BODY {
    return is_sure[k] ? values[k]
                      : static_cast<float>(direction_side(rays[k]->direction, own_corners[k]));
  });
  const auto towards = surface.side < 0.0f;  // against the triangle's own normal

  surface.normal = surface.flat_normal;
  auto along = surface.normal.x == surface.normal.x;
  if ((kind & kInterpolates) != 0) {
    const Triple<Wide> unscaled = unscaled_weights(wide(origin), wide(direction), corners);
    const Wide inverse = 1.0 / (unscaled.x + unscaled.y + unscaled.z);
    Triple<T> weights = narrow(unscaled * inverse);
    const T third = spread<T>(1.0f / 3.0f), sum_of_weights = weights.x + weights.y + weights.z;
    weights = {at_least(weights.x, 0.0f), at_least(weights.y, 0.0f), at_least(weights.z, 0.0f)};
    // Triangles without area have equal weights.
    weights = choose(sum_of_weights == sum_of_weights, weights, {third, third, third});
    const auto weight = unpack(weights);
    surface.colour = gather<T>([&](int k) RAYGATE_BODY {
      const glm::vec3 diffuse = diffuse_at(scene, *places[k].face, glm::dvec3(weight[k]));
      const auto* const colors = places[k].vertex_colors(scene);
      if (colors == nullptr) return diffuse;
      return diffuse * vertex_color_at(*colors, *places[k].face, glm::dvec3(weight[k]));
    });
    if ((kind & kEmits) != 0) {
      surface.glow = gather<T>([&](int k) RAYGATE_BODY {
        return emission_factor_at(scene, *places[k].face, glm::dvec3(weight[k]));
      });
    }
    if ((kind & kTransmits) != 0) {
      surface.opacity = gather<T>([&](int k) RAYGATE_BODY {
        return opacity_factor_at(scene, *places[k].face, glm::dvec3(weight[k]));
      });
    }
    if ((kind & kMetallicRoughness) != 0) {
      using Factors = MetallicRoughnessFactors;
      Factors factors[kCount];
      const Factors* all[kCount];
      for (int k = 0; k < kCount; ++k) {
        factors[k] = metallic_roughness_factors_at(scene, *places[k].face, glm::dvec3(weight[k]));
        all[k] = &factors[k];
      }
      surface.roughness = gather<T>(all, &Factors::roughness);
      surface.metallic = gather<T>(all, &Factors::metallic);
      surface.transmission = gather<T>(all, &Factors::transmission);
      surface.specular = gather<T>(all, &Factors::specular);
      surface.specular_color = gather<T>(all, &Factors::specular_color);
    }
    const Triple<T> own_point = narrow(corners[0] * wide(weights.x) + corners[1] * wide(weights.y) +
                                       corners[2] * wide(weights.z));
    const MaskOf<T> has_point =
        gather<T>([&](int k) RAYGATE_BODY { return places[k].point != nullptr; });
    surface.point = choose(has_point, surface.point, own_point);
    const auto vertex_normal = [&](std::size_t c) RAYGATE_BODY {
      return gather<T>([&](int k) RAYGATE_BODY {
        const std::uint32_t index = places[k].face->normals[c];
        return index == kNoIndex ? glm::vec3(0.0f) : places[k].normal(scene, index);
      });
    };
    const MaskOf<T> have_normals =
        gather<T>([&](int k) RAYGATE_BODY { return has_normals(*places[k].face); });
    const Triple<T> sum =
        vertex_normal(0) * weights.x + vertex_normal(1) * weights.y + vertex_normal(2) * weights.z;
    const T squared = dot(sum, sum);
    const auto is_smooth = have_normals & (squared > 0.0f);
    surface.normal = choose(is_smooth, sum * (1.0f / root(squared)), surface.normal);
    along = !(dot(surface.flat_normal, surface.normal) < 0.0f);
    surface.flat_normal = choose(along, surface.flat_normal, -surface.flat_normal);
    if ((kind & kIsBumpy) != 0) {
      const auto normals = unpack(surface.normal);
      surface.normal = gather<T>([&](int k) RAYGATE_BODY {
        return mapped_normal(scene, *places[k].face, own_corners[k], places[k].instance,
                             glm::dvec3(weight[k]), normals[k]);
      });
    }
  }
  surface.outside = towards == along;
  surface.flat_normal = choose(surface.outside, surface.flat_normal, -surface.flat_normal);
  surface.normal = choose(surface.outside, surface.normal, -surface.normal);
  surface.untilted = surface.normal;
  surface.tilt();
  return surface;
}

/// Returns whether the mask of the face's material has a hole at the hit.
[[nodiscard]] inline bool is_masked_out(const Scene& scene, const Bvh& bvh,
                                        const SurfaceHit& place) {
  const Corners corners = bvh.corners_of(place.primitive);
  const auto wide = [](const glm::dvec3& v) { return Triple<double>{v.x, v.y, v.z}; };
  const Triple<double> at =
      unscaled_weights<double>(wide(place.ray->origin), wide(place.ray->direction),
                               {wide(corners[0]), wide(corners[1]), wide(corners[2])});
  const double sum = at.x + at.y + at.z;
  const glm::dvec3 weights = glm::dvec3(at.x, at.y, at.z) / sum;
  return std::isfinite(weights.x + weights.y + weights.z) &&
         is_masked_out(scene, *place.face, weights);
}

}  // namespace raygate
