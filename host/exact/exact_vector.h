// Exact vectors: differences of points, their cross and dot products.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "host/exact/expansion.h"

namespace raygate {

template <int N>
using ExactVector = std::array<Expansion<N>, 3>;

/// a - b.
[[nodiscard]] inline ExactVector<2> exact_difference(const glm::vec3& a, const glm::vec3& b) {
  return {exact_difference(a.x, b.x), exact_difference(a.y, b.y), exact_difference(a.z, b.z)};
}

[[nodiscard]] inline ExactVector<16> exact_cross(const ExactVector<2>& u, const ExactVector<2>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

[[nodiscard]] inline Expansion<192> exact_dot(const ExactVector<2>& u, const ExactVector<16>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

[[nodiscard]] inline Expansion<96> exact_dot(const glm::vec3& u, const ExactVector<16>& v) {
  return v[0] * static_cast<double>(u.x) + v[1] * static_cast<double>(u.y) +
         v[2] * static_cast<double>(u.z);
}

}  // namespace raygate
