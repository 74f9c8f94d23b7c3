// Exact sums and products of doubles, and exact vectors, after Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace raygate {

/// An exact real number: the sum of `size` non-zero doubles that do not overlap, of increasing
/// magnitude. The number 0 has no parts. `Capacity` is the largest possible size.
///
/// Every operation is exact as long as no product of two parts underflows or overflows in double.
/// Predicates compute polynomials of degree at most 6 in coordinates, which are multiples of 2^-149
/// up to 2^126. All products are therefore multiples of 2^-894 and below 2^800.
template <int Capacity>
struct Expansion {
  int size = 0;
  double parts[Capacity];  // the first `size` are set

  void append(double part) {
    if (part != 0.0) parts[size++] = part;
  }
  /// Returns -1, 0 or 1: the sign of the largest part, which exceeds the sum of all others.
  [[nodiscard]] int sign() const { return size == 0 ? 0 : (parts[size - 1] > 0.0 ? 1 : -1); }
  /// Returns the double nearest to the exact number, or one of that double's neighbours.
  [[nodiscard]] double approximate() const {
    double sum = 0.0;
    for (int i = 0; i < size; ++i) sum += parts[i];
    return sum;
  }
};

/// An exact result value + error, where `value` is the result rounded to double.
struct ExactPair {
  double value, error;
};

[[nodiscard]] inline ExactPair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_seen = sum - a;
  return {sum, (a - (sum - b_seen)) + (b - b_seen)};
}

/// Returns the exact sum a + b, like two_sum, but requires |a| >= |b|.
[[nodiscard]] inline ExactPair fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Returns the exact a * b by Dekker's method: factors are split into halves with exact products.
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

[[nodiscard]] inline Expansion<2> exact_difference(double a, double b) {
  const ExactPair pair = two_sum(a, -b);
  Expansion<2> result;
  result.append(pair.error);
  result.append(pair.value);
  return result;
}

/// Computes `result` = `e` + `f`. `result` must be a separate object.
template <int N, int M, int C>
void add(const Expansion<N>& e, const Expansion<M>& f, Expansion<C>& result) {
  result.size = 0;
  int i = 0, j = 0;
  const auto next_smallest = [&] {
    const bool from_e = j == f.size || (i < e.size && std::abs(e.parts[i]) < std::abs(f.parts[j]));
    return from_e ? e.parts[i++] : f.parts[j++];
  };
  if (e.size + f.size == 0) return;
  double carry = next_smallest();
  while (i < e.size || j < f.size) {
    const ExactPair pair = two_sum(carry, next_smallest());
    result.append(pair.error);
    carry = pair.value;
  }
  result.append(carry);
}

template <int N, int M>
[[nodiscard]] Expansion<N + M> operator+(const Expansion<N>& e, const Expansion<M>& f) {
  Expansion<N + M> result;
  add(e, f, result);
  return result;
}

template <int N>
[[nodiscard]] Expansion<N> operator-(const Expansion<N>& e) {
  Expansion<N> result;
  result.size = e.size;
  for (int i = 0; i < e.size; ++i) result.parts[i] = -e.parts[i];
  return result;
}

template <int N, int M>
[[nodiscard]] Expansion<N + M> operator-(const Expansion<N>& e, const Expansion<M>& f) {
  return e + -f;
}

template <int N>
[[nodiscard]] Expansion<2 * N> operator*(const Expansion<N>& e, double factor) {
  Expansion<2 * N> result;
  if (e.size == 0 || factor == 0.0) return result;
  ExactPair carry = two_product(e.parts[0], factor);
  result.append(carry.error);
  for (int i = 1; i < e.size; ++i) {
    const ExactPair product = two_product(e.parts[i], factor);
    const ExactPair low = two_sum(carry.value, product.error);
    result.append(low.error);
    carry = fast_two_sum(product.value, low.value);
    result.append(carry.error);
  }
  result.append(carry.value);
  return result;
}

/// Computes `result` = `e` * `f`; uses `scratch` for intermediate results.
template <int N, int M>
void multiply(const Expansion<N>& e, const Expansion<M>& f, Expansion<2 * N * M>& result,
              Expansion<2 * N * M>& scratch) {
  result.size = 0;
  for (int i = 0; i < f.size; ++i) {
    add(e * f.parts[i], result, scratch);
    result.size = scratch.size;
    for (int k = 0; k < scratch.size; ++k) result.parts[k] = scratch.parts[k];
  }
}

template <int N, int M>
[[nodiscard]] Expansion<2 * N * M> operator*(const Expansion<N>& e, const Expansion<M>& f) {
  Expansion<2 * N * M> result, scratch;
  multiply(e, f, result, scratch);
  return result;
}

template <int N>
using ExactVector = std::array<Expansion<N>, 3>;

[[nodiscard]] inline ExactVector<2> exact_difference(const glm::dvec3& a, const glm::dvec3& b) {
  return {exact_difference(a.x, b.x), exact_difference(a.y, b.y), exact_difference(a.z, b.z)};
}

[[nodiscard]] inline ExactVector<16> exact_cross(const ExactVector<2>& u, const ExactVector<2>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

[[nodiscard]] inline Expansion<192> exact_dot(const ExactVector<2>& u, const ExactVector<16>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

[[nodiscard]] inline Expansion<96> exact_dot(const glm::dvec3& u, const ExactVector<16>& v) {
  return v[0] * u.x + v[1] * u.y + v[2] * u.z;
}

/// A sum of doubles without rounding: an Expansion of unbounded size (Shewchuk's
/// GROW-EXPANSION with zero elimination). Terms and sums must not overflow.
class ExactSum {
 public:
  void add(double term) {
    std::size_t kept = 0;
    for (const double part : parts_) {
      const ExactPair pair = two_sum(term, part);
      if (pair.error != 0.0) parts_[kept++] = pair.error;
      term = pair.value;
    }
    parts_.resize(kept);
    if (term != 0.0) parts_.push_back(term);
  }
  [[nodiscard]] int sign() const { return parts_.empty() ? 0 : (parts_.back() > 0.0 ? 1 : -1); }

 private:
  std::vector<double> parts_;  // not overlapping, of increasing magnitude
};

}  // namespace raygate
