// Many rays in flight: while some wait for their hit tests, others walk the tree.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "host/find/nearest_hits.h"
#include "host/find/unit/hit_tester.h"
#include "host/find/unit/record_cache.h"
#include "host/tree/packet_traversal.h"

namespace raygate {

/// What a search is about, besides its rays. Spans are read during the search only.
struct Search {
  /// Where all rays begin at its origin, its records are used. Otherwise records are made for the
  /// leaf that a ray comes to, once for those rays of a packet that have one origin. Changes
  /// nothing of what is found. A tester that lets its caller test in place needs no records; rays
  /// of one origin then go as cones (ConeSearch), others one by one (RaySearch).
  RecordCache* common = nullptr;
  /// One a ray, positive: only hits with t < limits[i] count (see NearestHits::reset).
  std::span<const float> limits{};
  /// One a ray: a slot whose hits do not count, or NearestHit::kNone. With it, or with
  /// `enough_before`, NearestHit::point says nothing.
  std::span<const std::uint32_t> ignored{};
  /// One a ray, for rays that need not know their nearest hit: a ray ends at the first hit that it
  /// finds with t < enough_before[i]; that one is reported as the nearest.
  std::span<const float> enough_before{};
  /// False: every ray is tested against every polygon, whatever the boxes say.
  bool culling = true;
};

/// Traces many rays at once; some ten thousand are best. In each round every packet of eight goes
/// on to its next leaf; the leaves' tests together are one batch for the tester; its answers
/// shorten the rays. The packets are two halves: while the tester works on the one, the other goes
/// on. The unit sees few large batches, the host's memory a few packets.
class Wavefront {
 public:
  /// Where the time went.
  struct Seconds {
    double traverse = 0.0;  ///< boxes
    double record = 0.0;    ///< making polygon records
    double hit = 0.0;       ///< in HitTester::test, and merging its reports; of tests in place: all
    double doubt = 0.0;     ///< exact arithmetic about what they leave open
  };

  /// Batches of fewer than `enough_tests` are lengthened by leaves that may turn out to lie behind
  /// a hit: worth it where a batch has a price of its own, as of a pipeline that runs empty.
  Wavefront(const Bvh& bvh, HitTester& tester, std::size_t enough_tests = 0);

  /// Finds the nearest hit of each ray. Directions scaled (see scaled_direction); rays near each
  /// other in `rays` should go about the same way. Directions that are zero or not finite hit
  /// nothing. What a ray finds does not depend on the others.
  void trace(std::span<const Ray> rays, const Search& search = {});

  /// Of rays[number] of the last trace.
  [[nodiscard]] const NearestHit& nearest(std::size_t number) const { return nearest_[number]; }

  [[nodiscard]] const Seconds& seconds() const { return seconds_; }
  [[nodiscard]] const NearestHits::Counters& counters() const { return nearest_.counters(); }
  /// Whether that ray's nearest hit has t < limit (positive, finite), in exact arithmetic.
  [[nodiscard]] bool nearest_is_before(std::size_t number, const Ray& ray, float limit) {
    return nearest_.is_before(number, ray, limit);
  }

  /// Whether to count tests and doubts by ray from now on.
  void count_work(bool on) { counting_ = on; }
  /// One a ray of the last trace, if that was counted.
  struct Work {
    std::uint32_t tests = 0, doubts = 0;
  };
  [[nodiscard]] std::span<const Work> work() const { return work_; }
  /// Rays that Search::enough_before has ended before their time.
  [[nodiscard]] std::uint64_t ended_early() const { return ended_early_; }
  /// Records made for rays without a common origin.
  [[nodiscard]] std::uint64_t own_records() const { return own_records_; }

 private:
  /// Up to eight rays of one octant.
  struct Packet {
    Packet(const Bvh& bvh, int octant) : traversal(bvh, octant) {}

    PacketTraversal traversal;
    std::array<std::uint32_t, kLanes> rays;  // numbers; lanes without a ray repeat lane 0
    LaneMask lanes = 0;
    LaneMask ended = 0;           // early
    std::uint32_t next_slot = 0;  // without culling
  };

  /// Half of the packets, and their batch.
  struct Half {
    std::vector<std::uint32_t> active;  // packets still on their way
    std::vector<RayBundle> batch;
    std::vector<std::uint32_t> owner;    // the packet of each bundle
    std::vector<PolygonRecord> records;  // of rays of their own origins, in the batch's order
    bool started = false;                // the batch is with the tester
  };

  bool trace_in_place(std::span<const Ray> rays, const Search& search);
  void make_packets(std::span<const Ray> rays, const Search& search);
  std::optional<LeafVisit> next_visit(Packet& packet, const Search& search);
  void collect(std::span<const Ray> rays, const Search& search, Half& half);
  std::size_t visit_leaves(std::span<const Ray> rays, const Search& search, Half& half);
  void make_own_records(std::span<const Ray> rays, Half& half);
  template <class Report>
  void offer(std::span<const Ray> rays, const Search& search, const Half& half,
             const Report& report);
  void offer_hidden(std::span<const Ray> rays, const Search& search, const Half& half,
                    const SureHit& ignored);
  void finish(std::span<const Ray> rays, const Search& search, Half& half);
  void merge(std::span<const Ray> rays, const Search& search, const Half& half);
  void count_batch(const Half& half);

  const Bvh& bvh_;
  HitTester& tester_;
  std::size_t enough_tests_;
  NearestHits nearest_;
  Seconds seconds_;
  std::uint64_t own_records_ = 0, ended_early_ = 0;
  bool counting_ = false;
  std::vector<Work> work_;
  // Room to work in, kept from trace to trace.
  std::vector<Packet> packets_;
  std::array<Half, 2> halves_;
  HitResults results_;
};

}  // namespace raygate
