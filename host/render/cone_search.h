// Rays of one origin, tested in place: cones of up to 64 rays walk the tree as one.
#pragma once

#include <cstdint>
#include <span>

#include "host/accel/bvh.h"
#include "host/hit/hit_tester.h"
#include "host/render/cone.h"
#include "host/render/nearest_hits.h"
#include "host/render/record_cache.h"
#include "host/render/search_wishes.h"

namespace raygate {

/// Finds what a Wavefront finds through a tester with CpuBurstUnit behind it, with the unit's own
/// formulas, but without batches: a leaf's records are tested while they are at hand, against
/// those of eight groups of eight rays whose cone they meet at all. Decisions are the same, as
/// what float32 leaves open is settled by NearestHits.
class ConeSearch {
 public:
  /// Reports go to `nearest`, counts to `counters`.
  ConeSearch(const Bvh& bvh, RecordCache& records, NearestHits& nearest, HitCounters& counters)
      : bvh_(bvh), records_(records), nearest_(nearest), counters_(counters) {}

  /// All rays begin at the origin of the records. `nearest` has been reset for them.
  void trace(std::span<const Ray> rays, const SearchWishes& wishes);

  /// Rays that SearchWishes::enough_before has ended before their time.
  [[nodiscard]] std::uint64_t ended_early() const { return ended_early_; }

 private:
  static constexpr int kGroups = RayBlock::kGroups;

  /// Rays on their way. Distances are the bits of floats: positive floats are in the order of
  /// their bits.
  struct Walk {
    const RayBlock* block;
    Cones cones;
    FloatLanes slack;  ///< lane g: the factor by which an edge's bound grows for all of group g
    Beams ray_beams[kGroups];              ///< around each ray, where a group has been split
    IntLanes low[kGroups], high[kGroups];  ///< of each ray: bounds of the nearest hit's t
    IntLanes slot[kGroups];                ///< of the nearest hit; -1: none
    IntLanes ignored[kGroups];             ///< a slot; -1: none
    IntLanes enough[kGroups];              ///< a hit that is surely before is enough
    std::uint32_t first;                   ///< the number of the block's first ray
  };

  friend void walk_tree(ConeSearch& search, Walk& walk);
  friend void set_out(const ConeSearch& search, Walk& walk);
  friend void split_group(Walk& walk, int group);

  static std::uint32_t number(const Walk& walk, int group, int lane) {
    return walk.first + static_cast<std::uint32_t>(group * kLanes + lane);
  }
  static Interval bounds(const Walk& walk, int group, int lane);

  void trace_cones(Walk& walk);
  bool settle(Walk& walk, int group, int lane, std::int32_t slot, const Interval* sure);
  void finish(const Walk& walk, LaneMask groups);

  const Bvh& bvh_;
  RecordCache& records_;
  NearestHits& nearest_;
  HitCounters& counters_;
  SearchWishes wishes_;
  std::span<const Ray> rays_;
  std::uint64_t ended_early_ = 0;
};

}  // namespace raygate
