#include "host/intersect/unit/serial_hit_tester.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace raygate {
namespace {

/// Where the exact t of a sure hit is. N is rounded like an edge plane, so the bound of an edge
/// test holds for I . N too; d is off by 2^-24 + 2^-32 of itself at most (exact.h), which 2^-23
/// covers together with the roundings of these lines.
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

SerialHitTester::SerialHitTester(std::unique_ptr<PlaneUnit> unit, Order order)
    : unit_(std::move(unit)), order_(order) {}

HitCounters SerialHitTester::counters() const {
  HitCounters counters = counters_;
  counters.unit_tests = counters.plane_tests;
  counters.quotients = 3 * counters.plane_tests;
  counters.input_bytes = counters.plane_tests * sizeof(PlaneTest);
  counters.clocks = unit_->clocks();
  return counters;
}

void SerialHitTester::run(std::span<const RayBundle> batch, HitResults& results) {
  pairs_.clear();
  plane_tests_.clear();
  for (std::uint32_t i = 0; i < batch.size(); ++i) collect(i, batch[i]);
  points_.resize(plane_tests_.size());
  unit_->intersect(plane_tests_, points_);
  counters_.plane_tests += plane_tests_.size();
  for (std::size_t first = 0, last; first < pairs_.size(); first = last) {
    last = first + 1;
    while (last < pairs_.size() && pairs_[last].bundle == pairs_[first].bundle &&
           pairs_[last].lane == pairs_[first].lane) {
      ++last;
    }
    report_burst(batch, first, last, results);
  }
}

void SerialHitTester::collect(std::uint32_t index, const RayBundle& bundle) {
  const ReferenceBurstUnit software;
  for (LaneMask lanes = bundle.lanes; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const glm::vec3 direction = bundle.lane_direction(lane);
    for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
      const PolygonRecord& record = bundle.records[i];
      const UnitVerdict verdict = software.edges_verdict(record, direction);
      ++counters_.tests;
      counters_.misses += verdict == UnitVerdict::kMiss;
      counters_.hits += verdict == UnitVerdict::kHit;
      counters_.edge_doubts += verdict == UnitVerdict::kDoubt;
      if (verdict == UnitVerdict::kMiss && order_ == Order::kEdgesFirst) continue;
      pairs_.push_back({index, static_cast<std::uint32_t>(lane), i, verdict});
      plane_tests_.push_back({direction, record.normal, record.d});
    }
  }
}

/// Pairs [first, last) are one ray's: its sure hits that no other surely precedes, and its doubts.
void SerialHitTester::report_burst(std::span<const RayBundle> batch, std::size_t first,
                                   std::size_t last, HitResults& results) {
  const std::size_t first_hit = results.hits.size();
  double nearest = std::numeric_limits<double>::infinity();  // the nearest hit's t is at most this
  for (std::size_t i = first; i < last; ++i) {
    const auto& [index, lane, record, verdict] = pairs_[i];
    const RayBundle& bundle = batch[index];
    const std::uint32_t tag = bundle.first_tag + record;
    if (verdict == UnitVerdict::kMiss) continue;
    const glm::vec3 direction = bundle.lane_direction(static_cast<int>(lane));
    const float error = point_error(bundle.records[record], direction);
    if (verdict == UnitVerdict::kDoubt) {
      results.doubts.push_back({index, lane, tag, points_[i], error});
      continue;
    }
    const Interval t = distance_bounds(bundle.records[record], direction);
    if (t.low > nearest) continue;
    nearest = std::min(nearest, t.high);
    results.hits.push_back({index, lane, tag, points_[i], error, t});
  }
  if (results.hits.size() - first_hit < 2) return;
  results.hits.erase(
      std::remove_if(results.hits.begin() + static_cast<std::ptrdiff_t>(first_hit),
                     results.hits.end(), [&](const SureHit& hit) { return hit.t.low > nearest; }),
      results.hits.end());
  if (const std::size_t left = results.hits.size() - first_hit; left > 1) {
    counters_.depth_doubts += left;
  }
}

}  // namespace raygate
