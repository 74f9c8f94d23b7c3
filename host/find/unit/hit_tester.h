// What finds hits: batches of rays against polygon records, whichever engine does the work.
#pragma once

#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/find/unit/polygon_record.h"
#include "host/lanes.h"

namespace raygate {

/// Up to eight rays that meet the same run of records: eight bursts of tests, stored as one.
/// The burst of lane k is direction k against records[0 .. record_count), in this order.
struct alignas(32) RayBundle {
  float direction[3][kLanes];              ///< x, y, z of each lane; scaled (see scaled_direction,
                                           ///< host/scene/camera.h)
  const PolygonRecord* records = nullptr;  ///< made for the origin of these rays
  std::uint32_t record_count = 0;
  std::uint32_t first_tag = 0;  ///< the caller's name of records[0]; records[i] is first_tag + i
  LaneMask lanes = 0;           ///< bit k: lane k holds a ray

  [[nodiscard]] glm::vec3 lane_direction(int lane) const {
    return {direction[0][lane], direction[1][lane], direction[2][lane]};
  }
};

/// A polygon that a ray surely hits, ahead of its origin.
struct SureHit {
  std::uint32_t bundle = 0;  ///< index into the batch
  std::uint32_t lane = 0;
  std::uint32_t tag = 0;
  glm::vec3 point{0.0f};  ///< P = d I / (I . N) relative to the origin, in the plane unit's bits
  Interval t{};           ///< high = +infinity where float32 says nothing
};

/// A polygon that float32 can neither call hit nor missed: for exact arithmetic to settle.
struct Doubt {
  std::uint32_t bundle = 0;
  std::uint32_t lane = 0;
  std::uint32_t tag = 0;
  glm::vec3 point{0.0f};  ///< as in SureHit, should it be a hit
};

/// What a batch gave. Bursts without a hit or doubt leave nothing here.
struct HitResults {
  /// The sure hits that may be their burst's nearest: one, or as many as float32 cannot order.
  std::vector<SureHit> hits;
  std::vector<Doubt> doubts;

  void clear() {
    hits.clear();
    doubts.clear();
  }
};

/// What a tester has done since it was made.
struct HitCounters {
  std::uint64_t tests = 0;         ///< (ray, record) pairs; misses + hits + edge_doubts
  std::uint64_t misses = 0;        ///< surely missed
  std::uint64_t hits = 0;          ///< surely hit
  std::uint64_t edge_doubts = 0;   ///< neither
  std::uint64_t depth_doubts = 0;  ///< sure hits reported because float32 cannot order them
  std::uint64_t plane_tests = 0;   ///< divisions d I / (I . N) asked of the unit
  std::uint64_t unit_tests = 0;    ///< tests that went through the unit
  std::uint64_t quotients = 0;     ///< divisions that the unit did
  std::uint64_t input_bytes = 0;   ///< of the words that the unit took: records, or rays and planes
  std::uint64_t clocks = 0;        ///< simulated clock cycles; 0 where nothing is simulated

  // Clocks of the unit's lanes without a new test, by cause; only the pipelined unit has any.
  std::uint64_t idle_clocks = 0;    ///< no test was there
  std::uint64_t output_stalls = 0;  ///< a result was not taken

  HitCounters& operator+=(const HitCounters& other);
};

/// One or two batches that wait to be finished, in the order of their start.
class StartedBatches {
 public:
  void push(std::span<const RayBundle> batch) {
    assert(count_ < 2);
    batches_[count_++] = batch;
  }
  std::span<const RayBundle> pop() {
    assert(count_ > 0);
    const std::span<const RayBundle> oldest = batches_[0];
    batches_[0] = batches_[1];
    --count_;
    return oldest;
  }

 private:
  std::span<const RayBundle> batches_[2];
  int count_ = 0;
};

/// One engine. Not for use by two threads at once: each thread makes its own.
///
/// What it promises: a sure hit is a hit and an unreported pair a miss (or farther than a sure hit
/// of its burst) in exact arithmetic on the records' coordinates; P has the plane unit's bits.
/// Which pairs are in doubt may differ between engines; decisions made from the reports do not.
class HitTester {
 public:
  virtual ~HitTester() = default;

  /// Tests all bursts of `batch` and adds what it found to `results`, in the order of the batch.
  virtual void test(std::span<const RayBundle> batch, HitResults& results) = 0;

  /// The same in two steps, as of a BurstUnit: two batches at most on their way, the oldest one
  /// finished first.
  virtual void start(std::span<const RayBundle> batch) { started_.push(batch); }
  virtual void finish(HitResults& results) { test(started_.pop(), results); }

  /// Where the caller may do this engine's tests itself, one by one as it comes to them, with the
  /// same promise: the counts to add them to. Else nullptr.
  [[nodiscard]] virtual HitCounters* in_place() { return nullptr; }

  [[nodiscard]] virtual HitCounters counters() const = 0;

 protected:
  StartedBatches started_;
};

}  // namespace raygate
