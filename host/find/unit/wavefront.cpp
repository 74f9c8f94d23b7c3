#include "host/find/unit/wavefront.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "host/find/cpu/cone_search.h"
#include "host/find/cpu/ray_search.h"
#include "host/stopwatch.h"

namespace raygate {

Wavefront::Wavefront(const Bvh& bvh, HitTester& tester, std::size_t enough_tests)
    : bvh_(bvh), tester_(tester), enough_tests_(enough_tests), nearest_(bvh) {}

void Wavefront::trace(std::span<const Ray> rays, const Search& search) {
  Stopwatch watch;
  nearest_.reset(rays.size(), search.limits);
  if (counting_) work_.assign(rays.size(), {});
  if (trace_in_place(rays, search)) {
    const double before = seconds_.doubt;
    seconds_.doubt = nearest_.counters().seconds;
    seconds_.hit += watch.lap() - (seconds_.doubt - before);
    return;
  }
  make_packets(rays, search);
  for (bool busy = true; busy;) {
    busy = false;
    for (Half& half : halves_) {
      if (half.started) finish(rays, search, half);
      watch.lap();
      collect(rays, search, half);
      seconds_.traverse += watch.lap();
      if (half.batch.empty()) continue;
      if (search.common == nullptr) make_own_records(rays, half);
      seconds_.record += watch.lap();
      tester_.start(half.batch);
      half.started = busy = true;
    }
  }
}

/// Takes the answers to a half's batch.
void Wavefront::finish(std::span<const Ray> rays, const Search& search, Half& half) {
  Stopwatch watch;
  results_.clear();
  tester_.finish(results_);
  half.started = false;
  merge(rays, search, half);
  if (counting_) count_batch(half);
  const double before = seconds_.doubt;
  seconds_.doubt = nearest_.counters().seconds;
  seconds_.hit += watch.lap() - (seconds_.doubt - before);
}

/// What the host can do without batches; false where batches are needed.
bool Wavefront::trace_in_place(std::span<const Ray> rays, const Search& search) {
  HitCounters* const counters = tester_.in_place();
  if (counters == nullptr || !search.culling || counting_) return false;
  const SearchWishes wishes = {search.limits, search.ignored, search.enough_before};
  const auto trace_by = [&](auto&& way) {
    way.trace(rays, wishes);
    ended_early_ += way.ended_early();
  };
  if (search.common != nullptr) {
    trace_by(ConeSearch(bvh_, search.common->origin(), nearest_, *counters));
  } else {
    trace_by(RaySearch(bvh_, nearest_, *counters));
  }
  return true;
}

/// Packets are filled octant by octant, each in the order of the rays; the second half of them is
/// the second half.
void Wavefront::make_packets(std::span<const Ray> rays, const Search& search) {
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  packets_.clear();
  std::array<std::uint32_t, 8> open;  // the packet of each octant that has room
  std::array<int, 8> filled{};
  open.fill(kNone);
  for (std::uint32_t number = 0; number < rays.size(); ++number) {
    const Ray& ray = rays[number];
    if (!is_usable(ray.direction)) continue;
    const int octant = octant_of(ray.direction);
    if (open[octant] == kNone) {
      open[octant] = static_cast<std::uint32_t>(packets_.size());
      filled[octant] = 0;
      packets_.emplace_back(bvh_, octant);
      packets_.back().rays.fill(number);
    }
    Packet& packet = packets_[open[octant]];
    const int lane = filled[octant]++;
    packet.rays[lane] = number;
    packet.traversal.set_ray(lane, ray.origin, ray.direction);
    packet.lanes |= 1u << lane;
    if (!search.limits.empty()) packet.traversal.set_cutoff(lane, search.limits[number]);
    if (filled[octant] == kLanes) open[octant] = kNone;
  }
  for (Half& half : halves_) half.active.clear();
  for (std::uint32_t index = 0; index < packets_.size(); ++index) {
    (index < packets_.size() / 2 ? halves_[0] : halves_[1]).active.push_back(index);
  }
}

std::optional<LeafVisit> Wavefront::next_visit(Packet& packet, const Search& search) {
  if (search.culling) return packet.traversal.next_leaf();
  const std::uint32_t first = packet.next_slot;
  if (first >= bvh_.slot_count()) return std::nullopt;
  const std::uint32_t count = std::min(Bvh::kMaxLeafSize, bvh_.slot_count() - first);
  packet.next_slot += count;
  return LeafVisit{first, count, packet.lanes};
}

/// Fills the batch: every packet goes to its next leaf or, while there are too few tests, to the
/// one after that.
void Wavefront::collect(std::span<const Ray> rays, const Search& search, Half& half) {
  half.batch.clear();
  half.owner.clear();
  for (std::size_t tests = 0; !half.active.empty();) {
    tests += visit_leaves(rays, search, half);
    if (tests >= enough_tests_) break;
  }
}

namespace {

RayBundle make_bundle(std::span<const Ray> rays, std::span<const std::uint32_t> numbers,
                      const LeafVisit& visit, LaneMask lanes) {
  RayBundle bundle;
  for (std::size_t lane = 0; lane < numbers.size(); ++lane) {
    const glm::vec3& direction = rays[numbers[lane]].direction;
    for (int k = 0; k < 3; ++k) bundle.direction[k][lane] = direction[k];
  }
  bundle.record_count = visit.count;
  bundle.first_tag = visit.first;
  bundle.lanes = lanes;
  return bundle;
}

/// A bundle for each origin among the visiting rays.
void add_own_bundles(std::span<const Ray> rays, std::span<const std::uint32_t> numbers,
                     const LeafVisit& visit, std::vector<RayBundle>& batch) {
  for (LaneMask left = visit.lanes; left != 0;) {
    const glm::vec3& origin = rays[numbers[std::countr_zero(left)]].origin;
    LaneMask lanes = 0;
    for (LaneMask others = left; others != 0; others &= others - 1) {
      const int lane = std::countr_zero(others);
      if (rays[numbers[lane]].origin == origin) lanes |= 1u << lane;
    }
    batch.push_back(make_bundle(rays, numbers, visit, lanes));
    left &= ~lanes;
  }
}

}  // namespace

/// Sends every packet to its next leaf and writes the tests found there into the batch; their
/// number. Packets that are through leave the active ones.
std::size_t Wavefront::visit_leaves(std::span<const Ray> rays, const Search& search, Half& half) {
  std::size_t kept = 0, tests = 0;
  for (const std::uint32_t index : half.active) {
    Packet& packet = packets_[index];
    const auto visit = next_visit(packet, search);
    if (!visit) continue;
    half.active[kept++] = index;
    tests += visit->count * static_cast<std::size_t>(std::popcount(visit->lanes));
    if (search.common != nullptr) {
      assert(rays[packet.rays[0]].origin == search.common->origin());
      half.batch.push_back(make_bundle(rays, packet.rays, *visit, visit->lanes));
      half.batch.back().records = search.common->leaf(visit->first, visit->count);
    } else {
      add_own_bundles(rays, packet.rays, *visit, half.batch);
    }
    half.owner.resize(half.batch.size(), index);
  }
  half.active.resize(kept);
  return tests;
}

/// All at once, when it is known how many: bundles point at their records.
void Wavefront::make_own_records(std::span<const Ray> rays, Half& half) {
  std::size_t count = 0;
  for (const RayBundle& bundle : half.batch) count += bundle.record_count;
  if (half.records.size() < count) half.records.resize(count);
  PolygonRecord* next = half.records.data();
  for (std::size_t i = 0; i < half.batch.size(); ++i) {
    RayBundle& bundle = half.batch[i];
    const Ray& ray = rays[packets_[half.owner[i]].rays[std::countr_zero(bundle.lanes)]];
    bundle.records = next;
    for (std::uint32_t k = 0; k < bundle.record_count; ++k) {
      *next++ = make_record(ray.origin, bvh_.corners_of(bundle.first_tag + k));
    }
  }
  own_records_ += count;
}

template <class Report>
void Wavefront::offer(std::span<const Ray> rays, const Search& search, const Half& half,
                      const Report& report) {
  Packet& packet = packets_[half.owner[report.bundle]];
  const std::uint32_t number = packet.rays[report.lane];
  const LaneMask lane = 1u << report.lane;
  if ((packet.ended & lane) != 0 || !nearest_.offer(number, rays[number], report)) return;
  const bool ends = !search.enough_before.empty() &&
                    nearest_.is_before(number, rays[number], search.enough_before[number]);
  ended_early_ += ends;
  if (ends) packet.ended |= lane;
  packet.traversal.set_cutoff(static_cast<int>(report.lane), ends ? -1.0 : nearest_[number].t.high);
}

/// A burst reports no hit that is surely farther than another one: where that one is ignored, exact
/// arithmetic tries them all.
void Wavefront::offer_hidden(std::span<const Ray> rays, const Search& search, const Half& half,
                             const SureHit& ignored) {
  const RayBundle& bundle = half.batch[ignored.bundle];
  const std::uint32_t number = packets_[half.owner[ignored.bundle]].rays[ignored.lane];
  if (!search.limits.empty() && ignored.t.low >= search.limits[number]) return;
  for (std::uint32_t tag = bundle.first_tag; tag < bundle.first_tag + bundle.record_count; ++tag) {
    if (tag == ignored.tag) continue;
    offer(rays, search, half, Doubt{ignored.bundle, ignored.lane, tag, glm::vec3(0.0f)});
  }
}

void Wavefront::merge(std::span<const Ray> rays, const Search& search, const Half& half) {
  const auto is_ignored = [&](const auto& report) {
    return !search.ignored.empty() &&
           search.ignored[packets_[half.owner[report.bundle]].rays[report.lane]] == report.tag;
  };
  for (const SureHit& hit : results_.hits) {
    if (is_ignored(hit)) {
      offer_hidden(rays, search, half, hit);
    } else {
      offer(rays, search, half, hit);
    }
  }
  for (const Doubt& doubt : results_.doubts) {
    if (!is_ignored(doubt)) offer(rays, search, half, doubt);
  }
}

void Wavefront::count_batch(const Half& half) {
  for (std::size_t i = 0; i < half.batch.size(); ++i) {
    for (LaneMask lanes = half.batch[i].lanes; lanes != 0; lanes &= lanes - 1) {
      const std::uint32_t ray = packets_[half.owner[i]].rays[std::countr_zero(lanes)];
      work_[ray].tests += half.batch[i].record_count;
    }
  }
  for (const Doubt& doubt : results_.doubts) {
    ++work_[packets_[half.owner[doubt.bundle]].rays[doubt.lane]].doubts;
  }
}

}  // namespace raygate
