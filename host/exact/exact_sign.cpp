#include "host/exact/exact_sign.h"

#include <cmath>

#include "host/exact/expansion.h"

namespace raygate {
namespace {

constexpr double kUnitRoundoff = 0x1p-53;

// A product of two floats has at most 48 bits and an exponent of -298 to 256: exact in a double.
double exact_product(float a, float b) { return static_cast<double>(a) * static_cast<double>(b); }

int sign_of(double x) { return (x > 0.0) - (x < 0.0); }

}  // namespace

int orient2d(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  const glm::dvec2 from_c_to_a = glm::dvec2(a) - glm::dvec2(c);
  const glm::dvec2 from_c_to_b = glm::dvec2(b) - glm::dvec2(c);
  const double left = from_c_to_a.x * from_c_to_b.y;
  const double right = from_c_to_a.y * from_c_to_b.x;
  const double determinant = left - right;
  // Shewchuk's bound A for the rounding of the two differences, two products and their difference.
  constexpr double kBound = (3.0 + 16.0 * kUnitRoundoff) * kUnitRoundoff;
  if (std::abs(determinant) > kBound * (std::abs(left) + std::abs(right))) {
    return sign_of(determinant);
  }
  ExactSum sum;
  sum.add(exact_product(a.x, b.y));
  sum.add(-exact_product(a.y, b.x));
  sum.add(exact_product(b.x, c.y));
  sum.add(-exact_product(b.y, c.x));
  sum.add(exact_product(c.x, a.y));
  sum.add(-exact_product(c.y, a.x));
  return sum.sign();
}

int area_sign(std::span<const glm::vec2> polygon, double& area) {
  double twice_area = 0.0;
  double magnitude = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec2& p = polygon[i];
    const glm::vec2& q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double left = exact_product(p.x, q.y);
    const double right = exact_product(p.y, q.x);
    twice_area += left - right;
    magnitude += std::abs(left) + std::abs(right);
  }
  area = 0.5 * twice_area;
  // n differences and n additions, each off by at most one unit roundoff of the magnitudes.
  const double bound = 2.0 * static_cast<double>(polygon.size() + 1) * kUnitRoundoff * magnitude;
  if (std::abs(twice_area) > bound) return sign_of(twice_area);

  ExactSum sum;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec2& p = polygon[i];
    const glm::vec2& q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    sum.add(exact_product(p.x, q.y));
    sum.add(-exact_product(p.y, q.x));
  }
  return sum.sign();
}

bool collinear(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto flat = [](const glm::vec3& p, int i, int j) { return glm::vec2(p[i], p[j]); };
  for (int axis = 0; axis < 3; ++axis) {
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    if (orient2d(flat(a, i, j), flat(b, i, j), flat(c, i, j)) != 0) return false;
  }
  return true;
}

}  // namespace raygate
