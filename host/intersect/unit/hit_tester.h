// Hit testers: hit-test units, simulated or as reference models, with the software around them.
// Also the intersector that uses hit testers.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "host/intersect/intersector.h"
#include "host/intersect/unit/burst_unit.h"

namespace raygate {

/// A test that may be the nearest hit of its ray.
struct HitReport {
  std::uint32_t bundle = 0;  ///< index into the batch
  std::uint32_t lane = 0;
  bool is_sure = false;  ///< a hit in front of the origin; otherwise exact arithmetic decides
  /// `primitive` is the record's tag. `point` has the unit's bits and is valid if the triangle is
  /// hit. `t` is valid if the hit is sure; t.high is +infinity if binary32 gives no bound.
  NearestHit hit;
};

/// Reports of a batch: for each burst its doubts, and its nearest sure hit or several sure hits
/// that binary32 cannot order.
using HitReports = std::vector<HitReport>;

/// Tests batches with a hit-test unit. Each thread has its own tester.
///
/// In exact arithmetic on the records' coordinates, a sure hit is a hit, and a test that is not
/// reported is a miss or farther than a sure hit of its burst. Engines may differ in the doubts.
class HitTester : public BatchTester<HitReport> {
 public:
  [[nodiscard]] virtual HitCounters counters() const = 0;
};

/// The pipelined unit decides everything except doubts. Software computes the hit points of doubts
/// and near ties, and t of near ties, by the same formulas.
class PipelineHitTester : public HitTester {
 public:
  explicit PipelineHitTester(std::unique_ptr<BurstUnit> unit) : unit_(std::move(unit)) {}

  void start(std::span<const RayBundle> batch) override;
  void finish(HitReports& reports) override;
  [[nodiscard]] std::size_t enough_tests() const override { return unit_->enough_tests(); }
  [[nodiscard]] HitCounters counters() const override;

 protected:
  std::unique_ptr<BurstUnit> unit_;
  BurstResults results_;  // reused for all batches
};

/// The paper's unit intersects a ray with a polygon's plane; software decides whether the point is
/// inside the polygon and which hit is nearest. Unlike in the paper, pairs that the edge planes
/// exclude are not sent to the unit.
class SerialHitTester : public HitTester {
 public:
  /// Replaces hit.point_error, made for binary32, by the error in the unit's format.
  using Adapt =
      std::function<void(const PolygonRecord& record, const glm::vec3& direction, NearestHit& hit)>;

  explicit SerialHitTester(std::unique_ptr<PlaneUnit> unit, Adapt adapt_point_error = {})
      : unit_(std::move(unit)), adapt_point_error_(std::move(adapt_point_error)) {}

  void finish(HitReports& reports) override;
  [[nodiscard]] HitCounters counters() const override;

 private:
  /// A (ray, polygon) pair that is sent to the unit.
  struct Pair {
    std::uint32_t bundle, lane, record;
    UnitVerdict verdict;
  };

  void collect(std::uint32_t index, const RayBundle& bundle);
  void drop_farther(HitReports& reports, std::size_t first);

  std::unique_ptr<PlaneUnit> unit_;
  Adapt adapt_point_error_;
  HitCounters counters_;
  // Reused for all batches.
  std::vector<Pair> pairs_;  // ordered by bundle, lane and record
  std::vector<PlaneTest> plane_tests_;
  std::vector<glm::vec3> points_;
};

/// Returns an intersector that collects leaf tests in batches for the tester while other rays
/// traverse. `bvh` must outlive it.
[[nodiscard]] std::unique_ptr<Intersector> make_unit_intersector(const Bvh& bvh,
                                                                 std::shared_ptr<HitTester> tester);

}  // namespace raygate
