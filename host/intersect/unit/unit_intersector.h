// Unit intersector: collects leaf tests in batches for a hit-test unit while other rays traverse.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/bvh/packet_traversal.h"
#include "host/intersect/intersector.h"
#include "host/intersect/unit/hit_tester.h"

namespace raygate {

/// In each round every packet of eight rays traverses the tree to its next leaf. The tests of all
/// these leaves form a batch for the tester, whose results shorten the rays. One half of the
/// packets traverses while the tester works on the other. Polygon records are made when a ray
/// reaches a leaf, once for all rays of its packet with the same origin.
class UnitIntersector : public Intersector {
 public:
  /// `bvh` must outlive this object.
  UnitIntersector(const Bvh& bvh, std::shared_ptr<HitTester> tester);

  [[nodiscard]] IntersectCounters counters() const override;

 private:
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits) override;
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

  void make_packets();
  void collect(Half& half);
  std::size_t visit_leaves(Half& half);
  void make_records_of(Half& half);
  [[nodiscard]] std::uint32_t ray_of(const Half& half, const HitReport& report) const;
  void offer(const Half& half, const HitReport& report);
  void offer_hidden(const Half& half, const HitReport& ignored);
  void merge(const Half& half);
  void count_work(const Half& half);

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

}  // namespace raygate
