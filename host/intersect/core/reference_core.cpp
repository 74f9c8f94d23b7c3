#include "host/intersect/core/reference_core.h"

#include <bit>
#include <cstdint>
#include <limits>

#include "host/intersect/core/reference_units.h"
#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {
namespace {

/// The nearest of a ray's sure hits, whose distances have an error of fewer than 2^t_error floats.
///
/// Keeps the hit with the smallest upper bound. Other hits that are not surely farther than this
/// bound go to the host. Before the first hit, the limit is the upper bound.
struct NearestSureHit {
  std::uint32_t t_max_word;  ///< bits of a float; hits with exact t at or beyond it are irrelevant
  bool found = false;
  std::uint32_t triangle = CoreRay::kNoTriangle;
  std::uint32_t t_word = 0;
  std::uint32_t t_error = 0;

  explicit NearestSureHit(float limit) : t_max_word(std::bit_cast<std::uint32_t>(limit)) {}

  [[nodiscard]] float limit() const { return std::bit_cast<float>(t_max_word); }

  /// Takes a hit. Returns the triangle that must go to the host instead, or kNoTriangle.
  std::uint32_t take(std::uint32_t number, float t, std::uint32_t error) {
    constexpr std::uint32_t kInfinity = 0x7F800000;
    const std::uint32_t word = std::bit_cast<std::uint32_t>(t), margin = 1u << error;
    const std::uint32_t low = word > margin ? word - margin : 0;
    const std::uint32_t high = word + margin < kInfinity ? word + margin : kInfinity;
    if (high >= t_max_word) return low <= t_max_word ? number : CoreRay::kNoTriangle;
    const std::uint32_t old_margin = 1u << t_error;
    const std::uint32_t old_low = t_word > old_margin ? t_word - old_margin : 0;
    const std::uint32_t open = found && old_low <= high ? triangle : CoreRay::kNoTriangle;
    t_max_word = high;
    found = true;
    triangle = number;
    t_word = word;
    t_error = error;
    return open;
  }

  /// Sets the hit that exact arithmetic determined, regardless of the kept one.
  void settle(std::uint32_t number, float t, std::uint32_t error) {
    found = true;
    triangle = number;
    t_word = std::bit_cast<std::uint32_t>(t);
    t_error = error;
  }
};

/// Finds the nearest hit among a ray's doubts, as hw/ray_core/exact_resolver.sv does.
class DoubtResolver {
 public:
  DoubtResolver(std::span<const MemoryLine> lines, const CoreRay& ray) : lines_(lines), ray_(ray) {}

  /// Takes a doubt; `is_hit`: it is known to be a hit.
  void take(std::uint32_t line, bool is_hit) {
    if (!is_hit && !hits_triangle(ray_.ray, TriangleLine(lines_[line]).corners)) return;
    if (candidate_ == CoreRay::kNoTriangle || is_nearer(line, candidate_)) candidate_ = line;
  }
  /// Returns the candidate if it is nearer than the sure hit or the limit, else kNoTriangle.
  [[nodiscard]] std::uint32_t settle(const NearestSureHit& nearest) const {
    if (candidate_ == CoreRay::kNoTriangle) return candidate_;
    const bool nearer =
        nearest.found ? is_nearer(candidate_, nearest.triangle)
                      : nearest.limit() == std::numeric_limits<float>::infinity() ||
                            compare_hit_to_limit(ray_.ray, TriangleLine(lines_[candidate_]).corners,
                                                 nearest.limit()) < 0;
    return nearer ? candidate_ : CoreRay::kNoTriangle;
  }

 private:
  /// Returns whether one of two triangles that are hit is nearer or, at equal t, has the lower
  /// rank.
  [[nodiscard]] bool is_nearer(std::uint32_t line, std::uint32_t other) const {
    const TriangleLine a(lines_[line]), b(lines_[other]);
    const int order = compare_hits(ray_.ray, a.corners, b.corners);
    return order < 0 || (order == 0 && a.rank < b.rank);
  }

  std::span<const MemoryLine> lines_;
  const CoreRay& ray_;
  std::uint32_t candidate_ = CoreRay::kNoTriangle;
};

/// A group with inner nodes to visit.
struct OpenGroup {
  BoxGroup group;
  int next = 0;  // index of the next entry
};

int depth_of(const std::vector<OpenGroup>& stack) { return static_cast<int>(stack.size()); }

}  // namespace

void ReferenceCore::trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
                          std::vector<CoreResult>& results) {
  for (const CoreRay& ray : rays) trace(lines, ray, results);
}

void ReferenceCore::trace(std::span<const MemoryLine> lines, const CoreRay& ray,
                          std::vector<CoreResult>& results) {
  const ReferenceBurstUnit unit;
  NearestSureHit nearest(ray.t_max);
  glm::vec3 point{0.0f};
  std::uint32_t tests = 0;
  bool ended = false;
  DoubtResolver resolver(lines, ray);
  const auto doubt = [&](std::uint32_t triangle, bool is_hit) {
    if (exact_) {
      if (!ended) resolver.take(triangle, is_hit);
    } else {
      results.push_back({.kind = CoreResult::Kind::kDoubt, .tag = ray.tag, .triangle = triangle});
    }
  };
  const auto test = [&](const TriangleLine& triangle, bool settles) {
    ++tests;
    if (triangle.index == ray.skip_id || triangle.index == ray.source_id) {
      ++counters_.misses;
      return;
    }
    const SetUpRecord set = set_up(ray.ray.origin, triangle.corners);
    const UnitVerdict verdict = unit.verdict(set.record, ray.ray.direction);
    counters_.misses += verdict == UnitVerdict::kMiss;
    counters_.hits += verdict == UnitVerdict::kHit;
    counters_.doubts += verdict == UnitVerdict::kDoubt;
    if (verdict == UnitVerdict::kMiss) return;
    const HitDistance distance = unit.distance(set.record, ray.ray.direction);
    const bool is_sure = verdict == UnitVerdict::kHit && is_good_hit(set, distance.error);
    if (settles) {
      nearest.settle(triangle.index, is_sure ? distance.t : 0.0f,
                     is_sure ? t_error_exponent(set, distance.error) : CoreResult::kNoT);
      point = is_sure ? unit.point(set.record, ray.ray.direction) : glm::vec3(0.0f);
      return;
    }
    if (!is_sure) {
      doubt(triangle.index, false);
      return;
    }
    const std::uint32_t open =
        nearest.take(triangle.index, distance.t, t_error_exponent(set, distance.error));
    if (nearest.triangle == triangle.index) point = unit.point(set.record, ray.ray.direction);
    ended = ray.any_hit && nearest.found;
    if (open != CoreRay::kNoTriangle) {
      ++counters_.near_ties;
      doubt(open, true);
    }
  };

  std::vector<OpenGroup> stack;
  std::uint32_t line = MemoryImage::kRoot;
  std::size_t entered = 0;
  bool shared = false;  // has groups on the shared stack, see traversal.sv
  CoreResult end{.tag = ray.tag};
  const auto is_read = [&](std::uint32_t number) {
    if (number < lines.size()) return true;
    end.error = CoreResult::Error::kMemory;
    end.line = number;
    ended = true;
    return false;
  };
  if (!is_usable(ray.ray.direction) || !is_scaled(ray.ray.direction)) {
    end.error = CoreResult::Error::kDirection;
    ended = true;
  }
  while (is_read(line)) {
    ++counters_.nodes;
    ++entered;
    const BoxRay box_ray{ray.ray.origin, 1.0f / ray.ray.direction, nearest.limit(), ray.no_cull};
    const BoxGroup group = enter_boxes(NodeLine(lines[line]), box_ray);
    // Leaves first, then inner nodes, as in the core.
    OpenGroup inside{group};
    inside.group.size = 0;
    for (int n = 0; n < group.size; ++n) {
      const BoxGroup::Entry& entry = group.entry[static_cast<std::size_t>(n)];
      if (entry.count == 0) {
        inside.group.entry[static_cast<std::size_t>(inside.group.size++)] = entry;
        continue;
      }
      if (ended || is_beyond(group, entry, nearest.limit())) continue;
      for (std::uint32_t k = 0; k < entry.count && end.error == CoreResult::Error::kNone; ++k) {
        const std::uint32_t triangle = group.base + entry.offset + k;
        if (is_read(triangle)) test(TriangleLine(lines[triangle]), false);
      }
    }
    if (inside.group.size != 0) stack.push_back(inside);
    const auto is_done = [&](const OpenGroup& top) {
      return is_beyond(top.group, top.group.entry[static_cast<std::size_t>(top.next)],
                       nearest.limit());
    };
    if (ended) break;
    // Groups on the shared stack are always scheduled.
    while (!stack.empty() && depth_of(stack) <= stack_depth_ && is_done(stack.back())) {
      stack.pop_back();
    }
    if (stack.empty()) break;
    if (entered == lines.size() || depth_of(stack) == MemoryImage::kMostDepth) {
      end.error = CoreResult::Error::kCycle;
      break;
    }
    OpenGroup& top = stack.back();
    line = top.group.base + top.group.entry[static_cast<std::size_t>(top.next++)].offset;
    // A group without further nodes is popped.
    if (top.next == top.group.size) stack.pop_back();
    const bool shares = depth_of(stack) >= stack_depth_;
    counters_.overflows += shares && !shared;
    shared = shares;
  }
  if (exact_ && !ended && end.error == CoreResult::Error::kNone) {
    const std::uint32_t settled = resolver.settle(nearest);
    if (settled != CoreRay::kNoTriangle) test(TriangleLine(lines[settled]), true);
  }
  ++counters_.rays;
  counters_.triangles += tests;
  counters_.lines = counters_.nodes + counters_.triangles;
  end.found = nearest.found;
  end.triangle = nearest.triangle;
  end.t = std::bit_cast<float>(nearest.t_word);
  end.t_error = nearest.t_error;
  end.point = point;
  end.tests = tests;
  results.push_back(end);
}

}  // namespace raygate
