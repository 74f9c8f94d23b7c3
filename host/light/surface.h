// The surface where rays hit it: point, normals, colour, and which side was hit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/base/lane_math.h"
#include "host/bvh/bvh.h"
#include "host/exact/exact.h"
#include "host/light/material_parameters.h"
#include "host/scene/instances.h"
#include "host/scene/scene.h"

namespace raygate {

/// A hit, as the intersector gives it.
struct SurfaceHit {
  const Ray* ray = nullptr;
  std::uint32_t primitive = 0;
  const Triangle* face = nullptr;    ///< of the primitive
  const glm::vec3* point = nullptr;  ///< P as the hit-test unit has it, seen from the ray's origin;
                                     ///< none: it is for the host to find
  const Instance* instance = nullptr;  ///< whose triangle it is; none: it is the scene's own

  /// A normal that the face names.
  [[nodiscard]] glm::vec3 normal(const Scene& scene, std::uint32_t index) const {
    const glm::vec3& own = scene.normals[index];
    return instance == nullptr ? own : transform_normal(*instance, own);
  }
};

/// Whether the weights of the vertices at the hit matter.
[[nodiscard]] inline HitKind weights_needed(const SurfaceHit& place) {
  const auto& normals = place.face->normals;
  const bool has_normals =
      normals[0] != kNoIndex && normals[1] != kNoIndex && normals[2] != kNoIndex;
  return place.point == nullptr || has_normals ? kInterpolates : 0;
}

/// What shading needs to know of hits, one a lane. T is float or FloatLanes. In float, but for what
/// comes of differences of corners: in slender triangles those cancel, and double has room for it.
template <class T>
struct Surface {
  Triple<T> point;        ///< in the scene's coordinates
  Triple<T> view;         ///< unit vector back along the ray
  Triple<T> flat_normal;  ///< unit normal of the triangle, to the side of the ray
  /// Unit normal, interpolated where the file has normals, to the same side; where that would not
  /// be seen from the ray, tilted until it is at right angles to the ray.
  Triple<T> normal;
  Triple<T> colour;  ///< Kd, times the texture
  /// What the texture of a metallic-roughness material multiplies; of other kinds nothing.
  T roughness, metallic;
  /// The ray comes from outside: from where the file's normals point or, without, from where the
  /// vertices run counter-clockwise.
  MaskOf<T> outside;

  /// Which directions lead away from the triangle, to the ray's side of it or, `transmitted`, to
  /// the other: exactly, where it is sure.
  struct Leaving {
    MaskOf<T> leaves, is_sure;
  };
  [[nodiscard]] RAYGATE_INLINE Leaving leaving(const Triple<T>& direction,
                                               const MaskOf<T>& transmitted) const {
    const Slope slope(*this, direction);
    return {((slope.value < 0.0f) == (side < 0.0f)) == transmitted, slope.is_sure};
  }

  /// I . N of directions and the triangle's own normal. Double has room to spare: where the value
  /// is not surely off 0, the exact one has any sign.
  struct Slope {
    T value;
    MaskOf<T> is_sure;

    RAYGATE_INLINE Slope(const Surface& surface, const Triple<T>& direction) {
      const Triple<WideOf<T>> way = wide(direction);
      const WideOf<T> product = dot(way, surface.own_normal);
      const WideOf<T> size = absolute(way.x) * surface.own_size.x +
                             absolute(way.y) * surface.own_size.y +
                             absolute(way.z) * surface.own_size.z;
      value = narrow(product);
      const MaskOf<T> is_far = narrow(absolute(product) - 0x1p-49 * size) > 0.0f;
      const MaskOf<T> is_some = absolute(value) > 0.0f;
      is_sure = is_far & is_some;
    }
  };
  Triple<WideOf<T>> own_normal;  ///< as the vertices say, of any length,
  Triple<WideOf<T>> own_size;    ///< and the sum of magnitudes that each component comes from
  T side;                        ///< the exact sign of I . N, of the ray
};

/// The colour of a hit whose vertices have these weights.
[[nodiscard]] glm::vec3 textured(const Scene& scene, const Triangle& face,
                                 const glm::vec3& weights);

/// What its texture multiplies of a metallic-roughness material: x roughness, y metallic.
[[nodiscard]] glm::vec2 textured_roughness(const Scene& scene, const Triangle& face,
                                           const glm::vec3& weights);

/// The normal by the texture of the face's material; mapped_normal says more.
[[nodiscard]] glm::vec3 bent_normal(const Scene& scene, const Triangle& face,
                                    const Corners& corners, const glm::vec3& weights,
                                    const glm::vec3& normal);

/// Whether the mask of the face's material says that there is nothing where the ray hits it.
[[nodiscard]] bool is_masked_out(const Scene& scene, const Bvh& bvh, const SurfaceHit& place);

/// The weights of the vertices, up to a common factor: I . (B x C), I . (C x A), I . (A x B), all
/// of one sign but for rounding.
template <class D>
RAYGATE_INLINE Triple<D> unscaled_weights(const Triple<D>& origin, const Triple<D>& direction,
                                          const Triple<D> (&corners)[3]) {
  D weights[3];
  for (int k = 0; k < 3; ++k) {
    const Triple<D>&from = corners[(k + 1) % 3], &to = corners[(k + 2) % 3];
    const Triple<D> u = from - origin, v = to - from;
    const Triple<D> normal = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    weights[k] = dot(direction, normal);
  }
  return {weights[0], weights[1], weights[2]};
}

/// The surfaces at hits of one kind.
template <class T>
RAYGATE_INLINE Surface<T> surface_at(const Scene& scene, const Bvh& bvh, HitKind kind,
                                     const SurfaceHit (&places)[LanesOf<T>::kCount]) {
  using Wide = WideOf<T>;
  constexpr int kCount = LanesOf<T>::kCount;
  enum : std::uint8_t {
    kOrigin,
    kDirection = 3,
    kPoint = 6,
    kColour = 9,
    kCorners = 12,
    kFields = 21
  };
  Gathered<T, kFields> in;
  for (int k = 0; k < kCount; ++k) {
    const SurfaceHit& place = places[k];
    const Corners corners = bvh.corners_of(place.primitive);
    in.put(kOrigin, k, place.ray->origin);
    in.put(kDirection, k, place.ray->direction);
    in.put(kPoint, k, place.point != nullptr ? *place.point : glm::vec3(0.0f));
    in.put(kColour, k, scene.materials[place.face->material].diffuse);
    for (int c = 0; c < 3; ++c) in.put(kCorners + 3 * c, k, corners[c]);
  }
  const Triple<T> direction = in.triple(kDirection);
  Surface<T> surface;
  surface.point = in.triple(kOrigin) + in.triple(kPoint);
  surface.view = -normalized(direction);
  surface.colour = in.triple(kColour);
  if ((kind & kMetallicRoughness) != 0) surface.roughness = surface.metallic = spread<T>(1.0f);

  const Triple<Wide> corners[3] = {wide(in.triple(kCorners)), wide(in.triple(kCorners + 3)),
                                   wide(in.triple(kCorners + 6))};
  const Triple<Wide> u = corners[1] - corners[0], v = corners[2] - corners[0];
  const Wide from[3] = {u.x, u.y, u.z}, to[3] = {v.x, v.y, v.z};
  Wide value[3], size[3];
  cross(from, to, value, size);
  const Triple<Wide> normal = {value[0], value[1], value[2]};
  surface.flat_normal = narrow(normal * (1.0 / root(dot(normal, normal))));

  surface.own_normal = normal;
  surface.own_size = {size[0], size[1], size[2]};

  // Which side was hit: double says it, or exact arithmetic does.
  const typename Surface<T>::Slope slope(surface, direction);
  Gathered<T, 2> side;
  lanes_to(side.values[0], slope.value);
  lanes_to(side.values[1], choose(slope.is_sure, spread<T>(1.0f), T{}));
  for (int k = 0; k < kCount; ++k) {
    if (side.values[1][k] != 0.0f) continue;
    side.values[0][k] = static_cast<float>(
        direction_side(places[k].ray->direction, bvh.corners_of(places[k].primitive)));
  }
  surface.side = side.one(0);
  const auto towards = surface.side < 0.0f;  // against the triangle's own normal

  surface.normal = surface.flat_normal;
  auto along = surface.normal.x == surface.normal.x;
  if ((kind & kInterpolates) != 0) {
    const Triple<Wide> unscaled =
        unscaled_weights(wide(in.triple(kOrigin)), wide(direction), corners);
    const Wide inverse = 1.0 / (unscaled.x + unscaled.y + unscaled.z);
    Triple<T> weights = narrow(unscaled * inverse);
    const T third = spread<T>(1.0f / 3.0f);  // where nothing is left of the triangle
    const auto is_number = weights.x + weights.y + weights.z == weights.x + weights.y + weights.z;
    weights = {choose(is_number, at_least(weights.x, 0.0f), third),
               choose(is_number, at_least(weights.y, 0.0f), third),
               choose(is_number, at_least(weights.z, 0.0f), third)};
    enum : std::uint8_t { kNormals, kHasNormals = 9, kHasPoint = 10, kTextured = 11, kMore = 14 };
    Gathered<T, kMore> more;
    Gathered<T, 3> weight;
    lanes_to(weight.values[0], weights.x);
    lanes_to(weight.values[1], weights.y);
    lanes_to(weight.values[2], weights.z);
    for (int k = 0; k < kCount; ++k) {
      const Triangle& face = *places[k].face;
      more.values[kHasNormals][k] = 1.0f;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t index = face.normals[c];
        if (index == kNoIndex) more.values[kHasNormals][k] = 0.0f;
        more.put(kNormals + 3 * static_cast<int>(c), k,
                 index == kNoIndex ? glm::vec3(0.0f) : places[k].normal(scene, index));
      }
      more.values[kHasPoint][k] = places[k].point != nullptr ? 1.0f : 0.0f;
      more.put(
          kTextured, k,
          textured(scene, face, {weight.values[0][k], weight.values[1][k], weight.values[2][k]}));
    }
    surface.colour = more.triple(kTextured);
    if ((kind & kMetallicRoughness) != 0) {
      Gathered<T, 2> factor;
      for (int k = 0; k < kCount; ++k) {
        const glm::vec2 textured =
            textured_roughness(scene, *places[k].face,
                               {weight.values[0][k], weight.values[1][k], weight.values[2][k]});
        factor.values[0][k] = textured.x;
        factor.values[1][k] = textured.y;
      }
      surface.roughness = factor.one(0);
      surface.metallic = factor.one(1);
    }
    const Triple<T> own_point = narrow(corners[0] * wide(weights.x) + corners[1] * wide(weights.y) +
                                       corners[2] * wide(weights.z));
    surface.point = choose(more.one(kHasPoint) > 0.0f, surface.point, own_point);
    const Triple<T> sum = more.triple(kNormals) * weights.x +
                          more.triple(kNormals + 3) * weights.y +
                          more.triple(kNormals + 6) * weights.z;
    const T squared = dot(sum, sum);
    const auto is_smooth = (more.one(kHasNormals) > 0.0f) & (squared > 0.0f);
    surface.normal = choose(is_smooth, sum * (1.0f / root(squared)), surface.normal);
    along = !(dot(surface.flat_normal, surface.normal) < 0.0f);
    surface.flat_normal = choose(along, surface.flat_normal, -surface.flat_normal);
    if ((kind & kIsBumpy) != 0) {
      Gathered<T, 3> normals;
      lanes_to(normals.values[0], surface.normal.x);
      lanes_to(normals.values[1], surface.normal.y);
      lanes_to(normals.values[2], surface.normal.z);
      for (int k = 0; k < kCount; ++k) {
        normals.put(
            0, k,
            bent_normal(scene, *places[k].face, bvh.corners_of(places[k].primitive),
                        {weight.values[0][k], weight.values[1][k], weight.values[2][k]},
                        {normals.values[0][k], normals.values[1][k], normals.values[2][k]}));
      }
      surface.normal = normals.triple(0);
    }
  }
  surface.outside = towards == along;
  surface.flat_normal = choose(surface.outside, surface.flat_normal, -surface.flat_normal);
  surface.normal = choose(surface.outside, surface.normal, -surface.normal);
  const T facing = dot(surface.normal, surface.view);
  const Triple<T> tilted = surface.normal - surface.view * facing;
  const T tilted_size = dot(tilted, tilted);
  surface.normal =
      choose(facing < 0.0f,
             choose(tilted_size > 0.0f, tilted * (1.0f / root(tilted_size)), surface.flat_normal),
             surface.normal);
  return surface;
}

}  // namespace raygate
