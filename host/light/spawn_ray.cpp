#include "host/light/spawn_ray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "host/base/triple.h"
#include "host/bvh/closest_point.h"

// Why c is a bound
//
// c w is a lower bound of the distance from a point X of a triangle T to another triangle S.
//   1. Let v_i be T's vertices, w_i the barycentric coordinates of X, and w the least w_i. So
//      X = sum w_i v_i.
//   2. For a vector a, let g_i = a.v_i - max a.y over all points y of S. A vertex has the maximum.
//   3. Every point y of S has a.X - a.y >= sum w_i g_i. So if no g_i is negative, the distance from
//      X to y is at least sum w_i g_i / |a| >= w sum g_i / |a|.
//   4. Hence c = sum g_i / |a| is valid for every such a. The largest c of several a is used. The a
//      that are tried separate triangles that touch in an edge or a corner.
//   5. Rounding may make a g_i negative by up to `slack`. margin() compensates for this error.

namespace raygate {
namespace {

/// Computes the clearance of one triangle from the triangles passed to it.
class NeighborClearanceSearch {
 public:
  /// `slack` is the error bound of a computed coordinate along a unit vector.
  NeighborClearanceSearch(const Corners& corners, double slack)
      : corners_(corners), from_(corners[0]), reach_(spawn_reach(corners)), slack_(slack) {
    const auto grown = static_cast<float>(1.125 * reach_);  // more than rounding removes
    low = glm::vec3(glm::min(glm::min(corners[0], corners[1]), corners[2])) - grown;
    high = glm::vec3(glm::max(glm::max(corners[0], corners[1]), corners[2])) + grown;
    for (int k = 0; k < 3; ++k) vertex_[k] = corners[k] - from_;
    normal_ = cross(vertex_[1], vertex_[2], normal_sizes_);
    const double area = glm::length(normal_);
    const glm::dvec3 unit_normal = area > 0.0 ? normal_ / area : glm::dvec3(0.0);
    // Normals of planes through the edges that are parallel to the coordinate axis closest to the
    // normal (0 to 2; most neighbours are behind one of these planes) or to the normal (3 to 5).
    const glm::dvec3 sizes = glm::abs(normal_);
    const int wider = sizes.x < sizes.y ? 1 : 0, along = sizes[wider] < sizes.z ? 2 : wider;
    glm::dvec3 parallel(0.0);
    parallel[along] = normal_[along] < 0.0 ? -1.0 : 1.0;
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

  /// Updates c and the overlaps for the triangles of a leaf, except `primitive` itself.
  template <Vectors kCode>
  RAYGATE_INLINE void consider(const Bvh& bvh, const Bvh::Child& leaf, std::uint32_t primitive) {
    Bvh::LeafRoom room;
    const float* const corners = BvhView(bvh).corners_of(leaf, room);
    LaneMask rest = (LaneMask{1} << leaf.count) - 1;
    if (primitive - leaf.first < leaf.count) rest &= ~(LaneMask{1} << (primitive - leaf.first));
    if (rest == 0 || !is_possible()) return;
    if (++leaves_ > kMostLeaves) length_ = 0.0;
    Corners exact[kQuad];
    if (!bvh.is_binary32()) {
      for (std::uint32_t i = 0; i < leaf.count; ++i) exact[i] = bvh.corners_of(leaf.first + i);
    }
    double apart[kQuad];
    store(apart, clearances<kCode>(corners, bvh.is_binary32() ? nullptr : exact, leaf.count, rest));
    for (const int i : SetBits(rest)) {
      if (apart[i] >= length_) continue;
      const std::uint32_t other = leaf.first + static_cast<std::uint32_t>(i);
      const Corners others = bvh.corners_of(other);
      if (lies_beyond(others, corners_, 1) && lies_beyond(others, corners_, -1)) continue;
      if (apart[i] < kShareOfOverlaps * most_ && overlaps.size() < kMaxOverlaps) {
        Overlap& overlap = overlaps.emplace_back();
        overlap.primitive = other;
        for (int k = 0; k < 3; ++k) {
          overlap.low[k] = float_below(std::min({others[0][k], others[1][k], others[2][k]}));
          overlap.high[k] = float_above(std::max({others[0][k], others[1][k], others[2][k]}));
        }
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
    result.length = overlaps.empty() ? length : -length;
    int exponent;
    std::frexp(kNormalError * (normal_sizes_.x + normal_sizes_.y + normal_sizes_.z), &exponent);
    const double scale = std::ldexp(1.0, -exponent);
    for (int k = 0; k < 3; ++k) {
      result.normal[k] = scale * normal_[k];
      result.corner[k] = static_cast<float>(corners_[0][k]);
      result.gradient[0][k] = static_cast<float>(length * inverse_height_[2] * axes_[5][k]);
      result.gradient[1][k] = static_cast<float>(length * inverse_height_[0] * axes_[3][k]);
    }
    return result;
  }

  glm::vec3 low, high;  ///< the box outside which triangles are irrelevant
  Overlaps overlaps;    ///< among the triangles so far

 private:
  using Vectors3 = Triple<DoubleQuad>;

  static constexpr std::size_t kMaxOverlaps = 128;
  // Limits the time: in a fan of 100,000 triangles, each has as many neighbours. With more leaves,
  // c is 0 (unknown), and RaySpawner::search() finds origins.
  static constexpr int kMostLeaves = 1024;
  static constexpr double kShareOfHeight = 0.125;  // largest c, as a fraction of the height
  // Triangles nearer than this fraction of the largest c are overlaps.
  static constexpr double kShareOfOverlaps = 0x1p-4;
  // Relative error bound of the dot product of a normal and a point.
  static constexpr double kNormalError = 10.0 * 0x1p-53;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// Returns unit vectors, or 0 for 0.
  static RAYGATE_INLINE Vectors3 unit(const Vectors3& v) {
    const DoubleQuad size = root(dot(v, v));
    return choose(size > 0.0, Vectors3{v.x / size, v.y / size, v.z / size}, zero<DoubleQuad>());
  }

  /// Returns, for each triangle in `mask`, the largest c found with respect to it alone; stops when
  /// all are at least length_. `exact`: the triangles' corners if `corners` are rounded, or null.
  template <Vectors kCode>
  [[nodiscard]] RAYGATE_INLINE DoubleQuad clearances(const float* corners, const Corners* exact,
                                                     std::uint32_t count, LaneMask mask) const {
    FloatQuad corner[3][3];
    constexpr IntQuad kBit = {1, 2, 4, 8};
    IntQuad near = ((IntQuad{} + static_cast<std::int32_t>(mask)) & kBit) != 0;
    for (int k = 0; k < 3; ++k) {
      for (int v = 0; v < 3; ++v) {
        corner[v][k] = load<FloatQuad>(corners + std::size_t(3 * v + k) * count);
      }
      near &= (minimum(minimum(corner[0][k], corner[1][k]), corner[2][k]) <= high[k]) &
              (maximum(maximum(corner[0][k], corner[1][k]), corner[2][k]) >= low[k]);
    }
    if (sign_mask(near) == 0) return spread<DoubleQuad>(kInfinity);
    DoubleQuad coordinates[3][3];  // relative to from_
    for (int k = 0; k < 3; ++k) {
      for (int v = 0; v < 3; ++v) {
        DoubleQuad coordinate = widen<kCode>(corner[v][k]);
        if (exact != nullptr) [[unlikely]] {
          for (int i = 0; i < kQuad; ++i) coordinate[i] = exact[i][v][k];
        }
        coordinates[v][k] = coordinate - from_[k];
      }
    }
    Vectors3 y[3];
    for (int v = 0; v < 3; ++v) y[v] = {coordinates[v][0], coordinates[v][1], coordinates[v][2]};
    DoubleQuad best = choose(near, DoubleQuad{}, spread<DoubleQuad>(kInfinity));
    // Tries an axis, and returns whether all values of c reach length_.
    const auto try_axis = [&](const Vectors3& axis) RAYGATE_BODY {
      best = maximum(best, apart(axis, y));
      return sign_mask(whole(best >= length_)) == (LaneMask{1} << kQuad) - 1;
    };
    for (const glm::dvec3& axis : axes_) {
      if (try_axis(spread<DoubleQuad>(axis))) return best;
    }
    const Vectors3 normal = unit(cross(y[1] - y[0], y[2] - y[0]));
    if (try_axis(normal) || try_axis(-normal)) return best;
    for (int j = 0; j < 3; ++j) {
      const Vectors3 edge = y[(j + 1) % 3] - y[j];
      for (int k = -1; k < 3; ++k) {
        const Vectors3 axis =
            unit(k < 0 ? cross(normal, edge) : cross(edge, spread<DoubleQuad>(edge_[k])));
        if (try_axis(axis) || try_axis(-axis)) return best;
      }
    }
    return best;
  }

  /// Returns the sum of the gaps g_i along `axis` (step 2 of "Why c is a bound"): 0 if a g_i is
  /// below -slack_, infinity if all are at least reach_.
  [[nodiscard]] RAYGATE_INLINE DoubleQuad apart(const Vectors3& axis,
                                                const Vectors3 (&y)[3]) const {
    const DoubleQuad highest = maximum(maximum(dot(axis, y[0]), dot(axis, y[1])), dot(axis, y[2]));
    DoubleQuad sum = {}, least = spread<DoubleQuad>(kInfinity);
    LongQuad is_apart = LongQuad{} - 1;
    for (const glm::dvec3& v : vertex_) {
      const DoubleQuad gap = dot(axis, spread<DoubleQuad>(v)) - highest;
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
  glm::dvec3 vertex_[3], edge_[3];
  // Axes that do not depend on the other triangle: perpendicular to an edge and in a coordinate
  // plane; perpendicular to an edge and in the triangle's plane; the normal, both ways.
  glm::dvec3 axes_[8];
  double inverse_height_[3];
  glm::dvec3 normal_, normal_sizes_;
  double most_, length_;  // largest possible c, and c so far
  int leaves_ = 0;        // number of leaves considered
};

float largest_coordinate(const Bvh& bvh) {
  const auto [low, high] = bvh.nodes()[0].box();
  return low.x <= high.x ? std::max(largest(low), largest(high)) : 0.0f;
}

}  // namespace

bool lies_beyond(const Corners& other, const Corners& hit, int side) {
  return std::ranges::all_of(
      other, [&](const glm::dvec3& vertex) { return orient3d(vertex, hit) != side; });
}

// A float step is at most 2^-23 of the value, or 2^-149, so the result is at least 32 steps.
double spawn_reach(const Corners& corners) {
  const double size = std::max({largest(corners[0]), largest(corners[1]), largest(corners[2])});
  return std::max(0x1p-18 * size, 0x1p-144);
}

// The coordinate of a difference of two points along a unit vector has an error below 2^-49 times
// the points' largest coordinate. slack_ is 4 times this bound, margin_ 16 times.
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
        return !search.is_possible();
      };
      (void)any_leaf_near<code()>(bvh_, search.low, search.high, visit);
    });
  }
  return {search.found(), std::move(search.overlaps)};
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

// How far O' is from X
//
// Candidate k for O' is the float point nearest to X + 2^k u m. u is one float step of the largest
// coordinate of X. m is the triangle's normal on the wanted side, scaled so that its largest
// component is 1. (search() also tries the ray's direction for m.) Let n be the unit normal, |n|_1
// the sum and |n|_max the largest of its components' magnitudes. All distances are along n.
//   1. The offset 2^k u m moves the point by 2^k u / |n|_max.
//   2. If no coordinate is rounded at a step larger than u, rounding moves each coordinate by at
//      most u / 2, and the point by at most (u / 2) |n|_1.
//   3. Unit vectors have |n|_1 |n|_max <= (1 + sqrt(3)) / 2 < 1.37. So rounding moves the point by
//      less than 0.69 u / |n|_max, and candidate 0 is on the wanted side.
//   4. The remaining distance, at least 0.3 u, far exceeds the error of X in double.
// If X + u m crosses into the next binade, the step doubles, and candidate 1 suffices.

// Side of candidate 0
//
// find_candidates() rejects a lane if X, computed in double, may be off by more than u / 16 on an
// axis. So, by 1 to 3 above, candidate 0 is beyond the plane by at least
//   u / |n|_max - (u / 2 + u / 16) |n|_1 > u (1 - 1.37 * 9 / 16) / |n|_max > 0.
//
// Error of X = O + t I, with t = D / (I . N) and D = (A - O) . N. N is NeighborClearance::normal.
//   1. The errors of N's components add up to less than 1, rounding of dot products included.
//   2. So D is off by less than |A - O|_max. I . N is off by less than 2, because |I|_max < 2.
//   3. So t is off by less than (|A - O|_max + 2 t) / (I . N), and t I by less than twice that.
//
// Why no triangle is near
//
// Let p be candidate 0, w the exact X's least weight, c the triangle's clearance, s = |p - A|_1.
//   1. Only triangles in the box of p and the computed X, enlarged by 2 u, can invalidate p. The
//      box is within 5 u of p on each axis and within 8 u of X. spawn_reach exceeds 16 u.
//   2. Other triangles are at least c w - margin away from X, unless they are farther than
//      spawn_reach, overlaps, or in the triangle's plane (see NeighborClearance).
//   3. c times a weight is computed in float as G . (p - A). G is c times the weight's gradient. G
//      is in the triangle's plane, and |G| <= 1/8, because c is at most 1/8 of the least height.
//   4. So the offset of p from the plane has no effect, and rounding p changes c w by less than u.
//   5. Rounding G, p - A and the dot product changes c w by less than 2^-23 s. Computing the third
//      weight as c minus the two others changes c w by less than 2^-21 (s + c).
// So no triangle is near if no overlap is within 16 u of p and, with c w as computed,
//   c w > 16 u + 2^-20 (s + c) + margin.  (8 u would suffice.)

namespace {

/// Returns whether double precision proves that no point of the triangle is in the box, by the
/// separating axis theorem. The caller has tested the box's own axes.
bool surely_apart(const glm::vec3& low, const glm::vec3& high, const Corners& triangle) {
  for (const glm::dvec3& corner : triangle) {
    if (corner == glm::clamp(corner, glm::dvec3(low), glm::dvec3(high))) return false;
  }
  const glm::dvec3 middle = 0.5 * (glm::dvec3(low) + glm::dvec3(high));
  const glm::dvec3 half = 0.5 * (glm::dvec3(high) - glm::dvec3(low));
  glm::dvec3 v[3];
  double size = largest(middle) + largest(half);
  for (int k = 0; k < 3; ++k) {
    v[k] = triangle[k] - middle;
    size = std::max(size, largest(v[k]));
  }
  const auto separates = [&](const glm::dvec3& axis) {
    const glm::dvec3 p(glm::dot(axis, v[0]), glm::dot(axis, v[1]), glm::dot(axis, v[2]));
    const double reach = glm::dot(half, glm::abs(axis)) + 0x1p-48 * size * largest(axis);
    return std::min({p.x, p.y, p.z}) > reach || std::max({p.x, p.y, p.z}) < -reach;
  };
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 edge = v[(k + 1) % 3] - v[k];
    if (separates(glm::dvec3(0.0, edge.z, -edge.y)) ||
        separates(glm::dvec3(-edge.z, 0.0, edge.x)) ||
        separates(glm::dvec3(edge.y, -edge.x, 0.0))) {
      return true;
    }
  }
  return separates(triangle_normal(triangle));
}

/// Four hits at which rays are spawned.
struct SpawnHits {
  Triple<DoubleQuad> normal;  ///< `normal` to `gradient` are as in NeighborClearance
  FloatQuad length;
  Triple<FloatQuad> corner, gradient[2];
  Triple<FloatQuad> origin, direction;  ///< of the rays
  /// The corners, if `corner` is rounded; otherwise null.
  const glm::dvec3* exact_corners = nullptr;

  RAYGATE_INLINE SpawnHits(const NeighborClearance* const (&triangles)[kQuad],
                           const Ray* const (&rays)[kQuad]) {
    static_assert(
        offsetof(NeighborClearance, normal) == 0 && offsetof(NeighborClearance, length) == 24 &&
        offsetof(NeighborClearance, corner) == 28 && offsetof(NeighborClearance, gradient) == 40 &&
        sizeof(NeighborClearance) == 64 && sizeof(Ray) == 24);
    DoubleQuad reals[kQuad];
    columns(triangles, 0, reals);
    normal = {reals[0], reals[1], reals[2]};
    const auto pairs = reinterpret_cast<FloatLanes>(reals[3]);
    length = __builtin_shufflevector(pairs, pairs, 0, 2, 4, 6);
    corner.x = __builtin_shufflevector(pairs, pairs, 1, 3, 5, 7);
    FloatQuad words[kQuad], more[kQuad];
    columns(triangles, 32, words);
    columns(triangles, 48, more);
    corner.y = words[0];
    corner.z = words[1];
    gradient[0] = {words[2], words[3], more[0]};
    gradient[1] = {more[1], more[2], more[3]};
    columns(rays, 0, words);
    origin = {words[0], words[1], words[2]};
    columns(rays, 8, words);
    direction = {words[1], words[2], words[3]};
  }

 private:
  /// Transposes the numbers at byte `offset` of four objects: row k has the k-th number of each.
  template <class Row, class Object>
  RAYGATE_INLINE static void columns(const Object* const (&objects)[kQuad], std::size_t offset,
                                     Row (&rows)[kQuad]) {
#pragma GCC unroll 4
    for (int i = 0; i < kQuad; ++i) {
      std::memcpy(&rows[i], reinterpret_cast<const char*>(objects[i]) + offset, sizeof(Row));
    }
    transpose(rows);
  }
};

template <Vectors kCode>
RAYGATE_INLINE Triple<DoubleQuad> widened(const Triple<FloatQuad>& x) {
  return {widen<kCode>(x.x), widen<kCode>(x.y), widen<kCode>(x.z)};
}

/// Returns the distance from non-negative floats to the next larger ones.
RAYGATE_INLINE FloatQuad step_of(const FloatQuad& x) { return float_of(bits_in(x) + 1) - x; }

/// Sets `point` to candidate 0 of each hit, on the incident (`way` is -1) or the transmitted side
/// (1). A candidate is valid if `is_clear` is -1 and no overlap is within `reach`.
template <Vectors kCode>
RAYGATE_INLINE void find_candidates(const SpawnHits& hits, const FloatQuad& way, float margin,
                                    Triple<FloatQuad>& point, FloatQuad& reach, IntQuad& is_clear) {
  // X = O + t I, and u.
  const Triple<DoubleQuad> origin = widened<kCode>(hits.origin),
                           direction = widened<kCode>(hits.direction);
  Triple<DoubleQuad> corner = widened<kCode>(hits.corner);
  if (hits.exact_corners != nullptr) [[unlikely]] {
    for (int i = 0; i < kQuad; ++i) {
      const glm::dvec3& exact = hits.exact_corners[i];
      corner.x[i] = exact.x;
      corner.y[i] = exact.y;
      corner.z[i] = exact.z;
    }
  }
  const Triple<DoubleQuad> from_origin = corner - origin;
  const DoubleQuad plane = dot(from_origin, hits.normal), slope = dot(direction, hits.normal);
  const DoubleQuad below = absolute(slope), inverse = 1.0 / below;
  const DoubleQuad t = absolute(plane) * inverse;
  const Triple<DoubleQuad> x = origin + direction * t;
  const FloatQuad u = step_of(largest_size(narrow(x)));
  const DoubleQuad step = widen<kCode>(u);

  // Error bound of X, with |I|_max < 2.
  const DoubleQuad origin_size = widen<kCode>(largest_size(hits.origin)), along_ray = t + t;
  const DoubleQuad error = 0x1p-50 * (origin_size + along_ray) +
                           2.01 * inverse * (largest_size(from_origin) + along_ray);
  const LongQuad is_sure = (below >= 0x1p35) & (16.0 * error <= step);

  // Candidate 0. The normal points to the side where orient3d is -1.
  const DoubleQuad turn = widen<kCode>(way);
  const DoubleQuad scale = (plane > 0.0 ? turn : -turn) / largest_size(hits.normal);
  point = narrow(x + hits.normal * scale * step);

  // c times the least weight of X.
  const FloatQuad length = absolute(hits.length);
  Triple<FloatQuad> p = point - hits.corner;
  if (hits.exact_corners != nullptr) [[unlikely]]
    p = narrow(widened<kCode>(point) - corner);
  const FloatQuad second = dot(p, hits.gradient[0]), third = dot(p, hits.gradient[1]);
  const FloatQuad least = minimum(minimum(FloatQuad(length - second - third), second), third);
  const FloatQuad error_of_least =
      0x1p-20f * (absolute(p.x) + absolute(p.y) + absolute(p.z) + length) + margin;
  reach = 16.0f * u;
  is_clear =
      (step_of(largest_size(point)) <= u) & (least > reach + error_of_least) & whole(is_sure);
}

}  // namespace

SpawnOrigin RaySpawner::find(const Ray& ray, std::uint32_t primitive, SpawnSide side) {
  const SpawnQuery query{&ray, primitive, side};
  SpawnOrigin origin;
  find({&query, 1}, {&origin, 1});
  return origin;
}

template <Vectors kCode>
RAYGATE_INLINE void RaySpawner::find_four(const SpawnQuery* queries, SpawnOrigin* origins) {
  const NeighborClearance* triangles[kQuad];
  const Ray* rays[kQuad];
  FloatQuad ways;
#pragma GCC unroll 4
  for (int i = 0; i < kQuad; ++i) {
    const std::uint32_t primitive = queries[i].primitive;
    if (bvh_.is_instanced(primitive)) [[unlikely]] {
      triangles[i] = &(found_[i] = clearances_.compute(primitive)).clearance;
    } else {
      triangles[i] = &clearances_.of(primitive);
    }
    rays[i] = queries[i].ray;
    ways[i] = queries[i].side == SpawnSide::kIncident ? -1.0f : 1.0f;
  }
  SpawnHits hits(triangles, rays);
  glm::dvec3 corners[kQuad];
  if (!bvh_.is_binary32()) [[unlikely]] {
    for (int i = 0; i < kQuad; ++i) corners[i] = bvh_.corners_of(queries[i].primitive)[0];
    hits.exact_corners = corners;
  }
  Triple<FloatQuad> point;
  FloatQuad reach;
  IntQuad is_clear;
  find_candidates<kCode>(hits, ways, clearances_.margin(), point, reach, is_clear);
  FloatQuad rows[kQuad] = {point.x, point.y, point.z, float_of(is_clear)};
  transpose(rows);
  static_assert(sizeof(SpawnOrigin) == sizeof(FloatQuad));
  std::memcpy(static_cast<void*>(origins), rows, sizeof rows);

  const LaneMask good = sign_mask(is_clear);
  const LaneMask has_overlaps = sign_mask(bits_in(hits.length));
  constexpr LaneMask kAll = (LaneMask{1} << kQuad) - 1;
  for (const int i : SetBits((~good & kAll) | has_overlaps)) {
    const SpawnQuery& query = queries[i];
    if ((good >> i & 1) != 0) {
      const glm::vec3 low = *origins[i] - reach[i], high = *origins[i] + reach[i];
      const auto is_near = [&](const Overlap& overlap) {
        return overlap.touches(low, high) &&
               !surely_apart(low, high, bvh_.corners_of(overlap.primitive));
      };
      if (std::ranges::none_of(bvh_.is_instanced(query.primitive)
                                   ? found_[i].overlaps
                                   : clearances_.overlaps_of(query.primitive),
                               is_near)) {
        continue;
      }
    }
    origins[i] = search(*query.ray, query.primitive, query.side);
  }
}

void RaySpawner::find(std::span<const SpawnQuery> queries, std::span<SpawnOrigin> origins) {
  in_vectors([&](auto code) RAYGATE_BODY {
    constexpr std::size_t kAhead = std::size_t{2} * kQuad;  // prefetch distance
    std::size_t first = 0;
    for (; first + kQuad <= queries.size(); first += kQuad) {
      if (first + kAhead + kQuad <= queries.size()) {
        const SpawnQuery* const soon = &queries[first + kAhead];
        for (std::size_t i = 0; i < kQuad; ++i) clearances_.prefetch_again(soon[i].primitive);
      }
      find_four<code()>(&queries[first], &origins[first]);
    }
    if (first == queries.size()) return;
    // The remaining queries; the last one fills the unused lanes.
    SpawnQuery last[kQuad];
    SpawnOrigin last_origins[kQuad];
    for (std::size_t i = 0; i < kQuad; ++i) {
      last[i] = queries[std::min(first + i, queries.size() - 1)];
    }
    find_four<code()>(last, last_origins);
    std::copy_n(last_origins, queries.size() - first, &origins[first]);
  });
}

SpawnOrigin RaySpawner::search(const Ray& ray, std::uint32_t primitive, SpawnSide side) {
  constexpr int kLastStep = 24;  // 2^24 steps: the magnitude of X's coordinate
  const Corners hit = bvh_.corners_of(primitive);
  const Interval t = hit_distance(ray, hit);
  const glm::dvec3 from(ray.origin), along = 0.5 * (t.low + t.high) * glm::dvec3(ray.direction);
  const glm::dvec3 x = from + along;
  const double error = 0x1p-51 * (largest(from) + largest(along)) +
                       (t.high - t.low) * static_cast<double>(largest(ray.direction));
  const auto size = static_cast<float>(largest(x));
  const float next = std::nextafter(size, std::numeric_limits<float>::infinity());
  const double step = std::max(static_cast<double>(next) - static_cast<double>(size), error);  // u
  const int before = orient3d(ray.origin, hit);
  const int sign = side == SpawnSide::kIncident ? before : -before;
  const glm::dvec3 normal = triangle_normal(hit);
  // orient3d is positive behind the normal.
  const glm::dvec3 offsets[2] = {
      normal * (-sign / largest(normal)),
      glm::dvec3(ray.direction) * (side == SpawnSide::kIncident ? -1.0 : 1.0)};
  const auto good = [&](const glm::vec3& candidate) {
    if (orient3d(candidate, hit) != sign) return false;
    // The box of X and the candidate. Enlarging covers the error of X and rounding.
    const glm::dvec3 c(candidate);
    const glm::vec3 low(glm::min(c, x) - 2.0 * step), high(glm::max(c, x) + 2.0 * step);
    const auto is_between = [&](std::uint32_t other_primitive, const Corners& other) {
      if (other_primitive == primitive || surely_apart(low, high, other) ||
          lies_beyond(other, hit, sign)) {
        return false;
      }
      // The side of `other` on which the ray is just before or after the hit; 0: coplanar.
      int wanted = plane_side_at_hit(ray, hit, other);
      if (wanted == 0) {
        const int start = orient3d(ray.origin, other);
        wanted = side == SpawnSide::kIncident ? start : -start;
      }
      return wanted != 0 && orient3d(candidate, other) != wanted;
    };
    return !any_primitive_near(bvh_, low, high, is_between);
  };
  for (int k = 0; k <= kLastStep; ++k) {
    for (const glm::dvec3& offset : offsets) {
      const glm::vec3 candidate(x + std::ldexp(step, k) * offset);
      if (good(candidate)) return {candidate, 1};
    }
  }
  // In a sharp corner close to the ray's origin, that origin may be the only valid point.
  if (side == SpawnSide::kIncident && good(ray.origin)) return {ray.origin, 1};
  return {};
}

bool RaySpawner::leaves(const Ray& ray, std::uint32_t primitive, SpawnSide side,
                        const glm::vec3& direction) const {
  const Corners hit = bvh_.corners_of(primitive);
  const int towards = orient3d(ray.origin, hit);
  const int sign = direction_side(direction, hit);
  return side == SpawnSide::kIncident ? sign == -towards : sign == towards;
}

}  // namespace raygate
