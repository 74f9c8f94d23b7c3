#include "host/light/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

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

constexpr std::size_t kMostLeaves = 4096;  // that a look may take
constexpr std::size_t kMostCrowd = 128;
constexpr double kFarthest = 0x1p-4;      // to look, in parts of the largest coordinate,
constexpr double kShareOfHeight = 0.125;  // and of the least height
constexpr double kShareOfCrowd = 0x1p-4;  // of that: what is nearer belongs to the crowd

using DoubleQuad = double __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));
using LongQuad = std::int64_t __attribute__((vector_size(8 * kQuad), aligned(8 * kQuad)));

/// A triangle and the planes that its neighbours are likely to be behind.
class Subject {
 public:
  Subject(const Corners& corners, double slack)
      : from_(corners[0]), normal_(unit(triangle_normal(corners))), slack_(slack) {
    for (int k = 0; k < 3; ++k) vertex_[k] = glm::dvec3(corners[k]) - from_;
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 edge = vertex_[(k + 1) % 3] - vertex_[k];
      inward_[k] = unit(glm::cross(normal_, edge));
      longest = std::max(longest, glm::length(edge));
    }
    height_ = glm::length(triangle_normal(corners)) / longest;
  }

  [[nodiscard]] double height() const { return height_; }

  /// The triangles of a leaf that are surely behind one of the planes through an edge, at right
  /// angles to the triangle: bit i for number i. They leave c as large as a height, but for slack.
  [[nodiscard]] RAYGATE_INLINE LaneMask behind_an_edge(const float* leaf,
                                                       std::uint32_t count) const {
    DoubleQuad y[3][3];
    for (std::uint32_t v = 0; v < 3; ++v) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        FloatQuad coordinate;
        load_quad(leaf + std::size_t{3 * v + k} * count, coordinate);
        y[v][k] = __builtin_convertvector(coordinate, DoubleQuad) - from_[static_cast<int>(k)];
      }
    }
    LongQuad behind = {};
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3& axis = inward_[i];
      const double edge =
          std::min(glm::dot(axis, vertex_[i]), glm::dot(axis, vertex_[(i + 1) % 3]));
      LongQuad all = LongQuad{} - 1;
      for (const DoubleQuad(&point)[3] : y) {
        all &= axis.x * point[0] + axis.y * point[1] + axis.z * point[2] <= edge + slack_;
      }
      behind |= all;
    }
    LaneMask mask = 0;
    for (std::uint32_t i = 0; i < count; ++i) mask |= static_cast<LaneMask>(behind[i] & 1) << i;
    return mask;
  }

  /// c as far as `other` is concerned, or at least `enough`.
  [[nodiscard]] double clearance(const Corners& other, double enough) const {
    glm::dvec3 y[3];
    for (int k = 0; k < 3; ++k) y[k] = glm::dvec3(other[k]) - from_;
    double best = 0.0;
    const auto try_axis = [&](const glm::dvec3& axis) {
      best = std::max(best, std::max(apart(axis, y), apart(-axis, y)));
      return best >= enough;
    };
    for (const glm::dvec3& axis : inward_) {
      best = std::max(best, apart(axis, y));
      if (best >= enough) return best;
    }
    if (try_axis(normal_)) return best;
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

 private:
  /// 0 where `v` is.
  static glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
  }

  /// The sum of the g_i; 0 where one is negative.
  [[nodiscard]] double apart(const glm::dvec3& axis, const glm::dvec3 (&y)[3]) const {
    const double highest =
        std::max({glm::dot(axis, y[0]), glm::dot(axis, y[1]), glm::dot(axis, y[2])});
    double sum = 0.0;
    for (const glm::dvec3& v : vertex_) {
      const double gap = glm::dot(axis, v) - highest;
      if (!(gap >= -slack_)) return 0.0;
      sum += std::max(gap, 0.0);
    }
    return sum;
  }

  glm::dvec3 from_;  // everything is relative to this
  glm::dvec3 vertex_[3], normal_, inward_[3];
  double height_, slack_;
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

LaneMask Crowd::near_of_eight(std::size_t first, const glm::vec3& point, float reach) const {
  const Boxes& boxes = boxes_[first / kLanes];
  const glm::vec3 from = point - reach, to = point + reach;
  IntLanes touches = IntLanes{} - 1;  // too little work for in_vectors
  for (int k = 0; k < 3; ++k) {
    FloatLanes low, high;
    load_lanes(boxes.low[k], low);
    load_lanes(boxes.high[k], high);
    touches &= (low <= to[k]) & (high >= from[k]);
  }
  return sign_mask(touches);
}

// A coordinate along a unit vector, of a difference of two points, is off by less than 2^-49 times
// their largest coordinate.
Clearances::Clearances(const Bvh& bvh)
    : bvh_(bvh),
      margin_(0x1p-45f * largest_coordinate(bvh)),
      slack_(0x1p-47 * largest_coordinate(bvh)),
      known_(std::make_unique<Known[]>(bvh.slot_count())) {}

Clearances::Clearance Clearances::find(std::uint32_t slot) const {
  Crowd crowd;
  const Lengths lengths = look(slot, crowd);
  const Crowd* kept = nullptr;
  if (crowd.size() != 0) {
    const std::lock_guard lock(mutex_);
    kept = &crowds_.emplace_back(std::move(crowd));
  }
  known_[slot].crowd.store(kept, std::memory_order_relaxed);
  known_[slot].lengths.store(lengths, std::memory_order_release);
  return {{lengths.behind, lengths.before}, kept};
}

Clearances::Lengths Clearances::look(std::uint32_t slot, Crowd& crowd) const {
  constexpr Lengths kUnknown = {0.0f, 0.0f};
  const Corners& corners = bvh_.corners_of(slot);
  const Subject subject(corners, slack_);
  const double size = std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  const double farthest = std::min(kShareOfHeight * subject.height(), kFarthest * size);
  if (!(farthest > 4.0 * slack_)) return kUnknown;
  const glm::dvec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
  const glm::dvec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
  glm::vec3 from, to;
  for (int k = 0; k < 3; ++k) {
    from[k] = float_below(low[k] - farthest);
    to[k] = float_above(high[k] + farthest);
  }
  std::vector<Bvh::Child> leaves;
  leaves_near(bvh_, from, to, leaves);
  if (leaves.size() > kMostLeaves) return kUnknown;
  double length[2] = {farthest, farthest};
  for (const Bvh::Child& leaf : leaves) {
    const LaneMask behind = in_vectors([&](auto) RAYGATE_BODY {
      return subject.behind_an_edge(bvh_.corners_of(leaf), leaf.count);
    });
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      const std::uint32_t other_slot = leaf.first + i;
      if ((behind >> i & 1) != 0 || other_slot == slot) continue;
      const Corners& other = bvh_.corners_of(other_slot);
      const double apart = subject.clearance(other, std::max(length[0], length[1]));
      bool crowds = false;
      for (const int side : {1, -1}) {
        double& least = length[side == 1 ? 0 : 1];
        if (apart >= least || lies_beyond(other, corners, side)) continue;
        if (apart < kShareOfCrowd * farthest && crowd.size() < kMostCrowd) {
          crowds = true;
        } else {
          least = apart;
        }
      }
      if (crowds) crowd.add(other_slot, other);
    }
  }
  for (double& each : length) each *= 1.0 - 0x1p-20;  // for the roundings of unit vectors
  return {float_below(length[0]), float_below(length[1])};
}

}  // namespace raygate
