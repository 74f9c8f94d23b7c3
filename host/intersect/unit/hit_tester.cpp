#include "host/intersect/unit/hit_tester.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace raygate {
namespace {

/// Returns the bundle of a unit's result. Throws std::runtime_error if the bundle, its lane or its
/// record does not exist, which means that the unit is broken.
const RayBundle& bundle_of(const BurstResult& result, std::span<const RayBundle> batch) {
  if (result.bundle >= batch.size() || result.lane >= kLanes ||
      result.record >= batch[result.bundle].record_count) {
    throw std::runtime_error("hit-test unit: found record " + std::to_string(result.record) +
                             " of lane " + std::to_string(result.lane) + " of bundle " +
                             std::to_string(result.bundle) + ", expected one that it was given");
  }
  return batch[result.bundle];
}

/// Returns bounds of the exact t = d / (I . N) of a sure hit, for the direction I and the record's
/// d and normal N. The bound of an edge test also holds for I . N, because N is rounded like edges.
/// The factors 1 +- 2^-23 cover the relative error of d, at most 2^-24 + 2^-32 (plane_distance),
/// and the rounding of the computations here.
Interval distance_bounds(const PolygonRecord& record, const glm::vec3& direction) {
  const double dot = std::abs((record.normal.x * direction.x + record.normal.y * direction.y) +
                              record.normal.z * direction.z);
  const glm::dvec3 n = glm::abs(glm::dvec3(record.normal));
  const double error = kEdgeBound * 0x1p-24 * (n.x + n.y + n.z);
  const double d = std::abs(record.d);
  return {(1.0 - 0x1p-23) * d / (dot + error), dot > error
                                                   ? (1.0 + 0x1p-23) * d / (dot - error)
                                                   : std::numeric_limits<double>::infinity()};
}

}  // namespace

void PipelineHitTester::start(std::span<const RayBundle> batch) {
  HitTester::start(batch);
  unit_->start(batch);
}

void PipelineHitTester::finish(HitReports& reports) {
  using Kind = BurstResult::Kind;
  const std::span<const RayBundle> batch = pop_started();
  results_.clear();
  unit_->finish(results_);
  for (const BurstResult& result : results_) {
    const RayBundle& bundle = bundle_of(result, batch);
    const PolygonRecord& record = bundle.records[result.record];
    const glm::vec3 direction = bundle.lane_direction(static_cast<int>(result.lane));
    const bool is_hit = result.kind == Kind::kHit;
    NearestHit hit{.primitive = bundle.first_tag + result.record};
    set_point(record, direction, hit);
    if (is_hit) {
      hit.point = result.point;
      hit.t = around({result.t, result.t_error}, Binary32());
    }
    if (result.kind == Kind::kNearTie) {
      hit.t = around(ReferenceBurstUnit().distance(record, direction), Binary32());
    }
    reports.push_back({result.bundle, result.lane, result.kind != Kind::kDoubt, hit});
  }
}

HitCounters PipelineHitTester::counters() const {
  HitCounters counters = unit_->counters();
  counters.unit_tests = counters.tests;
  return counters;
}

HitCounters SerialHitTester::counters() const {
  HitCounters counters = counters_;
  counters.unit_tests = counters.plane_tests;
  counters.clocks = unit_->clocks();
  return counters;
}

void SerialHitTester::finish(HitReports& reports) {
  const std::span<const RayBundle> batch = pop_started();
  pairs_.clear();
  plane_tests_.clear();
  for (std::uint32_t i = 0; i < batch.size(); ++i) collect(i, batch[i]);
  points_.resize(plane_tests_.size());
  unit_->intersect(plane_tests_, points_);
  counters_.plane_tests += plane_tests_.size();
  std::size_t first = reports.size();  // index of the burst's first report
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const auto& [index, lane, number, verdict] = pairs_[i];
    if (i != 0 && (pairs_[i - 1].bundle != index || pairs_[i - 1].lane != lane)) {
      drop_farther(reports, first);
      first = reports.size();
    }
    const RayBundle& bundle = batch[index];
    const PolygonRecord& record = bundle.records[number];
    const glm::vec3& direction = plane_tests_[i].direction;
    const bool is_sure = verdict == UnitVerdict::kHit;
    NearestHit hit{.primitive = bundle.first_tag + number};
    set_point(record, direction, hit);
    hit.point = points_[i];
    if (adapt_point_error_) adapt_point_error_(record, direction, hit);
    if (is_sure) hit.t = distance_bounds(record, direction);
    reports.push_back({index, lane, is_sure, hit});
  }
  drop_farther(reports, first);
}

void SerialHitTester::collect(std::uint32_t index, const RayBundle& bundle) {
  const ReferenceBurstUnit software;
  for (const int lane : SetBits(bundle.lanes)) {
    const glm::vec3 direction = bundle.lane_direction(lane);
    for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
      const PolygonRecord& record = bundle.records[i];
      const UnitVerdict verdict = software.edges_verdict(record, direction);
      count(verdict, counters_);
      if (verdict == UnitVerdict::kMiss) continue;
      pairs_.push_back({index, static_cast<std::uint32_t>(lane), i, verdict});
      plane_tests_.push_back({direction, record.normal, record.d});
    }
  }
}

/// Drops each sure hit of a burst that is surely farther than another sure hit of this burst.
void SerialHitTester::drop_farther(HitReports& reports, std::size_t first) {
  const std::span burst = std::span(reports).subspan(first);
  double nearest = std::numeric_limits<double>::infinity();  // upper bound of the nearest hit's t
  for (const HitReport& report : burst) {
    if (report.is_sure) nearest = std::min(nearest, report.hit.t.high);
  }
  const auto dropped = std::ranges::remove_if(
      burst, [&](const HitReport& report) { return report.is_sure && report.hit.t.low > nearest; });
  reports.resize(reports.size() - dropped.size());
  const auto left = static_cast<std::uint64_t>(
      std::count_if(reports.begin() + static_cast<std::ptrdiff_t>(first), reports.end(),
                    [](const HitReport& report) { return report.is_sure; }));
  if (left > 1) counters_.depth_doubts += left;
}

}  // namespace raygate
