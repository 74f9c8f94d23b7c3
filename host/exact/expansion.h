// Exact sums and products of doubles, and exact vectors, after Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace raygate {

/// An exact result as a sum, value + error.
struct ExactPair {
  double value, error;
};

[[nodiscard]] inline ExactPair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_seen = sum - a;
  return {sum, (a - (sum - b_seen)) + (b - b_seen)};
}

/// Requires |a| >= |b|.
[[nodiscard]] inline ExactPair fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Computes Dekker's product: each factor is split in halves whose products are exact.
[[nodiscard]] inline ExactPair two_product(double a, double b) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double product = a * b;
  const double a_scaled = kSplitter * a;
  const double a_high = a_scaled - (a_scaled - a);
  const double a_low = a - a_high;
  const double b_scaled = kSplitter * b;
  const double b_high = b_scaled - (b_scaled - b);
  const double b_low = b - b_high;
  const double rest = ((product - a_high * b_high) - a_low * b_high) - a_high * b_low;
  return {product, a_low * b_low - rest};
}

/// An exact real number: the sum of non-zero doubles that do not overlap, of increasing magnitude;
/// 0 has none.
///
/// Every operation is exact as long as no product of two parts underflows or overflows in double.
/// Here all numbers are polynomials of degree at most 6 in floats, so multiples of 2^-894 and, with
/// coordinates up to 2^126, below 2^800.
struct Expansion {
  std::vector<double> parts;

  void append(double part) {
    if (part != 0.0) parts.push_back(part);
  }
  void append(const ExactPair& pair) {
    append(pair.error);
    append(pair.value);
  }
  /// Returns -1, 0 or 1: the sign of the largest part, which exceeds the sum of all others.
  [[nodiscard]] int sign() const { return parts.empty() ? 0 : (parts.back() > 0.0 ? 1 : -1); }
  /// Returns the nearest double, or a neighbour of it.
  [[nodiscard]] double approximate() const {
    double sum = 0.0;
    for (const double part : parts) sum += part;
    return sum;
  }
};

[[nodiscard]] inline Expansion operator+(const Expansion& e, const Expansion& f) {
  Expansion result;
  const std::size_t size = e.parts.size() + f.parts.size();
  if (size == 0) return result;
  result.parts.reserve(size);
  auto from_e = e.parts.begin(), from_f = f.parts.begin();
  const auto next_smallest = [&] {
    const bool is_e = from_f == f.parts.end() ||
                      (from_e != e.parts.end() && std::abs(*from_e) < std::abs(*from_f));
    return is_e ? *from_e++ : *from_f++;
  };
  double carry = next_smallest();
  for (std::size_t i = 1; i < size; ++i) {
    const ExactPair pair = two_sum(carry, next_smallest());
    result.append(pair.error);
    carry = pair.value;
  }
  result.append(carry);
  return result;
}

[[nodiscard]] inline Expansion operator-(const Expansion& e, Expansion f) {
  for (double& part : f.parts) part = -part;
  return e + f;
}

[[nodiscard]] inline Expansion operator*(const Expansion& e, double factor) {
  Expansion result;
  if (e.parts.empty() || factor == 0.0) return result;
  result.parts.reserve(2 * e.parts.size());
  ExactPair carry = two_product(e.parts[0], factor);
  result.append(carry.error);
  for (std::size_t i = 1; i < e.parts.size(); ++i) {
    const ExactPair product = two_product(e.parts[i], factor);
    const ExactPair low = two_sum(carry.value, product.error);
    result.append(low.error);
    carry = fast_two_sum(product.value, low.value);
    result.append(carry.error);
  }
  result.append(carry.value);
  return result;
}

[[nodiscard]] inline Expansion operator*(const Expansion& e, const Expansion& f) {
  Expansion result;
  for (const double part : f.parts) result = e * part + result;
  return result;
}

[[nodiscard]] inline Expansion exact_difference(double a, double b) {
  Expansion result;
  result.append(two_sum(a, -b));
  return result;
}

using ExactVector = std::array<Expansion, 3>;

/// Returns a - b.
[[nodiscard]] inline ExactVector exact_difference(const glm::vec3& a, const glm::vec3& b) {
  return {exact_difference(a.x, b.x), exact_difference(a.y, b.y), exact_difference(a.z, b.z)};
}

[[nodiscard]] inline ExactVector exact_cross(const ExactVector& u, const ExactVector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

[[nodiscard]] inline Expansion exact_dot(const ExactVector& u, const ExactVector& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

[[nodiscard]] inline Expansion exact_dot(const glm::vec3& u, const ExactVector& v) {
  return v[0] * double{u.x} + v[1] * double{u.y} + v[2] * double{u.z};
}

}  // namespace raygate
