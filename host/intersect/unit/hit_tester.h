// Batches of rays against polygon records: a hit-test unit and what its host does around it.
#pragma once

#include <cassert>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/base/lanes.h"
#include "host/intersect/intersect_counters.h"
#include "host/intersect/unit/polygon_record.h"

namespace raygate {

/// Up to eight rays that meet the same run of records: eight bursts of tests, stored as one.
/// The burst of lane k is direction k against records[0 .. record_count), in this order.
struct alignas(32) RayBundle {
  float direction[3][kLanes];              ///< x, y, z of each lane; scaled (see is_scaled)
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
  glm::vec3 point{0.0f};     ///< P = d I / (I . N) relative to the origin, in the unit's bits
  float point_error = 0.0f;  ///< as NearestHit has it
  Interval t{};              ///< high = +infinity where float32 says nothing
};

/// A polygon that float32 can neither call hit nor missed: for exact arithmetic to resolve.
struct Doubt {
  std::uint32_t bundle = 0;
  std::uint32_t lane = 0;
  std::uint32_t tag = 0;
  glm::vec3 point{0.0f};     ///< as in SureHit, should it be a hit
  float point_error = 0.0f;  ///< likewise
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

/// A unit and its host. Not for use by two threads at once: each thread makes its own.
///
/// What it promises: a sure hit is a hit and an unreported pair a miss (or farther than a sure hit
/// of its burst) in exact arithmetic on the records' coordinates; P has the unit's bits.
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

  /// Batches of fewer tests leave the unit mostly empty: they are worth lengthening by tests that
  /// may turn out to be behind a hit.
  [[nodiscard]] virtual std::size_t enough_tests() const { return 0; }

  [[nodiscard]] virtual HitCounters counters() const = 0;

 protected:
  StartedBatches started_;
};

}  // namespace raygate
