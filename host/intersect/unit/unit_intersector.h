// Unit intersector: collects leaf tests in batches for a hit-test unit while other rays traverse;
// the polygon records of common origins are cached.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "host/bvh/packet_traversal.h"
#include "host/intersect/intersector.h"
#include "host/intersect/unit/hit_tester.h"

namespace raygate {

/// One record per primitive of the BVH, made leaf by leaf. Thread-safe. Takes 65 bytes per
/// primitive; untouched pages take no memory.
class RecordCache {
 public:
  RecordCache(const Bvh& bvh, const glm::vec3& origin);

  [[nodiscard]] const glm::vec3& origin() const { return origin_; }

  /// Returns the records of primitives [first, first + count), at least one. Adds the number of
  /// records that had to be made to `made`.
  [[nodiscard]] const PolygonRecord* leaf(std::uint32_t first, std::uint32_t count,
                                          std::uint64_t& made) {
    for (std::uint32_t primitive = first; primitive < first + count; ++primitive) {
      if (!is_made_[primitive].load(std::memory_order_acquire)) {
        made += make(first, count);
        break;
      }
    }
    return records_.get() + first;
  }

 private:
  struct Free {
    void operator()(void* memory) const;
  };

  std::uint64_t make(std::uint32_t first, std::uint32_t count);

  const Bvh& bvh_;
  glm::vec3 origin_;
  std::unique_ptr<PolygonRecord[], Free> records_;
  std::unique_ptr<std::atomic<bool>[]> is_made_;  // by primitive
  std::mutex mutex_;                              // of the thread that makes records
};

/// The caches of all common origins of a scene, each made on first use. Thread-safe.
class RecordCaches {
 public:
  /// `on_first_touch`: records are made when a ray approaches their polygon, otherwise all records
  /// of an origin at once. `bvh` must outlive this object.
  explicit RecordCaches(const Bvh& bvh, bool on_first_touch = true)
      : bvh_(bvh), on_first_touch_(on_first_touch) {}

  /// Returns the cache of an origin. Adds the number of records that had to be made to `made`.
  [[nodiscard]] RecordCache& at(const glm::vec3& origin, std::uint64_t& made);

 private:
  const Bvh& bvh_;
  bool on_first_touch_;
  std::mutex mutex_;
  std::map<std::array<std::uint32_t, 3>, RecordCache> caches_;  // by the origin's bits
};

/// In each round every packet of eight rays traverses the tree to its next leaf. The tests of all
/// these leaves form a batch for the tester, whose results shorten the rays. Packets are split into
/// two halves: one traverses while the tester works on the other.
///
/// Polygon records of a common origin are cached. Other records are made when a ray reaches a leaf,
/// once for all rays of its packet with the same origin.
class UnitIntersector : public Intersector {
 public:
  /// `caches` can be shared by intersectors; null: own caches. `bvh` must outlive this object.
  UnitIntersector(const Bvh& bvh, std::shared_ptr<HitTester> tester,
                  std::shared_ptr<RecordCaches> caches = nullptr);

  [[nodiscard]] IntersectCounters counters() const override;

 private:
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits) override;
  /// Up to eight rays of one octant.
  struct Packet {
    Packet(const Bvh& bvh, int octant) : traversal(bvh, octant) {}

    PacketTraversal traversal;
    std::array<std::uint32_t, kLanes> rays;  // ray indices; lanes without a ray repeat lane 0
    LaneMask lanes = 0;
    LaneMask ended = 0;                // rays ended early
    std::uint32_t next_primitive = 0;  // without culling: the next primitive
  };

  /// Half of the packets, with their batch.
  struct Half {
    std::vector<std::uint32_t> active;  // packets that continue
    std::vector<RayBundle> batch;
    std::vector<std::uint32_t> owner;    // index of the packet of each bundle
    std::vector<PolygonRecord> records;  // of rays with different origins, in the batch's order
    bool started = false;                // the tester is working on the batch
  };

  void make_packets();
  LeafVisits next_leaf(Packet& packet);
  void collect(Half& half);
  std::size_t visit_leaves(Half& half);
  void make_own_records(Half& half);
  [[nodiscard]] std::uint32_t ray_of(const Half& half, const HitReport& report) const;
  void offer(const Half& half, const HitReport& report);
  void offer_hidden(const Half& half, const HitReport& ignored);
  void finish(Half& half);
  void merge(const Half& half);
  void count_work(const Half& half);

  const Bvh& bvh_;
  std::shared_ptr<HitTester> tester_;
  std::shared_ptr<RecordCaches> caches_;
  IntersectCounters counters_;  // without the tester's counts
  std::span<const Ray> rays_;
  RayQuery query_;
  std::span<NearestHit> hits_;
  RecordCache* common_ = nullptr;
  // Reused for all queries.
  std::vector<Packet> packets_;
  std::array<Half, 2> halves_;
  HitReports reports_;
};

}  // namespace raygate
