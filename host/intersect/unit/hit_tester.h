// Hit tester: decides batches of rays against polygon records, by a hit-test unit and software.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "host/base/lanes.h"
#include "host/intersect/intersect_counters.h"
#include "host/intersect/polygon_record.h"

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

/// Tests batches of bundles, either at once (run) or in two steps (start and finish), so that a
/// unit need not run empty while its user thinks.
template <class Results>
class BatchTester {
 public:
  virtual ~BatchTester() = default;

  /// Tests all bursts of `batch` and adds what it found to `results`, in the order of the batch.
  /// Not between a start and its finish.
  virtual void run(std::span<const RayBundle> batch, Results& results) = 0;

  /// At most two batches may be started and not finished; each must live until its finish. A finish
  /// is that of the oldest one. Where two steps gain nothing, all is done in finish.
  virtual void start(std::span<const RayBundle> batch) {
    assert(started_count_ < 2);
    started_[started_count_++] = batch;
  }
  virtual void finish(Results& results) { run(pop_started(), results); }

  /// Batches of fewer tests leave the unit mostly empty: they are worth lengthening by tests that
  /// may turn out to be behind a hit.
  [[nodiscard]] virtual std::size_t enough_tests() const { return 0; }

 protected:
  std::span<const RayBundle> pop_started() {
    assert(started_count_ > 0);
    --started_count_;
    return std::exchange(started_[0], started_[1]);
  }

 private:
  std::span<const RayBundle> started_[2];
  int started_count_ = 0;
};

/// A hit-test unit and the software around it. One thread each.
///
/// Promises: a sure hit is a hit and an unreported pair a miss (or farther than a sure hit
/// of its burst) in exact arithmetic on the records' coordinates; P has the unit's bits.
/// Which pairs are in doubt may differ between engines; decisions made from the reports do not.
class HitTester : public BatchTester<HitResults> {
 public:
  [[nodiscard]] virtual HitCounters counters() const = 0;
};

}  // namespace raygate
