#include "host/intersect/unit/pipeline_hit_tester.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>

#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {
namespace {

/// The floats around t that are as far off as its error allows.
Interval around(const HitDistance& distance) {
  constexpr std::uint32_t kInfinity = 0x7F800000;
  const auto bits = std::bit_cast<std::uint32_t>(distance.t);
  const std::uint32_t margin = 64u << distance.error;
  return {std::bit_cast<float>(bits - std::min(bits, margin)),
          std::bit_cast<float>(std::min(bits + margin, kInfinity))};
}

/// The bundle that a unit's word is about. Throws std::runtime_error where there is none, or it has
/// no such lane or record: the unit is broken.
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
  // A burst's near ties come before the hit that was kept, so that its sure hits are together.
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

}  // namespace raygate
