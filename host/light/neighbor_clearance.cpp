#include "host/light/neighbor_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/bvh/closest_point.h"

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

/// Corner coordinates of the triangles of a leaf, relative to `from`.
struct LeafCorners {
  DoubleQuad y[3][3];
  FloatQuad low[3], high[3];  // boxes of the triangles

  template <Vectors kCode>
  RAYGATE_INLINE LeafCorners(VectorCode<kCode>, const float* leaf_corners, std::uint32_t count,
                             const glm::dvec3& from) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      FloatQuad corner[3];
      for (std::uint32_t v = 0; v < 3; ++v) {
        corner[v] = load<FloatQuad>(leaf_corners + std::size_t{3 * v + k} * count);
        y[v][k] = widen<kCode>(corner[v]);
        y[v][k] -= from[static_cast<int>(k)];
      }
      low[k] = minimum(minimum(corner[0], corner[1]), corner[2]);
      high[k] = maximum(maximum(corner[0], corner[1]), corner[2]);
    }
  }

  /// Returns the triangles whose boxes touch a box: bit i for triangle i.
  [[nodiscard]] RAYGATE_INLINE LaneMask touching(const glm::vec3& from, const glm::vec3& to) const {
    IntQuad touches = IntQuad{} - 1;
    for (int k = 0; k < 3; ++k) touches &= (low[k] <= to[k]) & (high[k] >= from[k]);
    return sign_mask(touches);
  }
};

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
    unit_normal_ = unit(normal);
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 edge = vertex_[(k + 1) % 3] - vertex_[k];
      const double length = glm::length(edge);
      inward_[k] = length > 0.0 ? glm::cross(unit_normal_, edge) / length : glm::dvec3(0.0);
      inverse_height_[k] = length / area;
      longest = std::max(longest, length);
    }
    const int along = axis_of(normal);
    for (int k = 0; k < 2; ++k) across_[k] = static_cast<std::uint32_t>((along + 1 + k) % 3);
    for (int k = 0; k < 3; ++k) {
      const auto place = [&](int vertex, int axis) {
        return double(corners[vertex % 3][static_cast<int>(across_[axis])]);
      };
      const double x = place(k + 1, 0) - place(k, 0), y = place(k + 1, 1) - place(k, 1);
      const double scale = (normal[along] < 0.0 ? -1.0 : 1.0) / std::sqrt(x * x + y * y);
      Edge& edge = edges_[k];
      edge.inward[0] = -scale * y;
      edge.inward[1] = scale * x;
      edge.most = edge.inward[0] * place(k, 0) + edge.inward[1] * place(k, 1) + slack_;
    }
    most_ = length_ = kShareOfHeight * area / longest;
    if (!(most_ > 4.0 * slack_)) length_ = 0.0;
  }

  /// Returns whether a positive c is still possible.
  [[nodiscard]] bool has_hope() const { return length_ > 0.0; }
  /// Returns the origin of relative coordinates.
  [[nodiscard]] const glm::dvec3& from() const { return from_; }
  /// Return the corners of the box outside which triangles are irrelevant.
  [[nodiscard]] const glm::vec3& low() const { return low_; }
  [[nodiscard]] const glm::vec3& high() const { return high_; }

  /// Returns the triangles of a leaf whose boxes are near: bit i for triangle i.
  [[nodiscard]] RAYGATE_INLINE LaneMask near(const LeafCorners& others) const {
    return has_hope() ? others.touching(low_, high_) : 0;
  }

  /// Returns the triangles of a leaf (bit i for triangle i) that are surely behind a plane through
  /// an edge and parallel to the axis closest to the normal. Projected along that axis, heights
  /// shrink by less than a factor of sqrt(3), so such triangles do not reduce c, up to slack.
  template <Vectors kCode>
  [[nodiscard]] RAYGATE_INLINE LaneMask behind_an_edge(const float* leaf,
                                                       std::uint32_t count) const {
    DoubleQuad y[3][2];
    for (std::uint32_t v = 0; v < 3; ++v) {
      for (std::uint32_t k = 0; k < 2; ++k) {
        y[v][k] = widen<kCode>(load<FloatQuad>(leaf + std::size_t{3 * v + across_[k]} * count));
      }
    }
    LongQuad behind = {};
    for (const Edge& edge : edges_) {
      LongQuad all = LongQuad{} - 1;
      for (const DoubleQuad(&point)[2] : y) {
        all &= edge.inward[0] * point[0] + edge.inward[1] * point[1] <= edge.most;
      }
      behind |= all;
    }
    return sign_mask(whole(behind));
  }

  /// Returns the triangles of a leaf from which this triangle is far enough: it is beyond a plane
  /// through one of their edges, perpendicular to them.
  [[nodiscard]] RAYGATE_INLINE LaneMask beyond_their_edge(const LeafCorners& leaf) const {
    DoubleQuad to_b[3], to_c[3], normal[3], sizes[3];
    for (int k = 0; k < 3; ++k) {
      to_b[k] = leaf.y[1][k] - leaf.y[0][k];
      to_c[k] = leaf.y[2][k] - leaf.y[0][k];
    }
    cross(to_b, to_c, normal, sizes);
    LongQuad beyond = {};
    for (int j = 0; j < 3; ++j) {
      DoubleQuad edge[3], axis[3], along, highest, sum = {}, squared = {}, size = {};
      for (int k = 0; k < 3; ++k) edge[k] = leaf.y[(j + 1) % 3][k] - leaf.y[j][k];
      cross(edge, normal, axis, sizes);
      for (int k = 0; k < 3; ++k) {
        squared += axis[k] * axis[k];
        size = size < axis[k] ? axis[k] : size;
        size = size < -axis[k] ? -axis[k] : size;
      }
      for (int v = 0; v < 3; ++v) {
        along = axis[0] * leaf.y[v][0] + axis[1] * leaf.y[v][1] + axis[2] * leaf.y[v][2];
        highest = v == 0 || highest < along ? along : highest;
      }
      // Squares must neither overflow nor underflow.
      const DoubleQuad enough = length_ * length_ * squared;
      LongQuad all = (enough > 0x1p-900) & (enough < 0x1p900);
      for (const glm::dvec3& v : vertex_) {
        const DoubleQuad gap = axis[0] * v.x + axis[1] * v.y + axis[2] * v.z - highest;
        all &= gap >= -slack_ * size;
        sum += gap > 0.0 ? gap : DoubleQuad{};
      }
      beyond |= all & (sum * sum >= enough);
    }
    return sign_mask(whole(beyond));
  }

  /// Updates c and the overlaps for a triangle that may not be behind an edge.
  void consider(std::uint32_t primitive, const Corners& other) {
    const double apart = clearance(other);
    if (apart >= length_ || (lies_beyond(other, corners_, 1) && lies_beyond(other, corners_, -1))) {
      return;
    }
    if (apart < kShareOfOverlaps * most_ && overlaps_.size() < kMaxOverlaps) {
      overlaps_.add(primitive, other);
    } else {
      length_ = apart;
    }
  }

  /// Returns the clearance with respect to all triangles so far.
  [[nodiscard]] NeighborClearance found() const {
    NeighborClearance result;
    if (!has_hope()) return result;
    // Accounts for rounding of unit vectors.
    const float length = float_below(length_ * (1.0 - 0x1p-20));
    result.length = overlaps_.size() != 0 ? -length : length;
    int exponent;
    std::frexp(kNormalError * (normal_sizes_[0] + normal_sizes_[1] + normal_sizes_[2]), &exponent);
    const double scale = std::ldexp(1.0, -exponent);
    for (int k = 0; k < 3; ++k) {
      result.normal[k] = scale * normal_[k];
      result.corner[k] = corners_[0][k];
      result.gradient[0][k] = static_cast<float>(length * inverse_height_[2] * inward_[2][k]);
      result.gradient[1][k] = static_cast<float>(length * inverse_height_[0] * inward_[0][k]);
    }
    return result;
  }
  [[nodiscard]] Overlaps& overlaps() { return overlaps_; }

 private:
  static constexpr std::size_t kMaxOverlaps = 128;
  static constexpr double kShareOfHeight = 0.125;  // largest c, as a fraction of the height
  // Triangles nearer than this fraction of the largest c are overlaps.
  static constexpr double kShareOfOverlaps = 0x1p-4;
  // Of the dot product of a normal and a point.
  static constexpr double kNormalError = 10.0 * 0x1p-53;

  /// Returns the axis of the largest magnitude.
  static int axis_of(const glm::dvec3& v) {
    const glm::dvec3 sizes = glm::abs(v);
    const int axis = sizes.x < sizes.y ? 1 : 0;
    return sizes[axis] < sizes.z ? 2 : axis;
  }
  /// Returns the unit vector in the direction of `v`, or 0 if `v` is 0.
  static glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
  }

  /// Returns c for `other` alone, or a value of at least length_.
  [[nodiscard]] double clearance(const Corners& other) const {
    glm::dvec3 y[3];
    for (int k = 0; k < 3; ++k) y[k] = glm::dvec3(other[k]) - from_;
    double best = 0.0;
    const auto try_axis = [&](const glm::dvec3& axis) {
      best = std::max(best, std::max(apart(axis, y), apart(-axis, y)));
      return best >= length_;
    };
    for (const glm::dvec3& axis : inward_) {
      best = std::max(best, apart(axis, y));
      if (best >= length_) return best;
    }
    if (try_axis(unit_normal_)) return best;
    const glm::dvec3 other_normal = unit(triangle_normal(other));
    if (try_axis(other_normal)) return best;
    for (int j = 0; j < 3; ++j) {
      const glm::dvec3 edge = y[(j + 1) % 3] - y[j];
      if (try_axis(unit(glm::cross(other_normal, edge)))) return best;
      for (int k = 0; k < 3; ++k) {
        if (try_axis(unit(glm::cross(edge, vertex_[(k + 1) % 3] - vertex_[k])))) return best;
      }
    }
    return best;
  }

  /// Returns the sum of the g_i: 0 if one is negative, infinite if all exceed reach_.
  [[nodiscard]] double apart(const glm::dvec3& axis, const glm::dvec3 (&y)[3]) const {
    const double highest =
        std::max({glm::dot(axis, y[0]), glm::dot(axis, y[1]), glm::dot(axis, y[2])});
    double sum = 0.0, least = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& v : vertex_) {
      const double gap = glm::dot(axis, v) - highest;
      if (!(gap >= -slack_)) return 0.0;
      sum += std::max(gap, 0.0);
      least = std::min(least, gap);
    }
    return least >= reach_ ? std::numeric_limits<double>::infinity() : sum;
  }

  const Corners& corners_;
  glm::dvec3 from_;
  double reach_, slack_;
  glm::vec3 low_, high_;
  glm::dvec3 vertex_[3], unit_normal_, inward_[3];
  /// An edge, projected along the axis closest to the normal.
  struct Edge {
    double inward[2];  // unit vector
    double most;       // largest coordinate along `inward` that is behind the edge
  };
  Edge edges_[3];
  std::uint32_t across_[2];  // the two axes of the projection
  double inverse_height_[3];
  double normal_[3], normal_sizes_[3];
  double most_, length_;  // largest possible c, and c so far
  Overlaps overlaps_;
};

/// Updates the search for `primitive` with the triangles of a leaf, except `primitive` itself.
template <Vectors kCode>
RAYGATE_INLINE void take_in(const Bvh& bvh, const Bvh::Child& leaf, std::uint32_t primitive,
                            NeighborClearanceSearch& search) {
  LaneMask rest = (LaneMask{1} << leaf.count) - 1;
  Bvh::LeafRoom room;
  const float* const corners = BvhView(bvh).corners_of(leaf, room);
  rest &= ~search.behind_an_edge<kCode>(corners, leaf.count);
  if (primitive - leaf.first < leaf.count) rest &= ~(LaneMask{1} << (primitive - leaf.first));
  if (rest == 0) return;
  const LeafCorners others(VectorCode<kCode>{}, corners, leaf.count, search.from());
  rest &= search.near(others);
  if (rest != 0) rest &= ~search.beyond_their_edge(others);
  for (; rest != 0; rest &= rest - 1) {
    const std::uint32_t other = leaf.first + static_cast<std::uint32_t>(std::countr_zero(rest));
    search.consider(other, bvh.corners_of(other));
  }
}

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

NeighborClearances::Found NeighborClearances::look(std::uint32_t primitive) const {
  const Corners corners = bvh_.corners_of(primitive);
  NeighborClearanceSearch search(corners, slack_);
  if (search.has_hope()) {
    in_vectors([&](auto code) RAYGATE_BODY {
      // Leaves are processed some time after they are found, when they are in the cache.
      constexpr std::size_t kMostWaiting = 16;
      Bvh::Child waiting[kMostWaiting];
      std::size_t count = 0;
      const auto look = [&]() RAYGATE_BODY {
        for (std::size_t i = 0; i < count; ++i)
          take_in<code()>(bvh_, waiting[i], primitive, search);
        count = 0;
      };
      const auto found = [&](const Bvh::Child& leaf) RAYGATE_BODY {
        if (count == kMostWaiting) look();
        waiting[count++] = leaf;
        return false;
      };
      (void)any_leaf_near<code()>(bvh_, search.low(), search.high(), found);
      look();
    });
  }
  return {search.found(), std::move(search.overlaps())};
}

const NeighborClearance& NeighborClearances::find(std::uint32_t primitive) const {
  Found looked = look(primitive);
  Known& known = known_[primitive];
  const std::lock_guard lock(mutex_);
  const NeighborClearance& found = clearances_.emplace_back(looked.clearance);
  if (found.length < 0.0f) {
    known.overlaps.store(&overlaps_.emplace_back(std::move(looked.overlaps)),
                         std::memory_order_relaxed);
  }
  known.clearance.store(&found, std::memory_order_release);
  return found;
}

}  // namespace raygate
