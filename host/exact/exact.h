// Exact predicates: whether a ray hits a triangle, and which of two hits is nearer.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "host/exact/ieee_floats.h"

namespace raygate {

/// The vertices of a triangle, in its order.
using Corners = std::array<glm::vec3, 3>;

/// The largest of the components' magnitudes.
template <class T>
[[nodiscard]] T largest(const glm::vec<3, T>& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Largest magnitude of coordinates that trees and predicates take.
inline constexpr double kMostCoordinate = 0x1p126;

/// A position relative to an origin, in binary32, and the largest of its coordinates' errors: 0 if
/// and only if the position is exact.
struct RecentredPosition {
  glm::vec3 position{0.0f};
  double error = 0.0;
};
[[nodiscard]] RecentredPosition recentred(const glm::dvec3& position, const glm::dvec3& origin);

/// The float nearest to x that is not above it, or not below it.
[[nodiscard]] inline float float_below(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest > x ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}
[[nodiscard]] inline float float_above(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

/// Whether a ray can go this way: all components finite, not all of them 0. In all others it hits
/// nothing.
[[nodiscard]] bool is_usable(const glm::vec3& direction);

/// Of length 1, also where the square of a component would overflow or underflow; `v` is not 0.
[[nodiscard]] inline glm::dvec3 unit(const glm::dvec3& v) { return glm::normalize(v / largest(v)); }

template <class T>
[[nodiscard]] bool is_finite(const glm::vec<3, T>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Whether the largest component's magnitude is in [1, 2): how intersectors, trees and units want
/// directions. Multiplying one by a power of two changes no rounding and no hit.
[[nodiscard]] bool is_scaled(const glm::vec3& direction);

/// `direction`, not 0 and finite, scaled and rounded to float.
[[nodiscard]] glm::vec3 scaled_direction(const glm::dvec3& direction);

/// A ray: origin + t direction for t > 0, an open beginning: what the origin lies on, and what is
/// behind it, is not hit. Where a ray has a limit, its end is open too: hits have t < limit (see
/// RayQuery in host/intersect). All components finite; coordinates, the triangles' too,
/// of magnitude at most kMostCoordinate. Intersectors want the direction scaled (see is_scaled).
struct Ray {
  glm::vec3 origin{0.0f};
  glm::vec3 direction{0.0f};
};

/// The exact t of a hit is in [low, high].
struct Interval {
  double low, high;
};

/// Where a ray meets a triangle, as exactly as floats can say it.
struct PreciseHit {
  float t = 0.0f;
  glm::vec3 point{0.0f};  ///< P = t I, seen from the ray's origin
};

/// The sign (-1, 0, 1) of I . (A x B), for A = a - O and B = b - O: on which side of the edge from
/// `a` to `b` the ray passes. Where it is exactly 0, the sign for a direction tilted by an
/// infinitesimal towards +x, by a still smaller one towards +y, and one towards +z. Only for an
/// edge in line with the origin does the tilt not help, and the answer is 0.
[[nodiscard]] int edge_side(const Ray& ray, const glm::vec3& a, const glm::vec3& b);

/// The sign of the determinant of A, B, C: on which side of the triangle's plane the origin is; 0
/// for an origin in the plane and for a triangle without area.
[[nodiscard]] int orient3d(const glm::vec3& origin, const Corners& triangle);

/// Whether the ray, tilted as above, hits the triangle. Neighbours in a closed mesh agree about
/// the edge they share because they ask one question about one tilted ray: exactly one triangle
/// of a fan is hit. A triangle whose plane holds the origin is never hit, nor one behind it.
[[nodiscard]] bool hits_triangle(const Ray& ray, const Corners& triangle);

/// Whether the ray's line meets the triangle's plane ahead of the origin, at t > 0.
[[nodiscard]] bool is_ahead(const Ray& ray, const Corners& triangle);

/// The t of a hit: for triangles that hits_triangle says are hit. high <= low (1 + 2^-34).
[[nodiscard]] Interval hit_distance(const Ray& ray, const Corners& triangle);

/// Where a hit lies on its triangle: P = (1 - u - v) A + u B + v C. Each of u and v is off by at
/// most 2^-34; none of the three weights is negative, nor -0.
struct Barycentric {
  double u, v;
};

/// For triangles that hits_triangle says are hit.
[[nodiscard]] Barycentric barycentric(const Ray& ray, const Corners& triangle);

/// t and P of a hit, from the corners, whatever the angle: each word is off by at most half the
/// distance of floats around it and 2^-10 of that.
[[nodiscard]] PreciseHit precise_hit(const Ray& ray, const Corners& triangle);

/// The sign of t(first) - t(second), exactly. Both must be hits.
[[nodiscard]] int compare_hits(const Ray& ray, const Corners& first, const Corners& second);

/// The sign of t - limit, exactly. The triangle must be hit, `limit` positive and finite.
[[nodiscard]] int compare_hit_to_limit(const Ray& ray, const Corners& triangle, float limit);

/// As orient3d of `other`, exactly, for the very point in which the ray hits `hit`.
[[nodiscard]] int plane_side_at_hit(const Ray& ray, const Corners& hit, const Corners& other);

/// The sign of I . N, exactly: a direction with the sign of orient3d(origin, triangle) goes
/// towards the plane, one with the other sign away from it.
[[nodiscard]] int direction_side(const glm::vec3& direction, const Corners& triangle);

/// The double nearest to D = A . ((b-a) x (c-a)), off by 2^-32 of itself at most, with its exact
/// sign.
[[nodiscard]] double plane_distance(const glm::vec3& origin, const Corners& triangle);

/// (p - origin) x (q - p) in double; each component is off by at most 2^-34 of the sum of the
/// components' magnitudes.
[[nodiscard]] glm::dvec3 edge_normal(const glm::vec3& origin, const glm::vec3& p,
                                     const glm::vec3& q);

/// (b-a) x (c-a), as accurate as edge_normal.
[[nodiscard]] glm::dvec3 triangle_normal(const Corners& triangle);

/// 1 if a, b, c orient2d counter-clockwise, -1 if clockwise, 0 if they are exactly on one line.
/// For all finite floats.
[[nodiscard]] int orient2d(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c);

/// 1 if the closed polygon's signed area is positive (counter-clockwise), -1 if it is negative, 0
/// if it is exactly zero. For all finite floats. `area` becomes the rounded area.
[[nodiscard]] int area_sign(std::span<const glm::vec2> polygon, double& area);

/// True if the three points are exactly on one line (or coincide). For all finite floats.
[[nodiscard]] bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

}  // namespace raygate
