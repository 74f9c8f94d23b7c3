// Exact predicates: whether a ray hits a triangle, and which of two hits is nearer.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "host/exact/ieee_floats.h"

namespace raygate {

/// The vertices of a triangle. Coordinates are multiples of 2^-149, the smallest positive float.
using Corners = std::array<glm::dvec3, 3>;
using FloatCorners = std::array<glm::vec3, 3>;  ///< corners in binary32
[[nodiscard]] inline Corners widened(const FloatCorners& t) {
  return {glm::dvec3(t[0]), glm::dvec3(t[1]), glm::dvec3(t[2])};
}
[[nodiscard]] inline FloatCorners rounded(const Corners& t) {
  return {glm::vec3(t[0]), glm::vec3(t[1]), glm::vec3(t[2])};
}

/// Returns the largest magnitude of the components.
template <class T>
[[nodiscard]] T largest(const glm::vec<3, T>& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Largest magnitude of coordinates that BVHs and predicates accept.
inline constexpr double kMostCoordinate = 0x1p126;

/// Returns whether the exact a - b is a double.
[[nodiscard]] bool has_exact_difference(double a, double b);

/// Returns an origin near the middle of most positions, so that all `position - origin` are exact
/// in double and at most kMostCoordinate in magnitude. Each coordinate is a multiple of the least
/// power of two for which this is possible, or 0 if it is possible for none.
[[nodiscard]] glm::dvec3 exact_origin(std::span<const glm::dvec3> positions);

/// Returns the multiple of 2^-149 nearest to x.
[[nodiscard]] inline double on_float_grid(double x) {
  return std::abs(x) < 0x1p-97 ? std::nearbyint(x * 0x1p149) * 0x1p-149 : x;
}

/// Returns 2^-30 ulp(x) for a normal float x. All doubles that round to x are multiples of it.
[[nodiscard]] inline double unit_of_rest(float x) {
  constexpr std::uint32_t kField = 0xFF;
  const std::uint64_t exponent = std::bit_cast<std::uint32_t>(x) >> 23 & kField;
  return std::bit_cast<double>((exponent + (1023 - 127 - 53)) << 52);
}

/// Returns the rest of x: x minus `nearest`, its nearest float, in units of unit_of_rest(nearest).
/// Exact if x is a multiple of 2^-149.
[[nodiscard]] inline std::int32_t rest_of(double x, float nearest) {
  return static_cast<std::int32_t>((x - double{nearest}) / unit_of_rest(nearest));
}
/// Returns the x whose nearest float is `nearest` and whose rest_of() is `rest`.
[[nodiscard]] inline double with_rest(float nearest, std::int32_t rest) {
  return double{nearest} + rest * unit_of_rest(nearest);
}

/// Return the largest float that is not above x, and the smallest that is not below x.
[[nodiscard]] inline float float_below(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest > x ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}
[[nodiscard]] inline float float_above(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

/// Returns whether all components are floats.
[[nodiscard]] inline bool is_binary32(const glm::dvec3& v) { return glm::dvec3(glm::vec3(v)) == v; }

template <class T>
[[nodiscard]] bool is_finite(const glm::vec<3, T>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Returns whether rays can have this direction: all components are finite, and not all are 0. Rays
/// with other directions hit nothing.
template <class T>
[[nodiscard]] bool is_usable(const glm::vec<3, T>& direction) {
  return is_finite(direction) && direction != glm::vec<3, T>(0);
}

/// Returns the unit vector of `v`, which is not 0, without overflow or underflow of squares.
[[nodiscard]] inline glm::dvec3 unit(const glm::dvec3& v) { return glm::normalize(v / largest(v)); }

/// Returns whether the largest component's magnitude is in [1, 2). Intersectors, BVHs and the
/// hardware require this. Scaling by a power of two changes neither rounding nor hits.
[[nodiscard]] bool is_scaled(const glm::vec3& direction);

/// Returns `direction`, which is finite and not 0, scaled (see is_scaled) and rounded to float.
[[nodiscard]] glm::vec3 scaled_direction(const glm::dvec3& direction);

/// A ray origin + t direction. The range t > 0 is open: surfaces that contain the origin, or are
/// behind it, are not hit. A limit is exclusive, too: hits have t < limit (see RayQuery in
/// host/intersect). All components are finite; coordinates, including those of triangles, have a
/// magnitude of at most kMostCoordinate. Intersectors require a scaled direction (see is_scaled).
struct Ray {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f};
};

/// An interval [low, high] that contains the exact t of a hit.
struct Interval {
  double low, high;
};

/// A hit, rounded to float.
struct PreciseHit {
  float t = 0.0f;
  glm::vec3 point{0.0f};  ///< t times the direction: the position relative to the ray's origin
};

/// A ray of the exact predicates, in binary64. Coordinates are multiples of 2^-149.
struct ExactRay {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0};

  ExactRay() = default;
  ExactRay(const glm::dvec3& from, const glm::dvec3& to) : origin(from), direction(to) {}
  // NOLINTNEXTLINE(google-explicit-constructor): every Ray is exactly an ExactRay
  ExactRay(const Ray& ray) : origin(ray.origin), direction(ray.direction) {}
};

/// Returns the side on which the ray passes the edge from `a` to `b`: the sign (-1, 0, 1) of
/// direction . (A x B) for A = a - origin and B = b - origin. If this product is exactly 0, returns
/// the sign for a direction tilted by an infinitesimal e towards +x, by e^2 towards +y and by e^3
/// towards +z. The result is 0 only if the edge's line contains the origin.
[[nodiscard]] int edge_side(const ExactRay& ray, const glm::dvec3& a, const glm::dvec3& b);

/// Returns the side of the triangle's plane on which the origin is: the sign of det(A, B, C) for
/// A, B, C the corners minus the origin; 0 if the origin is in the plane or the area is 0.
[[nodiscard]] int orient3d(const glm::dvec3& origin, const Corners& triangle);

/// Returns whether the ray, tilted as in edge_side, hits the triangle. Neighbours in a closed mesh
/// agree about their shared edge because both use the same tilted ray: of the triangles around a
/// vertex, one is hit. Triangles behind the origin, or with the origin in their plane, never are.
[[nodiscard]] bool hits_triangle(const ExactRay& ray, const Corners& triangle);

/// Returns whether the ray's line meets the triangle's plane in front of the origin, at t > 0.
[[nodiscard]] bool is_ahead(const ExactRay& ray, const Corners& triangle);

/// Returns bounds of t for a triangle that the ray hits (hits_triangle()). high <= low (1 + 2^-34).
[[nodiscard]] Interval hit_distance(const ExactRay& ray, const Corners& triangle);

/// The position P of a hit on the triangle of corners a, b, c: P = (1 - u - v) a + u b + v c. The
/// errors of u and v are at most 2^-34. None of the weights u, v and 1 - u - v is negative or -0.
struct Barycentric {
  double u, v;
};

/// Returns the position of a hit on a triangle that the ray hits (hits_triangle()).
[[nodiscard]] Barycentric barycentric(const ExactRay& ray, const Corners& triangle);

/// Returns t and point of a hit, computed from the corners. The error of t and of each coordinate
/// is at most (1 + 2^-10) / 2 ulp of float, at any angle of incidence.
[[nodiscard]] PreciseHit precise_hit(const ExactRay& ray, const Corners& triangle);

/// Returns the exact sign of t(first) - t(second). The ray must hit both triangles.
[[nodiscard]] int compare_hits(const ExactRay& ray, const Corners& first, const Corners& second);

/// Returns the exact sign of t - limit. The ray must hit the triangle; 2^-149 <= limit < 2^128.
[[nodiscard]] int compare_hit_to_limit(const ExactRay& ray, const Corners& triangle, double limit);

/// Returns orient3d(P, other) for the exact point P at which the ray hits the triangle `hit`.
[[nodiscard]] int plane_side_at_hit(const ExactRay& ray, const Corners& hit, const Corners& other);

/// Returns the exact sign of direction . N for the normal N of triangle_normal(): the sign of
/// orient3d(origin, triangle) if the ray moves towards the plane, its negation if it moves away.
[[nodiscard]] int direction_side(const glm::dvec3& direction, const Corners& triangle);

/// Returns D = (a - origin) . ((b - a) x (c - a)) in double for the corners a, b, c. The relative
/// error is at most 2^-32, and the sign is exact.
[[nodiscard]] double plane_distance(const glm::dvec3& origin, const Corners& triangle);

/// Returns (p - origin) x (q - p) in double. The error of each component is at most 2^-34 of the
/// sum of the components' magnitudes.
[[nodiscard]] glm::dvec3 edge_normal(const glm::dvec3& origin, const glm::dvec3& p,
                                     const glm::dvec3& q);

/// Returns (b - a) x (c - a) with edge_normal's error bound; 0 only if a, b, c are exactly in line.
[[nodiscard]] glm::dvec3 triangle_normal(const Corners& triangle);

/// Returns 1 if a, b, c are in counter-clockwise order, -1 if clockwise, 0 if they are exactly
/// collinear. Coordinates are multiples of 2^-149, of any finite magnitude that a float can have.
[[nodiscard]] int orient2d(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

/// Returns 1 if the closed polygon's signed area is positive (counter-clockwise), -1 if negative, 0
/// if exactly zero. Coordinates are as in orient2d. Sets `area` to the rounded area.
[[nodiscard]] int area_sign(std::span<const glm::dvec2> polygon, double& area);

}  // namespace raygate
