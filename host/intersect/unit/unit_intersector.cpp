#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "host/base/measure.h"
#include "host/bvh/packet_traversal.h"
#include "host/bvh/traversal.h"
#include "host/intersect/unit/hit_tester.h"

namespace raygate {
namespace {

/// In each round, every packet of eight rays traverses the tree to its next leaf. The tests at all
/// these leaves form a batch for the tester. The results shorten the rays. One half of the packets
/// traverses while the tester works on the other half. Polygon records are made when a ray reaches
/// a leaf, once for all rays of its packet with the same origin.
class UnitIntersector : public Intersector {
 public:
  UnitIntersector(const Bvh& bvh, std::shared_ptr<HitTester> tester)
      // Makes batches long relative to the pipeline's fill time, also if several lanes share one.
      : Intersector({.batch = std::max(EngineTraits{}.batch, 256 * tester->enough_tests())}),
        bvh_(bvh),
        tester_(std::move(tester)) {}

  [[nodiscard]] IntersectCounters counters() const override {
    IntersectCounters counters = counters_;
    counters.hit = tester_->counters();
    return counters;
  }

 private:
  void trace(std::span<const Ray> rays, const RayQuery& query,
             std::span<NearestHit> hits) override {
    Stopwatch watch;
    rays_ = rays;
    query_ = query;
    hits_ = hits;
    make_packets();
    for (bool busy = true; busy;) {
      busy = false;
      for (Half& half : halves_) {
        if (half.started) {
          reports_.clear();
          tester_->finish(reports_);
          half.started = false;
          merge(half);
          if (!query_.work.empty()) count_work(half);
        }
        collect(half);
        if (half.batch.empty()) continue;
        make_records_of(half);
        tester_->start(half.batch);
        half.started = busy = true;
      }
    }
    counters_.seconds += watch.lap();
  }

  /// Up to eight rays of one octant.
  struct Packet {
    Packet(const Bvh& bvh, int octant) : traversal(bvh, octant) {}

    PacketTraversal traversal;
    std::array<std::uint32_t, kLanes> rays;  // ray indices; lanes without a ray repeat lane 0
    LaneMask ended = 0;                      // rays ended early
  };

  /// Half of the packets, with their batch.
  struct Half {
    std::vector<std::uint32_t> active;  // packets that continue
    std::vector<RayBundle> batch;
    std::vector<std::uint32_t> owner;    // index of the packet of each bundle
    std::vector<PolygonRecord> records;  // in the batch's order
    bool started = false;                // the tester is working on the batch
  };

  /// Fills packets by octant, in the order of the rays. Each half gets half of the packets.
  void make_packets() {
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
      if (!query_.t_max.empty()) packet.traversal.set_cutoff(lane, query_.t_max[number]);
      if (filled[octant] == kLanes) open[octant] = kNone;
    }
    for (Half& half : halves_) half.active.clear();
    for (std::uint32_t index = 0; index < packets_.size(); ++index) {
      (index < packets_.size() / 2 ? halves_[0] : halves_[1]).active.push_back(index);
    }
  }

  /// Fills the batch: advances every packet to its next leaf until there are enough tests.
  void collect(Half& half) {
    half.batch.clear();
    half.owner.clear();
    for (std::size_t tests = 0; !half.active.empty();) {
      tests += visit_leaves(half);
      if (tests >= tester_->enough_tests()) break;
    }
  }

  /// Advances every packet to its next leaf, adds the tests there to the batch, and returns their
  /// number. Finished packets are removed from the active ones.
  std::size_t visit_leaves(Half& half) {
    std::size_t kept = 0, tests = 0;
    for (const std::uint32_t index : half.active) {
      Packet& packet = packets_[index];
      const LeafVisits leaf = packet.traversal.next_leaf();
      if (leaf.count == 0) continue;
      half.active[kept++] = index;
      for (const LeafVisit& visit : leaf) {
        tests += visit.count * static_cast<std::size_t>(std::popcount(visit.lanes));
        // A bundle for each origin among the visiting rays.
        for (LaneMask left = visit.lanes; left != 0; left &= ~half.batch.back().lanes) {
          const glm::vec3& origin = rays_[packet.rays[std::countr_zero(left)]].origin;
          RayBundle& bundle = half.batch.emplace_back();
          bundle.record_count = visit.count;
          bundle.first_tag = visit.first;
          for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const Ray& ray = rays_[packet.rays[lane]];
            for (int k = 0; k < 3; ++k) bundle.direction[k][lane] = ray.direction[k];
            if ((left >> lane & 1) != 0 && ray.origin == origin) bundle.lanes |= 1u << lane;
          }
        }
      }
      half.owner.resize(half.batch.size(), index);
    }
    half.active.resize(kept);
    return tests;
  }

  /// Makes the records of a batch. The vector is resized first, because bundles point into it.
  void make_records_of(Half& half) {
    std::size_t count = 0;
    for (const RayBundle& bundle : half.batch) count += bundle.record_count;
    if (half.records.size() < count) half.records.resize(count);
    PolygonRecord* next = half.records.data();
    for (std::size_t i = 0; i < half.batch.size(); ++i) {
      RayBundle& bundle = half.batch[i];
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
    counters_.records += count;
  }

  [[nodiscard]] std::uint32_t ray_of(const Half& half, const HitReport& report) const {
    return packets_[half.owner[report.bundle]].rays[report.lane];
  }

  /// Resolves a reported test. If it is its ray's nearest hit so far, shortens or ends the ray.
  void offer(const Half& half, const HitReport& report) {
    Packet& packet = packets_[half.owner[report.bundle]];
    const std::uint32_t number = ray_of(half, report);
    const LaneMask lane = 1u << report.lane;
    if ((packet.ended & lane) != 0 ||
        !take_if_nearest(bvh_, rays_[number], query_.t_max_of(number), report.hit, report.is_sure,
                         hits_[number], counters_)) {
      return;
    }
    const bool ends = !query_.any_hit_before.empty() &&
                      is_before(bvh_, rays_[number], hits_[number], query_.any_hit_before[number]);
    counters_.ended_early += ends;
    if (ends) packet.ended |= lane;
    packet.traversal.set_cutoff(static_cast<int>(report.lane), ends ? -1.0 : hits_[number].t.high);
  }

  /// Tests all other triangles of the bundle exactly after a sure hit was ignored (skip_ids): the
  /// burst may not have reported hits that are surely farther than the ignored one.
  void offer_hidden(const Half& half, const HitReport& ignored) {
    const RayBundle& bundle = half.batch[ignored.bundle];
    if (ignored.hit.t.low >= query_.t_max_of(ray_of(half, ignored))) return;
    for (std::uint32_t tag = bundle.first_tag; tag < bundle.first_tag + bundle.record_count;
         ++tag) {
      if (tag == ignored.hit.primitive) continue;
      offer(half, {ignored.bundle, ignored.lane, false, {.primitive = tag}});
    }
  }

  /// Offers sure hits before doubts: then most doubts are surely farther and need no exact test.
  void merge(const Half& half) {
    for (const bool is_sure : {true, false}) {
      for (const HitReport& report : reports_) {
        if (report.is_sure != is_sure) continue;
        const bool is_ignored = !query_.skip_ids.empty() &&
                                query_.skip_ids[ray_of(half, report)] == report.hit.primitive;
        if (!is_ignored) {
          offer(half, report);
        } else if (is_sure) {
          offer_hidden(half, report);
        }
      }
    }
  }

  void count_work(const Half& half) {
    for (std::size_t i = 0; i < half.batch.size(); ++i) {
      for (const int lane : SetBits(half.batch[i].lanes)) {
        const std::uint32_t ray = packets_[half.owner[i]].rays[lane];
        query_.work[ray].tests += half.batch[i].record_count;
      }
    }
    for (const HitReport& report : reports_) {
      query_.work[ray_of(half, report)].doubts += report.is_sure ? 0 : 1;
    }
  }

  const Bvh& bvh_;
  std::shared_ptr<HitTester> tester_;
  IntersectCounters counters_;  // without the tester's counts
  std::span<const Ray> rays_;
  RayQuery query_;
  std::span<NearestHit> hits_;
  // Reused for all queries.
  std::vector<Packet> packets_;
  std::array<Half, 2> halves_;
  HitReports reports_;
};

}  // namespace

std::unique_ptr<Intersector> make_unit_intersector(const Bvh& bvh,
                                                   std::shared_ptr<HitTester> tester) {
  return std::make_unique<UnitIntersector>(bvh, std::move(tester));
}

}  // namespace raygate
