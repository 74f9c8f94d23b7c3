#include "host/intersect/core/set_up.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "host/exact/binary32.h"
#include "host/intersect/point_error.h"

namespace raygate {
namespace {

// Constants of set_up_pkg.sv; triangle_test.sv explains them.
constexpr int kLeastField = 27;
constexpr int kBoundShift = 20;
constexpr int kBias = 127;
constexpr int kMostPlaneError = 14;
constexpr std::uint32_t kTErrorUnit = 8;

float subtract(float a, float b) { return Binary32::add(a, -b); }

glm::vec3 difference(const glm::vec3& a, const glm::vec3& b) {
  return {subtract(a.x, b.x), subtract(a.y, b.y), subtract(a.z, b.z)};
}

struct CrossProduct {
  glm::vec3 product;
  glm::vec3 terms;  // |a_i b_j| + |a_j b_i|
};

CrossProduct cross_product(const glm::vec3& a, const glm::vec3& b) {
  CrossProduct cross;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const float left = Binary32::multiply(a[i], b[j]), right = Binary32::multiply(a[j], b[i]);
    cross.product[k] = subtract(left, right);
    cross.terms[k] = Binary32::add(std::abs(left), std::abs(right));
  }
  return cross;
}

float sum(const glm::vec3& v) { return Binary32::add(Binary32::add(v.x, v.y), v.z); }

bool is_in_range(int field) { return field >= kLeastField && field < 255; }

float edge_bound(float terms) {
  if (!is_in_range(Binary32::exponent_field(terms))) return std::numeric_limits<float>::infinity();
  return std::bit_cast<float>(Binary32::to_word(terms) - (std::uint32_t{kBoundShift} << 23));
}

}  // namespace

SetUpRecord set_up(const glm::vec3& origin, const Corners& triangle) {
  SetUpRecord result;
  PolygonRecord& record = result.record;
  Corners corners, edges;
  for (int k = 0; k < 3; ++k) {
    corners[k] = difference(triangle[k], origin);
    edges[k] = difference(triangle[(k + 1) % 3], triangle[k]);
  }
  for (int k = 0; k < 3; ++k) {
    const CrossProduct edge = cross_product(corners[k], edges[k]);
    record.edges[k] = edge.product;
    record.bounds[k] = edge_bound(sum(edge.terms));
  }
  const CrossProduct normal = cross_product(edges[2], edges[0]);
  record.normal = normal.product;
  glm::vec3 shares;
  for (int k = 0; k < 3; ++k) shares[k] = Binary32::multiply(normal.product[k], corners[0][k]);
  record.d = sum(shares);

  const int vertex_field = largest_field(corners[0]), terms_field = largest_field(normal.terms);
  const int d_field = Binary32::exponent_field(record.d);
  const int normal_error = terms_field - largest_field(normal.product);
  const int distance_error = std::max(vertex_field + terms_field - d_field - kBias, 0);
  const bool is_good = is_in_range(terms_field) && vertex_field < 255 && is_in_range(d_field) &&
                       normal_error <= kMostPlaneError && distance_error <= kMostPlaneError;
  if (is_good) {
    result.normal_error = static_cast<std::uint32_t>(normal_error);
    result.distance_error = static_cast<std::uint32_t>(distance_error);
  } else {
    record.d = std::bit_cast<float>(0x7FC00000u);
  }
  return result;
}

bool is_good_hit(const SetUpRecord& set_up, std::uint32_t grazing) {
  return grazing + set_up.normal_error <= kMostPlaneError;
}

std::uint32_t t_error_exponent(const SetUpRecord& set_up, std::uint32_t grazing) {
  return kTErrorUnit + std::max(grazing + set_up.normal_error, set_up.distance_error);
}

}  // namespace raygate
