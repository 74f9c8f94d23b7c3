#include "host/light/clearance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "host/tree/box_query.h"

// Why c is a bound
//
// Let T have the vertices v_i, and let another triangle S be given. For any vector a let
// g_i = a.v_i - max a.y over the points y of S, which its vertices give. A point X = sum w_i v_i of
// T has a.X - a.y >= sum w_i g_i for every y of S. Where no g_i is negative, the plane between
// T and S keeps X at least sum w_i g_i / |a| >= w sum g_i / |a| away from S, w being the least
// weight. What counts as not negative may be below 0 by `slack`, for rounding, which margin() makes
// good. Whichever a is tried, the bound holds; those that are tried separate triangles which touch
// in an edge or in a corner.

namespace raygate {
namespace {

constexpr std::size_t kMostCrowd = 128;
constexpr double kShareOfHeight = 0.125;         // that c may be
constexpr double kShareOfCrowd = 0x1p-4;         // of that: what is nearer belongs to the crowd
constexpr double kNormalError = 10.0 * 0x1p-53;  // of a normal's and a point's dot product

/// The corners of the triangles of a leaf: of each corner and axis, less those of a point.
struct LeafCorners {
  DoubleQuad y[3][3];
  FloatQuad low[3], high[3];  // of the triangles' boxes

  RAYGATE_INLINE LeafCorners(const Bvh& bvh, const Bvh::Child& leaf, const glm::dvec3& from) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      FloatQuad corner[3];
      for (std::uint32_t v = 0; v < 3; ++v) {
        load_quad(bvh.corners_of(leaf) + std::size_t{3 * v + k} * leaf.count, corner[v]);
        y[v][k] = __builtin_convertvector(corner[v], DoubleQuad) - from[static_cast<int>(k)];
      }
      const FloatQuad least = corner[0] < corner[1] ? corner[0] : corner[1],
                      most = corner[0] > corner[1] ? corner[0] : corner[1];
      low[k] = least < corner[2] ? least : corner[2];
      high[k] = most > corner[2] ? most : corner[2];
    }
  }

  /// Bit i: the box of triangle i touches that box.
  [[nodiscard]] RAYGATE_INLINE LaneMask touching(const glm::vec3& from, const glm::vec3& to) const {
    IntQuad touches = IntQuad{} - 1;
    for (int k = 0; k < 3; ++k) touches &= (low[k] <= to[k]) & (high[k] >= from[k]);
    return sign_mask(touches);
  }
};

/// A triangle, the planes that its neighbours are likely to be behind, and what is known of them.
class Subject {
 public:
  Subject(std::uint32_t slot, const Corners& corners, double slack)
      : slot_(slot),
        corners_(corners),
        from_(corners[0]),
        reach_(departure_reach(corners)),
        slack_(slack) {
    for (int k = 0; k < 3; ++k) {
      vertex_[k] = glm::dvec3(corners[k]) - from_;
      low_[k] = float_below(std::min({corners[0][k], corners[1][k], corners[2][k]}) - reach_);
      high_[k] = float_above(std::max({corners[0][k], corners[1][k], corners[2][k]}) + reach_);
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
      edge_[k] =
          std::min(glm::dot(inward_[k], vertex_[k]), glm::dot(inward_[k], vertex_[(k + 1) % 3])) +
          slack_;
      inverse_height_[k] = length / area;
      longest = std::max(longest, length);
    }
    most_ = length_ = kShareOfHeight * area / longest;
    if (!(most_ > 4.0 * slack_)) length_ = 0.0;
  }

  /// Whether any c may come of it.
  [[nodiscard]] bool has_hope() const { return length_ > 0.0; }
  /// What coordinates are relative to.
  [[nodiscard]] const glm::dvec3& from() const { return from_; }
  /// What is outside this box does not matter.
  [[nodiscard]] const glm::vec3& low() const { return low_; }
  [[nodiscard]] const glm::vec3& high() const { return high_; }

  /// The other triangles of a leaf whose boxes are near: bit i for number i.
  [[nodiscard]] RAYGATE_INLINE LaneMask near(const LeafCorners& others,
                                             const Bvh::Child& leaf) const {
    if (!has_hope()) return 0;
    LaneMask mask = others.touching(low_, high_) & ((LaneMask{1} << leaf.count) - 1);
    if (slot_ - leaf.first < leaf.count) mask &= ~(LaneMask{1} << (slot_ - leaf.first));
    return mask;
  }

  /// The triangles of a leaf that are surely behind one of the planes through an edge, at right
  /// angles to the triangle: bit i for number i. They leave c as large as a height, but for slack.
  [[nodiscard]] RAYGATE_INLINE LaneMask behind_an_edge(const LeafCorners& leaf) const {
    LongQuad behind = {};
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3& axis = inward_[i];
      LongQuad all = LongQuad{} - 1;
      for (const DoubleQuad(&point)[3] : leaf.y) {
        all &= axis.x * point[0] + axis.y * point[1] + axis.z * point[2] <= edge_[i];
      }
      behind |= all;
    }
    return sign_mask(__builtin_convertvector(behind, IntQuad));
  }

  /// The triangles of a leaf from which this one is far enough, beyond one of the planes through
  /// an edge of theirs, at right angles to them.
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
      // Squares that neither overflow nor vanish.
      const DoubleQuad enough = length_ * length_ * squared;
      LongQuad all = (enough > 0x1p-900) & (enough < 0x1p900);
      for (const glm::dvec3& v : vertex_) {
        const DoubleQuad gap = axis[0] * v.x + axis[1] * v.y + axis[2] * v.z - highest;
        all &= gap >= -slack_ * size;
        sum += gap > 0.0 ? gap : DoubleQuad{};
      }
      beyond |= all & (sum * sum >= enough);
    }
    return sign_mask(__builtin_convertvector(beyond, IntQuad));
  }

  /// Takes another triangle into account that may not be behind an edge.
  void consider(std::uint32_t slot, const Corners& other) {
    const double apart = clearance(other);
    if (apart >= length_ || (lies_beyond(other, corners_, 1) && lies_beyond(other, corners_, -1))) {
      return;
    }
    if (apart < kShareOfCrowd * most_ && crowd_.size() < kMostCrowd) {
      crowd_.add(slot, other);
    } else {
      length_ = apart;
    }
  }

  /// All that has been found out.
  [[nodiscard]] Clearance found() const {
    Clearance result;
    if (!has_hope()) return result;
    const float length = float_below(length_ * (1.0 - 0x1p-20));  // for unit vectors' roundings
    result.length = crowd_.size() != 0 ? -length : length;
    int exponent;
    std::frexp(kNormalError * (normal_sizes_[0] + normal_sizes_[1] + normal_sizes_[2]), &exponent);
    for (int k = 0; k < 3; ++k) {
      result.normal[k] = std::ldexp(normal_[k], -exponent);
      result.corner[k] = corners_[0][k];
      result.gradient[0][k] = static_cast<float>(length * inverse_height_[2] * inward_[2][k]);
      result.gradient[1][k] = static_cast<float>(length * inverse_height_[0] * inward_[0][k]);
    }
    return result;
  }
  [[nodiscard]] Crowd& crowd() { return crowd_; }

 private:
  /// 0 where `v` is.
  static glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
  }

  /// c as far as `other` is concerned, or at least what it is already.
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

  /// The sum of the g_i; 0 where one is negative, infinite where they are all beyond reach.
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

  std::uint32_t slot_;
  const Corners& corners_;
  glm::dvec3 from_;
  double reach_, slack_;
  glm::vec3 low_, high_;
  glm::dvec3 vertex_[3], unit_normal_, inward_[3];
  double edge_[3], inverse_height_[3];
  double normal_[3], normal_sizes_[3];
  double most_, length_;  // c, at most and as it is found so far
  Crowd crowd_;
};

/// The largest magnitude of a coordinate in the tree.
float largest_coordinate(const Bvh& bvh) {
  float size = 0.0f;
  for (int i = 0; i < Bvh::kWidth; ++i) {
    const auto [low, high] = bvh.nodes()[0].box(i);
    if (low.x <= high.x) size = std::max({size, largest(low), largest(high)});
  }
  return size;
}

}  // namespace

bool lies_beyond(const Corners& other, const Corners& hit, int side) {
  return std::ranges::all_of(
      other, [&](const glm::vec3& vertex) { return plane_side(vertex, hit) != side; });
}

void Crowd::add(std::uint32_t slot, const Corners& triangle) {
  const auto lane = static_cast<int>(slots_.size() % kLanes);
  slots_.push_back(slot);
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

// A float's step is at most 2^-23 of it, or 2^-149.
double departure_reach(const Corners& corners) {
  const float size = std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  return std::max(0x1p-18 * size, 0x1p-144);
}

// A coordinate along a unit vector, of a difference of two points, is off by less than 2^-49 times
// their largest coordinate.
Clearances::Clearances(const Bvh& bvh)
    : bvh_(bvh),
      margin_(0x1p-45f * largest_coordinate(bvh)),
      slack_(0x1p-47 * largest_coordinate(bvh)),
      known_(std::make_unique<Known[]>(bvh.slot_count())) {}

const Clearance& Clearances::find(std::uint32_t slot) const {
  const Corners corners = bvh_.corners_of(slot);
  Subject subject(slot, corners, slack_);
  if (subject.has_hope()) {
    in_vectors([&](auto code) RAYGATE_BODY {
      const auto look = [&](const Bvh::Child& leaf) RAYGATE_BODY {
        const LeafCorners others(bvh_, leaf, subject.from());
        LaneMask rest = subject.near(others, leaf);
        if (rest != 0) rest &= ~subject.behind_an_edge(others);
        if (rest != 0) rest &= ~subject.beyond_their_edge(others);
        for (; rest != 0; rest &= rest - 1) {
          const std::uint32_t other =
              leaf.first + static_cast<std::uint32_t>(std::countr_zero(rest));
          subject.consider(other, bvh_.corners_of(other));
        }
      };
      for_leaves_near<code()>(bvh_, subject.low(), subject.high(), look);
    });
  }
  Known& known = known_[slot];
  const std::lock_guard lock(mutex_);
  const Clearance& found = clearances_.emplace_back(subject.found());
  if (found.length < 0.0f) {
    known.crowd.store(&crowds_.emplace_back(std::move(subject.crowd())), std::memory_order_relaxed);
  }
  known.clearance.store(&found, std::memory_order_release);
  return found;
}

}  // namespace raygate
