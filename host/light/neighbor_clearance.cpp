#include "host/light/neighbor_clearance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "host/base/triple.h"
#include "host/bvh/traversal.h"

// Why c is a bound
//
// Let T have the vertices v_i, and let S be another triangle. For any vector a let g_i = a.v_i -
// max a.y over the points y of S; the maximum is at a vertex. A point X = sum w_i v_i of T has a.X
// - a.y >= sum w_i g_i for every y of S. If no g_i is negative, the plane between T and S keeps X
// at least sum w_i g_i / |a| >= w sum g_i / |a| away from S, where w is the least weight. g_i may
// be negative by up to `slack`, for rounding, which margin() compensates. The bound holds for every
// a. The vectors a that are tried separate triangles that touch in an edge or a corner.

namespace raygate {
namespace {

/// Computes the clearance of one triangle from the triangles passed to it.
class NeighborClearanceSearch {
 public:
  /// `slack` is the error bound of a computed coordinate along a unit vector.
  NeighborClearanceSearch(const Corners& corners, double slack)
      : corners_(corners), from_(corners[0]), reach_(spawn_reach(corners)), slack_(slack) {
    const auto grown = static_cast<float>(1.125 * reach_);  // more than rounding removes
    for (int k = 0; k < 3; ++k) {
      vertex_[k] = glm::dvec3(corners[k]) - from_;
      low_[k] = std::min({corners[0][k], corners[1][k], corners[2][k]}) - grown;
      high_[k] = std::max({corners[0][k], corners[1][k], corners[2][k]}) + grown;
    }
    const glm::dvec3 &b = vertex_[1], &c = vertex_[2];
    cross({b.x, b.y, b.z}, {c.x, c.y, c.z}, normal_, normal_sizes_);
    const glm::dvec3 normal(normal_[0], normal_[1], normal_[2]);
    const double area = glm::length(normal);
    const glm::dvec3 unit_normal = area > 0.0 ? normal / area : glm::dvec3(0.0);
    // The planes through the edges, perpendicular to the triangle or parallel to the coordinate
    // axis that is closest to the normal. Most neighbours are behind one of the latter.
    const glm::dvec3 sizes = glm::abs(normal);
    const int wider = sizes.x < sizes.y ? 1 : 0, along = sizes[wider] < sizes.z ? 2 : wider;
    glm::dvec3 parallel(0.0);
    parallel[along] = normal[along] < 0.0 ? -1.0 : 1.0;
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 edge = edge_[k] = vertex_[(k + 1) % 3] - vertex_[k];
      const double length = glm::length(edge);
      const glm::dvec3 inward = glm::cross(parallel, edge);
      const double size = glm::length(inward);
      axes_[k] = size > 0.0 ? inward / size : glm::dvec3(0.0);
      axes_[3 + k] = length > 0.0 ? glm::cross(unit_normal, edge) / length : glm::dvec3(0.0);
      inverse_height_[k] = length / area;
      longest = std::max(longest, length);
    }
    axes_[6] = unit_normal;
    axes_[7] = -unit_normal;
    most_ = length_ = kShareOfHeight * area / longest;
    if (!(most_ > 4.0 * slack_)) length_ = 0.0;
  }

  /// Returns whether a positive c is still possible.
  [[nodiscard]] bool is_possible() const { return length_ > 0.0; }
  /// Return the corners of the box outside which triangles are irrelevant.
  [[nodiscard]] const glm::vec3& low() const { return low_; }
  [[nodiscard]] const glm::vec3& high() const { return high_; }

  /// Updates c and the overlaps for the triangles of a leaf, except `primitive` itself.
  template <Vectors kCode>
  RAYGATE_INLINE void consider(const Bvh& bvh, const Bvh::Child& leaf, std::uint32_t primitive) {
    Bvh::LeafRoom room;
    const float* const corners = BvhView(bvh).corners_of(leaf, room);
    LaneMask rest = (LaneMask{1} << leaf.count) - 1;
    if (primitive - leaf.first < leaf.count) rest &= ~(LaneMask{1} << (primitive - leaf.first));
    if (rest == 0 || !is_possible()) return;
    double apart[kQuad];
    store(apart, clearances<kCode>(corners, leaf.count, rest));
    for (; rest != 0; rest &= rest - 1) {
      const int i = std::countr_zero(rest);
      if (apart[i] >= length_) continue;
      const std::uint32_t other = leaf.first + static_cast<std::uint32_t>(i);
      const Corners others = bvh.corners_of(other);
      if (lies_beyond(others, corners_, 1) && lies_beyond(others, corners_, -1)) continue;
      if (apart[i] < kShareOfOverlaps * most_ && overlaps_.size() < kMaxOverlaps) {
        overlaps_.add(other, others);
      } else {
        length_ = apart[i];
      }
    }
  }

  /// Returns the clearance with respect to all triangles so far.
  [[nodiscard]] NeighborClearance found() const {
    NeighborClearance result;
    if (!is_possible()) return result;
    // Accounts for rounding of unit vectors.
    const float length = float_below(length_ * (1.0 - 0x1p-20));
    result.length = overlaps_.size() != 0 ? -length : length;
    int exponent;
    std::frexp(kNormalError * (normal_sizes_[0] + normal_sizes_[1] + normal_sizes_[2]), &exponent);
    const double scale = std::ldexp(1.0, -exponent);
    for (int k = 0; k < 3; ++k) {
      result.normal[k] = scale * normal_[k];
      result.corner[k] = corners_[0][k];
      result.gradient[0][k] = static_cast<float>(length * inverse_height_[2] * axes_[5][k]);
      result.gradient[1][k] = static_cast<float>(length * inverse_height_[0] * axes_[3][k]);
    }
    return result;
  }
  [[nodiscard]] Overlaps& overlaps() { return overlaps_; }

 private:
  using Vectors3 = Triple<DoubleQuad>;

  static constexpr std::size_t kMaxOverlaps = 128;
  static constexpr double kShareOfHeight = 0.125;  // largest c, as a fraction of the height
  // Triangles nearer than this fraction of the largest c are overlaps.
  static constexpr double kShareOfOverlaps = 0x1p-4;
  // Of the dot product of a normal and a point.
  static constexpr double kNormalError = 10.0 * 0x1p-53;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  static RAYGATE_INLINE Vectors3 vectors(const glm::dvec3& v) {
    return {spread<DoubleQuad>(v.x), spread<DoubleQuad>(v.y), spread<DoubleQuad>(v.z)};
  }
  static RAYGATE_INLINE Vectors3 product(const Vectors3& a, const Vectors3& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
  }
  /// Returns unit vectors, or 0 for 0.
  static RAYGATE_INLINE Vectors3 unit(const Vectors3& v) {
    const DoubleQuad size = root(dot(v, v));
    return choose(size > 0.0, Vectors3{v.x / size, v.y / size, v.z / size}, zero<DoubleQuad>());
  }

  /// Returns c for each of the triangles in the mask alone, or any value of at least length_.
  template <Vectors kCode>
  [[nodiscard]] RAYGATE_INLINE DoubleQuad clearances(const float* corners, std::uint32_t count,
                                                     LaneMask mask) const {
    DoubleQuad coordinates[3][3];  // relative to from_
    constexpr IntQuad kBit = {1, 2, 4, 8};
    IntQuad near = ((IntQuad{} + static_cast<std::int32_t>(mask)) & kBit) != 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      FloatQuad corner[3];
      for (std::uint32_t v = 0; v < 3; ++v) {
        corner[v] = load<FloatQuad>(corners + std::size_t{3 * v + k} * count);
        coordinates[v][k] = widen<kCode>(corner[v]) - from_[static_cast<int>(k)];
      }
      near &= (minimum(minimum(corner[0], corner[1]), corner[2]) <= high_[static_cast<int>(k)]) &
              (maximum(maximum(corner[0], corner[1]), corner[2]) >= low_[static_cast<int>(k)]);
    }
    Vectors3 y[3];
    for (int v = 0; v < 3; ++v) y[v] = {coordinates[v][0], coordinates[v][1], coordinates[v][2]};
    DoubleQuad best = choose(near, DoubleQuad{}, spread<DoubleQuad>(kInfinity));
    // Returns whether all values are sufficient.
    const auto try_axis = [&](const Vectors3& axis) RAYGATE_BODY {
      best = maximum(best, apart(axis, y));
      return sign_mask(whole(best >= length_)) == (LaneMask{1} << kQuad) - 1;
    };
    for (const glm::dvec3& axis : axes_) {
      if (try_axis(vectors(axis))) return best;
    }
    const Vectors3 normal = unit(product(y[1] - y[0], y[2] - y[0]));
    if (try_axis(normal) || try_axis(-normal)) return best;
    for (int j = 0; j < 3; ++j) {
      const Vectors3 edge = y[(j + 1) % 3] - y[j];
      for (int k = -1; k < 3; ++k) {
        const Vectors3 axis =
            unit(k < 0 ? product(normal, edge) : product(edge, vectors(edge_[k])));
        if (try_axis(axis) || try_axis(-axis)) return best;
      }
    }
    return best;
  }

  /// Returns the sum of the g_i: 0 if one is negative, infinite if all exceed reach_.
  [[nodiscard]] RAYGATE_INLINE DoubleQuad apart(const Vectors3& axis,
                                                const Vectors3 (&y)[3]) const {
    const DoubleQuad highest = maximum(maximum(dot(axis, y[0]), dot(axis, y[1])), dot(axis, y[2]));
    DoubleQuad sum = {}, least = spread<DoubleQuad>(kInfinity);
    LongQuad is_apart = LongQuad{} - 1;
    for (const glm::dvec3& v : vertex_) {
      const DoubleQuad gap = dot(axis, vectors(v)) - highest;
      is_apart &= gap >= -slack_;
      sum += maximum(gap, DoubleQuad{});
      least = minimum(least, gap);
    }
    sum = choose(least >= reach_, spread<DoubleQuad>(kInfinity), sum);
    return choose(is_apart, sum, DoubleQuad{});
  }

  const Corners& corners_;
  glm::dvec3 from_;  // origin of relative coordinates
  double reach_, slack_;
  glm::vec3 low_, high_;
  glm::dvec3 vertex_[3], edge_[3];
  // Axes that do not depend on the other triangle: perpendicular to an edge and in a coordinate
  // plane; perpendicular to an edge and in the triangle's plane; the normal, both ways.
  glm::dvec3 axes_[8];
  double inverse_height_[3];
  double normal_[3], normal_sizes_[3];
  double most_, length_;  // largest possible c, and c so far
  Overlaps overlaps_;
};

float largest_coordinate(const Bvh& bvh) {
  float size = 0.0f;
  for (int i = 0; i < Bvh::kWidth; ++i) {
    const auto [low, high] = bvh.nodes()[0].box(i);
    if (low.x <= high.x) size = std::max({size, largest(low), largest(high)});
  }
  return size;
}

}  // namespace

void Overlaps::add(std::uint32_t primitive, const Corners& triangle) {
  const auto lane = static_cast<int>(primitives_.size() % kLanes);
  primitives_.push_back(primitive);
  if (lane == 0) {
    Boxes& empty = boxes_.emplace_back();
    for (int k = 0; k < 3; ++k) {
      std::ranges::fill(empty.low[k], std::numeric_limits<float>::infinity());
      std::ranges::fill(empty.high[k], -std::numeric_limits<float>::infinity());
    }
  }
  for (int k = 0; k < 3; ++k) {
    boxes_.back().low[k][lane] = std::min({triangle[0][k], triangle[1][k], triangle[2][k]});
    boxes_.back().high[k][lane] = std::max({triangle[0][k], triangle[1][k], triangle[2][k]});
  }
}

bool lies_beyond(const Corners& other, const Corners& hit, int side) {
  return std::ranges::all_of(
      other, [&](const glm::vec3& vertex) { return orient3d(vertex, hit) != side; });
}

// A float step is at most 2^-23 of the value, or 2^-149.
double spawn_reach(const Corners& corners) {
  const float size = std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  return std::max(0x1p-18 * size, 0x1p-144);
}

// The error of a coordinate along a unit vector, of a difference of two points, is less than 2^-49
// times their largest coordinate.
NeighborClearances::NeighborClearances(const Bvh& bvh)
    : bvh_(bvh),
      margin_(0x1p-45f * largest_coordinate(bvh)),
      slack_(0x1p-47 * largest_coordinate(bvh)),
      known_(std::make_unique<Known[]>(bvh.primitive_count())) {}

NeighborClearances::Found NeighborClearances::compute(std::uint32_t primitive) const {
  const Corners corners = bvh_.corners_of(primitive);
  NeighborClearanceSearch search(corners, slack_);
  if (search.is_possible()) {
    in_vectors([&](auto code) RAYGATE_BODY {
      const auto visit = [&](const Bvh::Child& leaf) RAYGATE_BODY {
        search.consider<code()>(bvh_, leaf, primitive);
        return false;
      };
      (void)any_leaf_near<code()>(bvh_, search.low(), search.high(), visit);
    });
  }
  return {search.found(), std::move(search.overlaps())};
}

const NeighborClearance& NeighborClearances::find(std::uint32_t primitive) const {
  Found computed = compute(primitive);
  Known& known = known_[primitive];
  const std::lock_guard lock(mutex_);
  const NeighborClearance& found = clearances_.emplace_back(computed.clearance);
  if (found.length < 0.0f) {
    known.overlaps.store(&overlaps_.emplace_back(std::move(computed.overlaps)),
                         std::memory_order_relaxed);
  }
  known.clearance.store(&found, std::memory_order_release);
  return found;
}

}  // namespace raygate
