#include "host/intersect/core/reference_core.h"

#include <bit>
#include <cstdint>

#include "host/intersect/core/reference_box_unit.h"
#include "host/intersect/core/set_up.h"
#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {
namespace {

/// The nearest of a ray's sure hits, whose distances are off by fewer than 2^t_error numbers.
///
/// Kept is the hit whose upper bound is the smallest; what is surely not farther than that, and
/// not kept, is given to the host. The limit stands for the upper bound of the hit before the
/// first.
struct NearestSureHit {
  std::uint32_t t_max_word;  ///< of a float: no exact t at or beyond it matters any more
  bool found = false;
  std::uint32_t triangle = CoreRay::kNoTriangle;
  std::uint32_t t_word = 0;
  std::uint32_t t_error = 0;

  explicit NearestSureHit(float limit) : t_max_word(std::bit_cast<std::uint32_t>(limit)) {}

  [[nodiscard]] float limit() const { return std::bit_cast<float>(t_max_word); }

  /// Takes a hit; the triangle that must go to the host for that, or kNoTriangle.
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
};

/// Inner nodes of a group that wait.
struct StackEntry {
  BoxGroup group;
  int next = 0;  // entry
};

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
  const auto doubt = [&](std::uint32_t triangle) {
    results.push_back({.kind = CoreResult::Kind::kDoubt, .tag = ray.tag, .triangle = triangle});
  };
  const auto test = [&](const TriangleLine& triangle) {
    ++tests;
    if (triangle.index == ray.skip_id) return;
    const SetUpRecord set = set_up(ray.ray.origin, triangle.corners);
    const UnitVerdict verdict = unit.verdict(set.record, ray.ray.direction);
    counters_.misses += verdict == UnitVerdict::kMiss;
    counters_.hits += verdict == UnitVerdict::kHit;
    counters_.doubts += verdict == UnitVerdict::kDoubt;
    if (verdict == UnitVerdict::kMiss) return;
    const HitDistance distance = unit.distance(set.record, ray.ray.direction);
    if (verdict == UnitVerdict::kDoubt || !is_good_hit(set, distance.error)) {
      doubt(triangle.index);
      return;
    }
    const std::uint32_t open =
        nearest.take(triangle.index, distance.t, t_error_exponent(set, distance.error));
    if (nearest.triangle == triangle.index) point = unit.point(set.record, ray.ray.direction);
    if (open != CoreRay::kNoTriangle) {
      ++counters_.near_ties;
      doubt(open);
    }
    ended = ray.any_hit && nearest.found;
  };

  std::vector<StackEntry> stack;
  std::uint32_t line = ray.start;
  std::size_t entered = 0;
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
    // Leaves first, then what is inside: as the core does.
    StackEntry inside{group};
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
        if (is_read(triangle)) test(TriangleLine(lines[triangle]));
      }
    }
    if (inside.group.size != 0) {
      if (static_cast<int>(stack.size()) < stack_depth_) {
        stack.push_back(inside);
      } else {
        CoreResult overflow{
            .kind = CoreResult::Kind::kOverflow, .tag = ray.tag, .line = group.base};
        for (int n = 0; n < inside.group.size; ++n) {
          overflow.nodes |= std::uint64_t{1}
                            << inside.group.entry[static_cast<std::size_t>(n)].offset;
        }
        results.push_back(overflow);
        ++counters_.overflows;
      }
    }
    const auto is_done = [&](const StackEntry& top) {
      return ended || top.next == top.group.size ||
             is_beyond(top.group, top.group.entry[static_cast<std::size_t>(top.next)],
                       nearest.limit());
    };
    while (!stack.empty() && is_done(stack.back())) stack.pop_back();
    if (stack.empty()) break;
    if (entered == lines.size()) {
      end.error = CoreResult::Error::kCycle;
      break;
    }
    StackEntry& top = stack.back();
    line = top.group.base + top.group.entry[static_cast<std::size_t>(top.next++)].offset;
    // A group that has given its last node makes room.
    if (top.next == top.group.size) stack.pop_back();
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
