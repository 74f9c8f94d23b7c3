#include "host/exact/exact.h"

#include <cstddef>
#include <memory>
#include <vector>

#include "host/base/triple.h"
#include "host/exact/expansion.h"

namespace raygate {
namespace {

constexpr double kU = 0x1p-53;  // the unit roundoff of double

/// A value computed in double and a bound of its error. The bound is 0 only if all terms of the
/// value are exactly 0, for example in planes that are parallel to an axis.
struct Estimate {
  double value, error;
  [[nodiscard]] bool sure() const { return std::abs(value) > error || error == 0.0; }
  [[nodiscard]] int sign() const { return (value > 0.0) - (value < 0.0); }
};

/// A cross product of two rounded differences. `magnitude` is the sum of the magnitudes of the two
/// products of each component. The error of a component is less than 5 kU magnitude: each product
/// has four roundings (two differences, the product, the subtraction).
struct Cross {
  glm::dvec3 value, magnitude;

  Cross(const glm::dvec3& u, const glm::dvec3& v) { value = cross(u, v, magnitude); }

  /// Returns whether each component's error is surely at most 2^-34 times |x| + |y| + |z| of
  /// `value`. The factor is 8 kU, not 5 kU, to cover the rounding of this comparison.
  [[nodiscard]] bool accurate() const {
    const double size = std::abs(value.x) + std::abs(value.y) + std::abs(value.z);
    return 8.0 * kU * largest(magnitude) <= 0x1p-34 * size;
  }
};

/// Returns u . cross. Each term has at most eight roundings: four in `cross`, one in u, one in the
/// product and two in the sums. The factor 10 kU, not 8 kU, covers the rounding of the bound.
Estimate dot(const glm::dvec3& u, const Cross& cross) {
  const double value = u.x * cross.value.x + u.y * cross.value.y + u.z * cross.value.z;
  const double magnitude = std::abs(u.x) * cross.magnitude.x + std::abs(u.y) * cross.magnitude.y +
                           std::abs(u.z) * cross.magnitude.z;
  return {value, 10.0 * kU * magnitude};
}

glm::dvec3 rounded(const ExactVector<16>& v) {
  return {v[0].approximate(), v[1].approximate(), v[2].approximate()};
}

ExactVector<16> exact_normal(const Corners& t) {
  return exact_cross(exact_difference(t[1], t[0]), exact_difference(t[2], t[0]));
}

Expansion<192> exact_plane(const glm::dvec3& origin, const Corners& t) {
  return exact_dot(exact_difference(t[0], origin), exact_normal(t));
}

Cross estimated_normal(const Corners& t) { return {t[1] - t[0], t[2] - t[0]}; }

int exact_edge_side(const ExactRay& ray, const glm::dvec3& a, const glm::dvec3& b) {
  const auto normal = exact_cross(exact_difference(a, ray.origin), exact_difference(b, a));
  if (const int side = exact_dot(ray.direction, normal).sign(); side != 0) return side;
  for (const auto& component : normal) {
    if (component.sign() != 0) return component.sign();
  }
  return 0;
}

Expansion<96> exact_slope(const glm::dvec3& direction, const Corners& t) {
  return exact_dot(direction, exact_normal(t));
}

/// The ray's t at a triangle's plane, estimated: plane_distance / (direction . triangle_normal).
struct Fraction {
  Estimate numerator, denominator;

  Fraction(const ExactRay& ray, const Corners& t) {
    const Cross normal = estimated_normal(t);
    numerator = dot(t[0] - ray.origin, normal);
    denominator = dot(ray.direction, normal);
  }
};

/// Returns a * b. The error bound is the effect of both factors' errors plus kU |value|, the error
/// of rounding the product. The factors 1.000001 and 2 cover the rounding of the bound itself.
Estimate product(const Estimate& a, const Estimate& b) {
  const double value = a.value * b.value;
  return {value, 1.000001 * (a.error * std::abs(b.value) + std::abs(a.value) * b.error +
                             a.error * b.error) +
                     2.0 * kU * std::abs(value)};
}

/// Computes order_of_planes exactly. The products are too large for the stack.
int exact_order_of_planes(const ExactRay& ray, const Corners& first, const Corners& second) {
  using Product = Expansion<2 * 192 * 96>;
  const auto left = std::make_unique_for_overwrite<Product>();
  const auto right = std::make_unique_for_overwrite<Product>();
  const auto scratch = std::make_unique_for_overwrite<Product>();
  multiply(exact_plane(ray.origin, first), exact_slope(ray.direction, second), *left, *scratch);
  multiply(exact_plane(ray.origin, second), exact_slope(ray.direction, first), *right, *scratch);
  const auto result = std::make_unique_for_overwrite<Expansion<4 * 192 * 96>>();
  for (int i = 0; i < right->size; ++i) right->parts[i] = -right->parts[i];
  add(*left, *right, *result);
  return result->sign();
}

/// Returns the sign of D1 S2 - D2 S1, for t1 = D1 / S1 and t2 = D2 / S2 as in Fraction (S is the
/// denominator). This is the product of the signs of t1 - t2, S1 and S2.
int order_of_planes(const ExactRay& ray, const Corners& first, const Corners& second) {
  const Fraction t1(ray, first), t2(ray, second);
  const Estimate left = product(t1.numerator, t2.denominator);
  const Estimate right = product(t2.numerator, t1.denominator);
  const Estimate gap = {left.value - right.value, 1.000001 * (left.error + right.error)};
  if (gap.sure()) return gap.sign();
  // Coplanar triangles are common, and exact arithmetic takes longest for them.
  const bool are_coplanar = std::ranges::all_of(
      second, [&](const glm::dvec3& corner) { return orient3d(corner, first) == 0; });
  return are_coplanar ? 0 : exact_order_of_planes(ray, first, second);
}

}  // namespace

bool has_exact_difference(double a, double b) { return two_sum(a, -b).error == 0.0; }

glm::dvec3 exact_origin(std::span<const glm::dvec3> positions) {
  // Bounds of the middle half of the coordinates, so that a few far positions do not matter.
  glm::dvec3 low, high;
  std::vector<double> sorted(positions.size());
  const auto quarter = static_cast<std::ptrdiff_t>(positions.size() / 4);
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(positions, sorted.begin(), [&](const auto& at) { return at[axis]; });
    std::ranges::nth_element(sorted, sorted.begin() + quarter);
    low[axis] = sorted[static_cast<std::size_t>(quarter)];
    std::ranges::nth_element(sorted, sorted.end() - 1 - quarter);
    high[axis] = *(sorted.end() - 1 - quarter);
  }
  glm::dvec3 origin(0.0);
  const int least = std::ilogb(std::max(largest(high - low), 0x1p-100)) + 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double centre = 0.5 * low[axis] + 0.5 * high[axis];
    if (centre == 0.0) continue;
    for (int exponent = least; exponent <= std::ilogb(centre) + 1; ++exponent) {
      const double steps = std::nearbyint(std::ldexp(centre, -exponent));
      if (std::abs(steps) >= 0x1p53) continue;
      const double candidate = std::ldexp(steps, exponent);
      const bool is_exact = std::ranges::all_of(positions, [&](const glm::dvec3& at) {
        return has_exact_difference(at[axis], candidate) &&
               std::abs(at[axis] - candidate) <= kMostCoordinate;
      });
      if (!is_exact) continue;
      origin[axis] = candidate;
      break;
    }
  }
  return origin;
}

bool is_scaled(const glm::vec3& direction) {
  const float size = largest(direction);
  return size >= 1.0f && size < 2.0f;
}

glm::vec3 scaled_direction(const glm::dvec3& direction) {
  // The factor is a power of two made from bits. For extreme exponents, scalbn scales instead.
  constexpr std::uint64_t kExponent = 0x7FF0000000000000, kOne = 0x3FF0000000000000;
  const double size = largest(direction);
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(size) & kExponent;
  const bool has_room = bits != 0 && bits < 2 * kOne;
  const int exponent = has_room ? 0 : std::ilogb(size);
  glm::vec3 scaled =
      has_room ? glm::vec3(direction * std::bit_cast<double>(2 * kOne - bits))
               : glm::vec3(std::scalbn(direction.x, -exponent), std::scalbn(direction.y, -exponent),
                           std::scalbn(direction.z, -exponent));
  // Rounding to float may have increased 1.99999999 to 2.
  if (largest(scaled) >= 2.0f) scaled *= 0.5f;
  return scaled;
}

int edge_side(const ExactRay& ray, const glm::dvec3& a, const glm::dvec3& b) {
  const Estimate side = dot(ray.direction, {a - ray.origin, b - a});
  return side.sure() && side.sign() != 0 ? side.sign() : exact_edge_side(ray, a, b);
}

int orient3d(const glm::dvec3& origin, const Corners& t) {
  const Estimate side = dot(t[0] - origin, estimated_normal(t));
  if (side.sure()) return side.sign();
  const bool is_corner = std::ranges::find(t, origin) != t.end();
  return is_corner ? 0 : exact_plane(origin, t).sign();
}

// Let A, B, C be the corners minus the origin, det their determinant and I the tilted direction.
// If det is not 0, then I = x A + y B + z C with x = I . (B x C) / det; y and z follow by cyclic
// permutation. Tilting makes x, y and z non-zero. I points into the triangle if all three are
// positive: the three edge sides must have the sign of det, which is orient3d.
// Then t = det / (I . (B x C) + I . (C x A) + I . (A x B)) is positive, too.
bool hits_triangle(const ExactRay& ray, const Corners& t) {
  if (!is_usable(ray.direction)) return false;
  const int side = orient3d(ray.origin, t);
  return side != 0 && edge_side(ray, t[0], t[1]) == side && edge_side(ray, t[1], t[2]) == side &&
         edge_side(ray, t[2], t[0]) == side;
}

int direction_side(const glm::dvec3& direction, const Corners& t) {
  const Estimate side = dot(direction, estimated_normal(t));
  return side.sure() ? side.sign() : exact_slope(direction, t).sign();
}

bool is_ahead(const ExactRay& ray, const Corners& t) {
  const auto& [n, d] = Fraction(ray, t);
  if (n.sure() && d.sure()) return n.sign() * d.sign() > 0;
  return orient3d(ray.origin, t) * direction_side(ray.direction, t) > 0;
}

// If the error of numerator or denominator exceeds 2^-37 of its value, both are computed exactly
// and then rounded to double, with an error of at most an ulp each.
Interval hit_distance(const ExactRay& ray, const Corners& triangle) {
  const auto& [n, d] = Fraction(ray, triangle);
  if (n.error <= 0x1p-37 * std::abs(n.value) && d.error <= 0x1p-37 * std::abs(d.value)) {
    const double above = std::abs(n.value), below = std::abs(d.value);
    constexpr double kGrow = 1.0 + 4.0 * kU, kShrink = 1.0 - 4.0 * kU;
    return {(above - n.error) / (below + d.error) * kShrink,
            (above + n.error) / (below - d.error) * kGrow};
  }
  const double t = exact_plane(ray.origin, triangle).approximate() /
                   exact_slope(ray.direction, triangle).approximate();
  return {t * (1.0 - 16.0 * kU), t * (1.0 + 16.0 * kU)};
}

// The error of u and v is at most 2^-34. They are quotients w / S of one of the three edge products
// direction . (A x B) and the sum S of all three, with w / S in [0, 1].
// Each product has an error of at most e = 2^-37 |S|; otherwise all are computed exactly.
// So the error of S is at most 3 e. The error of w / S is (e + 3 e) / |S| = 2^-35, plus roundings.
Barycentric barycentric(const ExactRay& ray, const Corners& triangle) {
  double weights[3], sum = 0.0, error = 0.0;
  const auto corner = [&](int k) -> const glm::dvec3& { return triangle[std::size_t(k) % 3]; };
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &a = corner(k + 1), &b = corner(k + 2);
    const Estimate side = dot(ray.direction, {a - ray.origin, b - a});
    weights[k] = side.value;
    sum += side.value;
    error = std::max(error, side.error);
  }
  if (error > 0x1p-37 * std::abs(sum)) {
    sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 &a = corner(k + 1), &b = corner(k + 2);
      weights[k] = exact_dot(ray.direction,
                             exact_cross(exact_difference(a, ray.origin), exact_difference(b, a)))
                       .approximate();
      sum += weights[k];
    }
  }
  const auto within = [](double share, double most) {  // clamping only reduces errors
    return std::max(0.0, std::min(share, most));
  };
  const double u = within(weights[1] / sum, 1.0);
  return {u, within(weights[2] / sum, 1.0 - u)};
}

PreciseHit precise_hit(const ExactRay& ray, const Corners& triangle) {
  const Interval interval = hit_distance(ray, triangle);
  const double t = 0.5 * (interval.low + interval.high);
  return {static_cast<float>(t), glm::vec3(t * ray.direction)};
}

// order_of_planes includes the signs of S1 and S2, which are those of D1 and D2 because t > 0.
int compare_hits(const ExactRay& ray, const Corners& first, const Corners& second) {
  return orient3d(ray.origin, first) * orient3d(ray.origin, second) *
         order_of_planes(ray, first, second);
}

int compare_hit_to_limit(const ExactRay& ray, const Corners& triangle, double limit) {
  const Interval t = hit_distance(ray, triangle);
  if (t.high < limit) return -1;
  if (t.low > limit) return 1;
  const auto excess =
      exact_plane(ray.origin, triangle) - exact_slope(ray.direction, triangle) * limit;
  return orient3d(ray.origin, triangle) * excess.sign();
}

// Let t = D1 / S1 for `hit` and D2 / S2 for `other`, as in Fraction. D of `other` seen from the hit
// is D2 - t S2 = (D2 S1 - D1 S2) / S1, and S1 has the sign of D1 because t > 0.
int plane_side_at_hit(const ExactRay& ray, const Corners& hit, const Corners& other) {
  return orient3d(ray.origin, hit) * order_of_planes(ray, other, hit);
}

double plane_distance(const glm::dvec3& origin, const Corners& t) {
  const Estimate d = dot(t[0] - origin, estimated_normal(t));
  return d.error <= 0x1p-32 * std::abs(d.value) && d.sure() ? d.value
                                                            : exact_plane(origin, t).approximate();
}

glm::dvec3 edge_normal(const glm::dvec3& origin, const glm::dvec3& p, const glm::dvec3& q) {
  const Cross cross(p - origin, q - p);
  return cross.accurate()
             ? cross.value
             : rounded(exact_cross(exact_difference(p, origin), exact_difference(q, p)));
}

glm::dvec3 triangle_normal(const Corners& t) {
  const Cross normal = estimated_normal(t);
  return normal.accurate() ? normal.value : rounded(exact_normal(t));
}

int area_sign(std::span<const glm::dvec2> polygon, double& area) {
  double twice_area = 0.0;
  double magnitude = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& p = polygon[i];
    const glm::dvec2& q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double left = p.x * q.y;
    const double right = p.y * q.x;
    twice_area += left - right;
    magnitude += std::abs(left) + std::abs(right);
  }
  area = 0.5 * twice_area;
  // The error of twice_area is at most (n + 2) kU magnitude for n vertices: kU magnitude for all
  // products, as much for all differences, and n times as much for n sums. The bound exceeds it.
  const double bound = 2.0 * static_cast<double>(polygon.size() + 1) * kU * magnitude;
  if (std::abs(twice_area) > bound) return twice_area > 0.0 ? 1 : -1;

  ExactSum sum;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2& p = polygon[i];
    const glm::dvec2& q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    for (const auto& [value, error] : {two_product(p.x, q.y), two_product(-p.y, q.x)}) {
      sum.add(error);
      sum.add(value);
    }
  }
  return sum.sign();
}

int orient2d(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  const glm::dvec2 corners[] = {a, b, c};
  double area = 0.0;
  return area_sign(corners, area);
}

}  // namespace raygate
