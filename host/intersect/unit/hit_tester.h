// Hit tester: tests batches of rays against polygon records with a hit-test unit and software.
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

/// Up to eight rays to test against the same records: eight bursts, stored together. The burst of
/// lane k tests direction k against records [0, record_count), in this order.
struct alignas(32) RayBundle {
  float direction[3][kLanes];              ///< x, y, z of each lane; scaled (see is_scaled)
  const PolygonRecord* records = nullptr;  ///< made for the origin of these rays
  std::uint32_t record_count = 0;
  std::uint32_t first_tag = 0;  ///< tag of records[0]; records[i] has tag first_tag + i
  LaneMask lanes = 0;           ///< bit k: lane k holds a ray

  [[nodiscard]] glm::vec3 lane_direction(int lane) const {
    return {direction[0][lane], direction[1][lane], direction[2][lane]};
  }
};

/// A polygon that a ray surely hits, in front of its origin.
struct SureHit {
  std::uint32_t bundle = 0;  ///< index into the batch
  std::uint32_t lane = 0;
  std::uint32_t tag = 0;
  glm::vec3 point{0.0f};     ///< P = d I / (I . N) relative to the origin, in the unit's bits
  float point_error = 0.0f;  ///< as in NearestHit
  Interval t{};              ///< high = +infinity if binary32 gives no bound
};

/// A polygon that binary32 finds neither hit nor missed; exact arithmetic resolves it.
struct Doubt {
  std::uint32_t bundle = 0;
  std::uint32_t lane = 0;
  std::uint32_t tag = 0;
  glm::vec3 point{0.0f};     ///< as in SureHit, if it is a hit
  float point_error = 0.0f;  ///< as in SureHit
};

/// The results of a batch. Bursts without a hit or doubt have none.
struct HitResults {
  /// The possible nearest hits of each burst: one, or several that binary32 cannot order.
  std::vector<SureHit> hits;
  std::vector<Doubt> doubts;

  void clear() {
    hits.clear();
    doubts.clear();
  }
};

/// Tests batches of bundles, either at once (run) or in two steps (start and finish), so that the
/// unit is busy while the caller prepares the next batch.
template <class Results>
class BatchTester {
 public:
  virtual ~BatchTester() = default;

  /// Tests all bursts of `batch` and appends the results, in the order of the batch. Must not be
  /// called between start and finish.
  virtual void run(std::span<const RayBundle> batch, Results& results) = 0;

  /// Starts a batch, which must live until its finish(). At most two batches may be started and not
  /// finished; finish() completes the oldest. By default all work is done in finish().
  virtual void start(std::span<const RayBundle> batch) {
    assert(started_count_ < 2);
    started_[started_count_++] = batch;
  }
  virtual void finish(Results& results) { run(pop_started(), results); }

  /// Returns the number of tests below which a batch leaves the unit mostly idle, so that adding
  /// tests beyond known hits is worthwhile.
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

/// A hit-test unit and the software around it. Each thread has its own.
///
/// Guarantees: in exact arithmetic on the records' coordinates, a sure hit is a hit, and a pair
/// that is not reported is a miss or farther than a sure hit of its burst. P has the unit's bits.
/// Engines may differ in which pairs are in doubt, but not in the decisions that follow.
class HitTester : public BatchTester<HitResults> {
 public:
  [[nodiscard]] virtual HitCounters counters() const = 0;
};

}  // namespace raygate
