#include "host/intersect/core/reference_core.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "host/intersect/unit/burst_unit.h"

namespace raygate {
namespace {

// Names and steps are those of hw/ray_core/box_unit.sv, which has the proof.
constexpr int kFracBits = 22, kEnterBits = 12;
constexpr std::int64_t kWhole = std::int64_t{1} << kFracBits;  // 2^E, in units

int field(float x) { return Binary32::exponent_field(x); }

/// Returns the significand with its integer bit, also for (negligible) zeros and subnormals.
std::int64_t significand(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7FFFFF) | 0x800000;
}

/// Returns x >> amount for any amount: 0 beyond the word size, x for a negative amount.
std::int64_t shift_right(std::int64_t x, int amount) {
  if (amount <= 0) return x;
  return amount > 63 ? 0 : x >> amount;
}

/// An axis as seen from the ray. The ray meets the grid plane q at t = a + q step / 256 or, if
/// `back`, at t = a - q step / 256. All times are in units of 2^E / kWhole (see enter_boxes).
struct Axis {
  bool back;               // the ray goes towards smaller q
  std::int64_t near, far;  // a minus the error margin, and a plus the error margin
  std::int64_t step;
};

}  // namespace

BoxGroup enter_boxes(const NodeLine& node, const BoxRay& ray) {
  // E = exponent - 127: the ray surely leaves the node before t = 2^E.
  float distance[3];
  int exponent = field(ray.t_max) == 0xFF ? 511 : field(ray.t_max) + 1;
  for (int k = 0; k < 3; ++k) {
    distance[k] = node.origin[k] - ray.origin[k];
    const int inverse = field(ray.inverse[k]);
    if (inverse == 0xFF) continue;
    const int reach = std::max(field(distance[k]) + 1, node.exponent[k] + 8);
    exponent = std::min(exponent, reach + inverse - 125);
  }
  exponent = std::clamp(exponent, 27, 511);

  Axis axes[3];
  for (int k = 0; k < 3; ++k) {
    const bool back = std::signbit(ray.inverse[k]);
    const int cap = exponent - node.exponent[k] + 129;  // exponent field of the largest inverse
    const bool capped = field(ray.inverse[k]) >= cap || field(ray.inverse[k]) == 0xFF;
    const auto largest = std::bit_cast<float>(static_cast<std::uint32_t>(cap & 0xFF) << 23);
    const float inverse = capped ? std::copysign(largest, ray.inverse[k]) : ray.inverse[k];
    const float product = distance[k] * inverse;
    const bool open = (capped && (cap < 1 || cap > 254)) || field(product) == 0xFF;
    const int amount = exponent + 11 - field(product);
    const std::int64_t size =
        amount <= 0 ? std::int64_t{1} << 33 : shift_right(significand(product) << 10, amount);
    const std::int64_t a = std::signbit(product) ? -size : size;
    std::int64_t step = shift_right(significand(inverse) << 9, cap - field(inverse));
    std::int64_t room = (size >> 22) + (step >> 24) + 6;
    if (capped) room += kWhole;
    axes[k] = {back, a - room, a + room, step};
    if (open) axes[k] = {back, -(std::int64_t{1} << 33), std::int64_t{1} << 33, 0};
  }

  // The limit, rounded up.
  const int amount = exponent + 1 - field(ray.t_max);
  const std::int64_t limit = amount <= 1 ? kWhole : shift_right(significand(ray.t_max), amount) + 1;

  constexpr auto kNone = std::numeric_limits<std::int64_t>::max();
  std::array<std::int64_t, NodeLine::kChildren> keys;  // {enter, number}; kNone: not entered
  keys.fill(kNone);
  std::array<std::uint32_t, NodeLine::kChildren> offset;
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < NodeLine::kChildren; ++i) {
    const NodeLine::Child& child = node.child[i];
    offset[i] = next;
    next += child.size();
    std::int64_t enter = 0, leave = limit;
    for (std::size_t k = 0; k < 3; ++k) {
      const Axis& axis = axes[k];
      const auto at = [&](std::int64_t from, std::uint8_t q) {
        const std::int64_t way = (q * axis.step) >> 8;
        return axis.back ? from - way : from + way;
      };
      enter = std::max(enter, at(axis.near, axis.back ? child.high[k] : child.low[k]));
      leave = std::min(leave, at(axis.far, axis.back ? child.low[k] : child.high[k]));
    }
    if (child.kind == NodeLine::kAbsent || enter > leave) continue;
    keys[i] = enter << 3 | static_cast<std::int64_t>(i);
  }
  std::ranges::sort(keys);

  BoxGroup group{.base = node.base, .exponent = static_cast<std::uint32_t>(exponent)};
  for (const std::int64_t key : keys) {
    if (key == kNone) break;
    const auto i = static_cast<std::size_t>(key & 7);
    const auto enter = static_cast<std::uint32_t>(key >> 3);
    const std::uint32_t kind = node.child[i].kind;
    group.entry[static_cast<std::size_t>(group.size++)] = {
        std::min(enter >> (kFracBits - kEnterBits), (1u << kEnterBits) - 1), offset[i],
        kind == NodeLine::kInner ? 0 : kind};
  }
  return group;
}

bool is_beyond(const BoxGroup& group, const BoxGroup::Entry& entry, float limit) {
  // The limit in the entry's units, rounded down.
  const int amount = static_cast<int>(group.exponent) + 23 - kEnterBits - field(limit);
  if (amount <= 0) return false;  // the limit is at least 2^23 units
  return entry.enter > shift_right(significand(limit), amount);
}

namespace {

// Constants of set_up_pkg.sv; triangle_test.sv explains them.
constexpr int kLeastField = 27;
constexpr int kBoundShift = 20;
constexpr int kBias = 127;
constexpr int kMostPlaneError = 14;
constexpr std::uint32_t kTErrorUnit = 8;
constexpr auto kNan = std::bit_cast<float>(0x7FC00000u);

/// Returns u x v with the hardware's NaN. Sets `terms` to the sums of the products' magnitudes.
glm::vec3 cross_product(const glm::vec3& u, const glm::vec3& v, glm::vec3& terms) {
  glm::vec3 product = cross(u, v, terms);
  for (int k = 0; k < 3; ++k) {
    if (std::isnan(product[k])) product[k] = kNan;
  }
  return product;
}

bool is_in_range(int field) { return field >= kLeastField && field < 255; }

}  // namespace

SetUpRecord set_up(const glm::vec3& origin, const FloatCorners& triangle) {
  SetUpRecord result;
  PolygonRecord& record = result.record;
  FloatCorners corners, edges;
  for (int k = 0; k < 3; ++k) {
    corners[k] = triangle[k] - origin;
    edges[k] = triangle[(k + 1) % 3] - triangle[k];
  }
  glm::vec3 terms;
  for (int k = 0; k < 3; ++k) {
    record.edges[k] = cross_product(corners[k], edges[k], terms);
    const float sum = terms.x + terms.y + terms.z;
    record.bounds[k] = is_in_range(field(sum)) ? std::ldexp(sum, -kBoundShift)
                                               : std::numeric_limits<float>::infinity();
  }
  record.normal = cross_product(edges[2], edges[0], terms);
  record.d = Binary32::dot(record.normal, corners[0]);

  const int vertex_field = largest_field(corners[0]), terms_field = largest_field(terms);
  const int d_field = field(record.d);
  const int normal_error = terms_field - largest_field(record.normal);
  const int distance_error = std::max(vertex_field + terms_field - d_field - kBias, 0);
  const bool is_good = is_in_range(terms_field) && vertex_field < 255 && is_in_range(d_field) &&
                       normal_error <= kMostPlaneError && distance_error <= kMostPlaneError;
  if (is_good) {
    result.normal_error = static_cast<std::uint32_t>(normal_error);
    result.distance_error = static_cast<std::uint32_t>(distance_error);
  } else {
    record.d = kNan;
  }
  return result;
}

bool is_good_hit(const SetUpRecord& set_up, std::uint32_t grazing) {
  return grazing + set_up.normal_error <= kMostPlaneError;
}

std::uint32_t t_error_exponent(const SetUpRecord& set_up, std::uint32_t grazing) {
  return kTErrorUnit + std::max(grazing + set_up.normal_error, set_up.distance_error);
}

namespace {

/// Compares a sure hit with `nearest`. Keeps in `nearest` the hit with the smaller upper bound of
/// t, which becomes `limit`. Returns the triangle of the other hit, which the host must test, or
/// kNoTriangle if that hit is surely farther.
std::uint32_t take(const CoreResult& hit, CoreResult& nearest, float& limit) {
  constexpr std::uint32_t kInfinity = 0x7F800000;
  const auto word = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  const auto lower = [&](const CoreResult& of) {
    return word(of.t) - std::min(word(of.t), 1u << of.t_error);
  };
  const std::uint32_t high = std::min(word(hit.t) + (1u << hit.t_error), kInfinity);
  if (high >= word(limit)) return lower(hit) <= word(limit) ? hit.triangle : CoreRay::kNoTriangle;
  const std::uint32_t open =
      nearest.found && lower(nearest) <= high ? nearest.triangle : CoreRay::kNoTriangle;
  limit = std::bit_cast<float>(high);
  nearest = hit;
  return open;
}

/// The model of hw/ray_core for one ray. See ReferenceCore for `stack_depth` and `exact`.
struct RayTrace {
  const std::span<const MemoryLine> lines;
  const CoreRay& ray;
  const std::size_t stack_depth;
  const bool exact;
  CoreCounters& counters;
  std::vector<CoreResult>& results;

  CoreResult result{.tag = ray.tag};
  float limit = ray.t_max;  // hits at or beyond this distance are irrelevant
  bool ended = false;
  std::uint32_t candidate = CoreRay::kNoTriangle;  // the nearest hit among the doubts, if exact

  void run() {
    if (!is_usable(ray.ray.direction) || !is_scaled(ray.ray.direction)) {
      fail(CoreResult::Error::kDirection);
    }
    traverse();
    if (exact && !ended && is_candidate_nearest()) test(TriangleLine(lines[candidate]), true);
    ++counters.rays;
    counters.lines = counters.nodes + counters.tests;
    results.push_back(result);
  }

  /// The inner nodes still to visit among the children of a node.
  struct OpenGroup {
    BoxGroup group;
    std::vector<BoxGroup::Entry> entries;  // in reverse: the last is visited first
  };

  void fail(CoreResult::Error error) {
    result.error = error;
    ended = true;
  }
  bool is_read(std::uint32_t line) {
    if (line < lines.size()) return true;
    fail(CoreResult::Error::kMemory);
    result.line = line;
    return false;
  }

  void traverse() {
    std::vector<OpenGroup> stack;
    std::size_t entered = 0;
    bool shared = false;  // whether the ray has groups on the shared stack, see traversal.sv
    for (std::uint32_t line = MemoryImage::kRoot; is_read(line);) {
      ++counters.nodes;
      ++entered;
      OpenGroup inside = enter(NodeLine(lines[line]));
      if (!inside.entries.empty()) stack.push_back(std::move(inside));
      if (ended) return;
      // Groups on the shared stack are always scheduled.
      while (!stack.empty() && stack.size() <= stack_depth &&
             is_beyond(stack.back().group, stack.back().entries.back(), limit)) {
        stack.pop_back();
      }
      if (stack.empty()) return;
      if (entered == lines.size() || stack.size() == MemoryImage::kMostDepth) {
        return fail(CoreResult::Error::kCycle);
      }
      OpenGroup& top = stack.back();
      line = top.group.base + top.entries.back().offset;
      top.entries.pop_back();
      if (top.entries.empty()) stack.pop_back();
      const bool shares = stack.size() >= stack_depth;
      counters.overflows += shares && !shared;
      shared = shares;
    }
  }

  /// Tests the leaves that the ray enters below a node. Returns the inner nodes that it enters.
  OpenGroup enter(const NodeLine& node) {
    OpenGroup inside{enter_boxes(node, {ray.ray.origin, 1.0f / ray.ray.direction, limit}), {}};
    const BoxGroup& group = inside.group;
    for (const auto& entry : std::span(group.entry).first(static_cast<std::size_t>(group.size))) {
      if (entry.count == 0) inside.entries.push_back(entry);
      if (ended || is_beyond(group, entry, limit)) continue;
      for (std::uint32_t k = 0; k < entry.count && result.error == CoreResult::Error::kNone; ++k) {
        const std::uint32_t line = group.base + entry.offset + k;
        if (is_read(line)) test(TriangleLine(lines[line]), false);
      }
    }
    std::ranges::reverse(inside.entries);
    return inside;
  }

  /// Tests a triangle. `settles`: exact arithmetic has found that the triangle is the ray's nearest
  /// hit, so the test only computes the result.
  void test(const TriangleLine& triangle, bool settles) {
    const ReferenceBurstUnit unit;
    const glm::vec3& direction = ray.ray.direction;
    ++result.tests;
    if (triangle.index == ray.skip_id || triangle.index == ray.source_id) {
      return count(UnitVerdict::kMiss, counters);
    }
    const SetUpRecord set = set_up(ray.ray.origin, triangle.corners);
    HitDistance distance;
    const UnitVerdict verdict = unit.verdict(set.record, direction, distance);
    count(verdict, counters);
    if (verdict == UnitVerdict::kMiss) return;
    const bool is_sure = verdict == UnitVerdict::kHit && is_good_hit(set, distance.error);
    CoreResult hit = result;
    hit.found = true;
    hit.triangle = triangle.index;
    hit.t = is_sure ? distance.t : 0.0f;
    hit.t_error = is_sure ? t_error_exponent(set, distance.error) : CoreResult::kNoT;
    hit.point = is_sure ? unit.point(set.record, direction) : glm::vec3(0.0f);
    if (settles) {
      result = hit;
    } else if (!is_sure) {
      report(triangle.index, false);
    } else {
      const std::uint32_t open = take(hit, result, limit);
      ended = ray.any_hit && result.found;
      if (open == CoreRay::kNoTriangle) return;
      ++counters.depth_doubts;
      report(open, true);
    }
  }

  /// Reports a doubt to the host or, if `exact`, resolves it as hw/ray_core/exact_resolver.sv does.
  void report(std::uint32_t line, bool is_hit) {
    if (!exact) {
      results.push_back({.kind = CoreResult::Kind::kDoubt, .tag = ray.tag, .triangle = line});
    } else if (!ended && (is_hit || hits_triangle(ray.ray, corners_of(line))) &&
               (candidate == CoreRay::kNoTriangle || is_nearer(line, candidate))) {
      candidate = line;
    }
  }

  /// Returns whether `candidate` is nearer than the sure hit or, if there is none, than the limit.
  [[nodiscard]] bool is_candidate_nearest() const {
    if (candidate == CoreRay::kNoTriangle) return false;
    return result.found ? is_nearer(candidate, result.triangle)
                        : limit == std::numeric_limits<float>::infinity() ||
                              compare_hit_to_limit(ray.ray, corners_of(candidate), limit) < 0;
  }

  [[nodiscard]] Corners corners_of(std::uint32_t line) const {
    return widened(TriangleLine(lines[line]).corners);
  }

  /// Returns whether the hit of `line` is nearer than that of `other`, or of lower rank at equal t.
  [[nodiscard]] bool is_nearer(std::uint32_t line, std::uint32_t other) const {
    const int order = compare_hits(ray.ray, corners_of(line), corners_of(other));
    return order < 0 ||
           (order == 0 && TriangleLine(lines[line]).rank < TriangleLine(lines[other]).rank);
  }
};

}  // namespace

void ReferenceCore::trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
                          std::vector<CoreResult>& results) {
  for (const CoreRay& ray : rays) {
    RayTrace{lines, ray, stack_depth_, exact_, counters_, results}.run();
  }
}

}  // namespace raygate
