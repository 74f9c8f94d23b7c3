#include "host/intersect/unit/unit_intersector.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <new>
#include <thread>
#include <utility>

#include "host/base/stopwatch.h"
#include "host/bvh/traversal.h"

namespace raygate {

void RecordCache::Free::operator()(void* memory) const { std::free(memory); }

RecordCache::RecordCache(const Bvh& bvh, const glm::vec3& origin) : bvh_(bvh), origin_(origin) {
  const std::size_t primitives = std::max<std::size_t>(bvh.primitive_count(), 1);
  // Not initialised on purpose: a page takes no memory until a record is written to it.
  records_.reset(static_cast<PolygonRecord*>(
      std::aligned_alloc(alignof(PolygonRecord), primitives * sizeof(PolygonRecord))));
  if (records_ == nullptr) throw std::bad_alloc();
  states_ = std::make_unique<std::atomic<State>[]>(primitives);
}

std::uint64_t RecordCache::make(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kRecords = 4 * Bvh::kMaxLeafSize;  // made at once
  std::uint64_t made = 0;
  const std::uint32_t end = first + count;
  for (std::uint32_t primitive = first; primitive < end;) {
    const std::uint32_t begin = primitive;
    std::array<Corners, kRecords> corners;
    for (; primitive < end && primitive - begin < kRecords && claim(primitive); ++primitive) {
      corners[primitive - begin] = bvh_.corners_of(primitive);
    }
    if (const std::uint32_t claimed = primitive - begin; claimed != 0) {
      make_records(origin_, std::span(corners).first(claimed),
                   std::span(&records_[begin], claimed));
      made += claimed;
      for (std::uint32_t i = begin; i < primitive; ++i) {
        states_[i].store(State::kMade, std::memory_order_release);
      }
    }
    if (primitive < end && primitive - begin < kRecords) ++primitive;  // made by another thread
  }
  for (std::uint32_t primitive = first; primitive < end; ++primitive) {
    while (states_[primitive].load(std::memory_order_acquire) != State::kMade)
      std::this_thread::yield();
  }
  return made;
}

bool RecordCache::claim(std::uint32_t primitive) {
  State expected = State::kNone;
  return states_[primitive].compare_exchange_strong(expected, State::kBusy);
}

RecordCache& RecordCaches::at(const glm::vec3& origin, std::uint64_t& made) {
  const std::scoped_lock lock(mutex_);
  const auto [at, is_new] =
      caches_.try_emplace(std::bit_cast<std::array<std::uint32_t, 3>>(origin), bvh_, origin);
  const std::uint32_t primitives = bvh_.primitive_count();
  if (is_new && !on_first_touch_ && primitives != 0) (void)at->second.leaf(0, primitives, made);
  return at->second;
}

UnitIntersector::UnitIntersector(const Bvh& bvh, std::shared_ptr<HitTester> tester,
                                 std::shared_ptr<RecordCaches> caches)
    : bvh_(bvh),
      tester_(std::move(tester)),
      caches_(caches ? std::move(caches) : std::make_shared<RecordCaches>(bvh)) {}

std::size_t UnitIntersector::preferred_batch() const {
  // Makes batches long relative to the pipeline's fill time.
  constexpr std::size_t kRaysPerTest = 256;
  return std::max(kBatch, kRaysPerTest * tester_->enough_tests());
}

IntersectCounters UnitIntersector::counters() const {
  IntersectCounters counters = counters_;
  counters.hit = tester_->counters();
  return counters;
}

void UnitIntersector::intersect(std::span<const Ray> rays, const RayQuery& query,
                                std::span<NearestHit> hits) {
  assert(hits.size() == rays.size());
  Stopwatch watch;
  rays_ = rays;
  query_ = query;
  hits_ = hits;
  clear(query, hits);
  common_ = nullptr;
  if (query.common_origin && !rays.empty()) {
    common_ = &caches_->at(rays[0].origin, counters_.common_records);
  }
  make_packets();
  for (bool busy = true; busy;) {
    busy = false;
    for (Half& half : halves_) {
      if (half.started) finish(half);
      watch.lap();
      collect(half);
      counters_.traverse += watch.lap();
      if (half.batch.empty()) continue;
      if (common_ == nullptr || bvh_.has_instances()) make_own_records(half);
      counters_.record += watch.lap();
      tester_->start(half.batch);
      half.started = busy = true;
    }
  }
}

/// Processes the results of a half's batch.
void UnitIntersector::finish(Half& half) {
  Stopwatch watch;
  results_.clear();
  tester_->finish(results_);
  half.started = false;
  merge(half);
  if (!query_.work.empty()) count_work(half);
  counters_.hit_tests += watch.lap();
}

/// Fills packets by octant, in the order of the rays. Each half gets half of the packets.
void UnitIntersector::make_packets() {
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  packets_.clear();
  std::array<std::uint32_t, 8> open;  // by octant: a packet with free lanes
  std::array<int, 8> filled{};
  open.fill(kNone);
  for (std::uint32_t number = 0; number < rays_.size(); ++number) {
    const Ray& ray = rays_[number];
    if (!is_usable(ray.direction)) continue;
    if (!is_scaled(ray.direction)) throw_unscaled(ray);
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
    if (!query_.t_max.empty()) packet.traversal.set_cutoff(lane, query_.t_max[number]);
    if (filled[octant] == kLanes) open[octant] = kNone;
  }
  for (Half& half : halves_) half.active.clear();
  for (std::uint32_t index = 0; index < packets_.size(); ++index) {
    (index < packets_.size() / 2 ? halves_[0] : halves_[1]).active.push_back(index);
  }
}

LeafVisits UnitIntersector::next_leaf(Packet& packet) {
  if (query_.culling) return packet.traversal.next_leaf();
  const auto [placed, end] = bvh_.instance_primitives();
  if (packet.next_primitive == bvh_.primitive_count()) packet.next_primitive = placed;
  const std::uint32_t first = packet.next_primitive;
  if (first == end) return {};
  const std::uint32_t most = bvh_.is_instanced(first) ? end : bvh_.primitive_count();
  const std::uint32_t count = std::min(Bvh::kMaxLeafSize, most - first);
  packet.next_primitive += count;
  return {{LeafVisit{first, count, packet.lanes}}, 1};
}

/// Fills the batch: advances every packet to its next leaf, repeatedly if there are too few tests.
void UnitIntersector::collect(Half& half) {
  half.batch.clear();
  half.owner.clear();
  for (std::size_t tests = 0; !half.active.empty();) {
    tests += visit_leaves(half);
    if (tests >= tester_->enough_tests()) break;
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

/// Adds a bundle for each origin among the visiting rays.
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

/// Advances every packet to its next leaf, adds the tests there to the batch, and returns their
/// number. Finished packets are removed from the active ones.
std::size_t UnitIntersector::visit_leaves(Half& half) {
  std::size_t kept = 0, tests = 0;
  for (const std::uint32_t index : half.active) {
    Packet& packet = packets_[index];
    const LeafVisits leaf = next_leaf(packet);
    if (leaf.count == 0) continue;
    half.active[kept++] = index;
    for (const LeafVisit& visit : leaf) {
      tests += visit.count * static_cast<std::size_t>(std::popcount(visit.lanes));
      if (common_ != nullptr && !bvh_.is_instanced(visit.first)) {
        assert(rays_[packet.rays[0]].origin == common_->origin());
        half.batch.push_back(make_bundle(rays_, packet.rays, visit, visit.lanes));
        half.batch.back().records =
            common_->leaf(visit.first, visit.count, counters_.common_records);
      } else {
        add_own_bundles(rays_, packet.rays, visit, half.batch);
      }
    }
    half.owner.resize(half.batch.size(), index);
  }
  half.active.resize(kept);
  return tests;
}

/// Makes the records that are not cached, all at once, as bundles point to them. Includes those of
/// instances, even with a common origin, since a cache would reserve memory for each.
void UnitIntersector::make_own_records(Half& half) {
  std::size_t count = 0;
  for (const RayBundle& bundle : half.batch) {
    if (bundle.records == nullptr) count += bundle.record_count;
  }
  if (half.records.size() < count) half.records.resize(count);
  PolygonRecord* next = half.records.data();
  for (std::size_t i = 0; i < half.batch.size(); ++i) {
    RayBundle& bundle = half.batch[i];
    if (bundle.records != nullptr) continue;
    const Ray& ray = rays_[packets_[half.owner[i]].rays[std::countr_zero(bundle.lanes)]];
    std::array<Corners, Bvh::kMaxLeafSize> corners;
    for (std::uint32_t k = 0; k < bundle.record_count; ++k) {
      corners[k] = bvh_.corners_of(bundle.first_tag + k);
    }
    make_records(ray.origin, std::span(corners).first(bundle.record_count),
                 std::span(next, bundle.record_count));
    bundle.records = next;
    next += bundle.record_count;
  }
  counters_.own_records += count;
}

bool UnitIntersector::take(std::uint32_t number, const SureHit& hit) {
  return take_if_nearer(bvh_, rays_[number], query_.t_max_of(number),
                        {hit.tag, hit.point, hit.point_error, hit.t}, hits_[number], counters_);
}

bool UnitIntersector::take(std::uint32_t number, const Doubt& doubt) {
  return resolve_doubt(bvh_, rays_[number], query_.t_max_of(number),
                       {doubt.tag, doubt.point, doubt.point_error, {}}, hits_[number], counters_);
}

template <class Report>
void UnitIntersector::offer(const Half& half, const Report& report) {
  Packet& packet = packets_[half.owner[report.bundle]];
  const std::uint32_t number = packet.rays[report.lane];
  const LaneMask lane = 1u << report.lane;
  if ((packet.ended & lane) != 0 || !take(number, report)) return;
  const bool ends = !query_.any_hit_before.empty() &&
                    is_before(bvh_, rays_[number], hits_[number], query_.any_hit_before[number]);
  counters_.ended_early += ends;
  if (ends) packet.ended |= lane;
  packet.traversal.set_cutoff(static_cast<int>(report.lane), ends ? -1.0 : hits_[number].t.high);
}

/// Tests all triangles of the bundle exactly if its hit is ignored, since a burst does not report
/// hits that are surely farther than another one.
void UnitIntersector::offer_hidden(const Half& half, const SureHit& ignored) {
  const RayBundle& bundle = half.batch[ignored.bundle];
  const std::uint32_t number = packets_[half.owner[ignored.bundle]].rays[ignored.lane];
  if (ignored.t.low >= query_.t_max_of(number)) return;
  for (std::uint32_t tag = bundle.first_tag; tag < bundle.first_tag + bundle.record_count; ++tag) {
    if (tag == ignored.tag) continue;
    offer(half, Doubt{ignored.bundle, ignored.lane, tag, glm::vec3(0.0f)});
  }
}

void UnitIntersector::merge(const Half& half) {
  const auto is_ignored = [&](const auto& report) {
    return !query_.skip_ids.empty() &&
           query_.skip_ids[packets_[half.owner[report.bundle]].rays[report.lane]] == report.tag;
  };
  for (const SureHit& hit : results_.hits) {
    if (is_ignored(hit)) {
      offer_hidden(half, hit);
    } else {
      offer(half, hit);
    }
  }
  for (const Doubt& doubt : results_.doubts) {
    if (!is_ignored(doubt)) offer(half, doubt);
  }
}

void UnitIntersector::count_work(const Half& half) {
  for (std::size_t i = 0; i < half.batch.size(); ++i) {
    for (LaneMask lanes = half.batch[i].lanes; lanes != 0; lanes &= lanes - 1) {
      const std::uint32_t ray = packets_[half.owner[i]].rays[std::countr_zero(lanes)];
      query_.work[ray].tests += half.batch[i].record_count;
    }
  }
  for (const Doubt& doubt : results_.doubts) {
    ++query_.work[packets_[half.owner[doubt.bundle]].rays[doubt.lane]].doubts;
  }
}

}  // namespace raygate
