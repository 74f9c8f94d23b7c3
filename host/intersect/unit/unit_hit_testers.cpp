#include "host/intersect/unit/unit_hit_testers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace raygate {
namespace {

/// Returns the range of t within its error.
Interval around(const HitDistance& distance) {
  constexpr std::uint32_t kInfinity = 0x7F800000;
  const auto bits = std::bit_cast<std::uint32_t>(distance.t);
  const std::uint32_t margin = 64u << distance.error;
  return {std::bit_cast<float>(bits - std::min(bits, margin)),
          std::bit_cast<float>(std::min(bits + margin, kInfinity))};
}

/// Returns the bundle of a unit's result. Throws std::runtime_error if there is none, or if it has
/// no such lane or record, which means that the unit is broken.
template <class Word>
const RayBundle& bundle_of(const Word& word, std::span<const RayBundle> batch) {
  if (word.bundle >= batch.size() || word.lane >= kLanes ||
      word.record >= batch[word.bundle].record_count) {
    throw std::runtime_error("hit-test unit: found record " + std::to_string(word.record) +
                             " of lane " + std::to_string(word.lane) + " of bundle " +
                             std::to_string(word.bundle) + ", expected one that it was given");
  }
  return batch[word.bundle];
}

}  // namespace

PipelineHitTester::PipelineHitTester(std::unique_ptr<BurstUnit> unit) : unit_(std::move(unit)) {}

void PipelineHitTester::run(std::span<const RayBundle> batch, HitResults& results) {
  start(batch);
  finish(results);
}

void PipelineHitTester::start(std::span<const RayBundle> batch) {
  HitTester::start(batch);
  unit_->start(batch);
}

void PipelineHitTester::finish(HitResults& results) {
  const std::span<const RayBundle> batch = pop_started();
  found_.clear();
  unit_->finish(found_);
  auto report = found_.reports.begin();
  // Near ties of a burst precede its kept hit, so that its sure hits are adjacent.
  const auto take_reports = [&](auto belongs_here) {
    for (; report != found_.reports.end() && belongs_here(*report); ++report) {
      const RayBundle& bundle = bundle_of(*report, batch);
      const PolygonRecord& record = bundle.records[report->record];
      const glm::vec3 direction = bundle.lane_direction(static_cast<int>(report->lane));
      const std::uint32_t tag = bundle.first_tag + report->record;
      const auto [point, error] = plane_point(record, direction);
      if (report->kind == TestReport::Kind::kDoubt) {
        results.doubts.push_back({report->bundle, report->lane, tag, point, error});
      } else {
        results.hits.push_back({report->bundle, report->lane, tag, point, error,
                                around(hit_distance(record, direction))});
      }
    }
  };
  for (const BurstHit& hit : found_.hits) {
    take_reports([&](const TestReport& r) {
      return r.bundle != hit.bundle ? r.bundle < hit.bundle : r.lane <= hit.lane;
    });
    const RayBundle& bundle = bundle_of(hit, batch);
    const float error = point_error(bundle.records[hit.record],
                                    bundle.lane_direction(static_cast<int>(hit.lane)), hit.t_error);
    results.hits.push_back({hit.bundle, hit.lane, bundle.first_tag + hit.record, hit.point, error,
                            around({hit.t, hit.t_error})});
  }
  take_reports([](const TestReport&) { return true; });
}

HitCounters PipelineHitTester::counters() const { return hit_counters(unit_->counters()); }

HitCounters hit_counters(const BurstCounters& unit) {
  HitCounters counters;
  counters.tests = unit.tests;
  counters.misses = unit.misses;
  counters.hits = unit.hits;
  counters.edge_doubts = unit.doubts;
  counters.depth_doubts = unit.near_ties;
  counters.plane_tests = unit.coordinates / 3;
  counters.unit_tests = unit.tests;
  counters.quotients = unit.distances + unit.coordinates;
  counters.input_bytes = unit.tests * sizeof(PolygonRecord);
  counters.clocks = unit.clocks;
  counters.idle_clocks = unit.idle_clocks;
  counters.output_stalls = unit.output_stalls;
  return counters;
}

namespace {

/// Returns bounds of the exact t of a sure hit. N is rounded like an edge plane, so the bound of an
/// edge test also holds for I . N; the relative error of d is at most 2^-24 + 2^-32 (exact.h),
/// which 2^-23 covers together with the rounding of these lines.
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

/// Reports pairs [first, last), which belong to one ray: its doubts, and its sure hits that are not
/// surely farther than another one.
void SerialHitTester::report_burst(std::span<const RayBundle> batch, std::size_t first,
                                   std::size_t last, HitResults& results) {
  const std::size_t first_hit = results.hits.size();
  double nearest = std::numeric_limits<double>::infinity();  // upper bound of the nearest hit's t
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
