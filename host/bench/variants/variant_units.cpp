#include "host/bench/variants/variant_units.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kTErrorUnit = 6;  // hit_test_pkg::TErrorUnit

/// The exponent field of the format's word.
int field(const Arithmetic& math, float x) {
  const std::uint32_t top = (1u << math.exponent_bits) - 1;
  return static_cast<int>(math.to_word(x) >> math.fraction_bits() & top);
}

/// How far V's exponent is below the largest of N's.
int grazing(const Arithmetic& math, const glm::vec3& n, float v) {
  return std::max({field(math, n.x), field(math, n.y), field(math, n.z)}) - field(math, v);
}

/// hit_test_pkg::max_grazing.
int max_grazing(const Arithmetic& math) { return std::max(math.fraction_bits() - 11, 0); }

}  // namespace

bool is_normal(const Arithmetic& math, float x) {
  const double magnitude = std::abs(static_cast<double>(x));
  return magnitude >= std::ldexp(1.0, math.min_exponent()) && std::isfinite(magnitude);
}

VariantDistance variant_distance(const Arithmetic& math, const PolygonRecord& record,
                                 const glm::vec3& direction) {
  const float v = math.dot(record.normal, direction);
  return {math.divide(record.d, v),
          static_cast<std::uint32_t>(std::max(grazing(math, record.normal, v), 0))};
}

glm::vec3 variant_point(const Arithmetic& math, const PolygonRecord& record,
                        const glm::vec3& direction) {
  const float v = math.dot(record.normal, direction);
  glm::vec3 point;
  for (int k = 0; k < 3; ++k) point[k] = math.divide(math.multiply(record.d, direction[k]), v);
  return point;
}

UnitVerdict VariantBurstUnit::verdict(const PolygonRecord& record,
                                      const glm::vec3& direction) const {
  const float v = math_.dot(record.normal, direction);
  const UnitVerdict verdict = decide(record, direction, v);
  if (verdict != UnitVerdict::kHit) return verdict;
  const float t = math_.divide(record.d, v);
  return is_normal(math_, t) && t > 0.0f ? UnitVerdict::kHit : UnitVerdict::kDoubt;
}

UnitVerdict VariantBurstUnit::decide(const PolygonRecord& record, const glm::vec3& direction,
                                     float v) const {
  if (record.d == 0.0f) return UnitVerdict::kMiss;
  const bool side = std::signbit(record.d);
  bool all_sure = true;
  for (int k = 0; k < 3; ++k) {
    const float u = math_.dot(record.edges[k], direction);
    const float bound = record.bounds[k];
    const bool sure = !std::signbit(bound) && std::abs(u) > bound && std::abs(u) < kInfinity;
    if (sure && std::signbit(u) != side) return UnitVerdict::kMiss;
    all_sure = all_sure && sure;
  }
  const bool divisible = is_normal(math_, v) && std::signbit(v) == side &&
                         grazing(math_, record.normal, v) <= max_grazing(math_);
  return all_sure && divisible ? UnitVerdict::kHit : UnitVerdict::kDoubt;
}

void VariantBurstUnit::run(std::span<const RayBundle> batch, BurstResults& results) {
  for (std::uint32_t i = 0; i < batch.size(); ++i) {
    for (LaneMask lanes = batch[i].lanes; lanes != 0; lanes &= lanes - 1) {
      run_burst(batch[i], i, static_cast<std::uint32_t>(std::countr_zero(lanes)), results);
    }
  }
}

void VariantBurstUnit::run_burst(const RayBundle& bundle, std::uint32_t index, std::uint32_t lane,
                                 BurstResults& results) {
  const glm::vec3 direction = bundle.lane_direction(static_cast<int>(lane));
  BurstHit best{index, lane, 0, 0.0f, 0, glm::vec3{0.0f}};
  bool found = false;
  const auto report = [&](std::uint32_t record, TestReport::Kind kind) {
    results.reports.push_back({index, lane, record, kind});
  };
  for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
    const PolygonRecord& record = bundle.records[i];
    const float v = math_.dot(record.normal, direction);
    UnitVerdict verdict = decide(record, direction, v);
    float t = 0.0f;
    std::uint32_t error = 0;
    if (verdict == UnitVerdict::kHit) {
      ++counters_.distances;
      t = math_.divide(record.d, v);
      error = static_cast<std::uint32_t>(std::max(grazing(math_, record.normal, v), 0));
      if (!is_normal(math_, t)) verdict = UnitVerdict::kDoubt;
    }
    ++counters_.tests;
    counters_.misses += verdict == UnitVerdict::kMiss;
    counters_.hits += verdict == UnitVerdict::kHit;
    counters_.doubts += verdict == UnitVerdict::kDoubt;
    if (verdict == UnitVerdict::kDoubt) report(i, TestReport::Kind::kDoubt);
    if (verdict != UnitVerdict::kHit) continue;
    const bool nearer = t < best.t;
    if (found) {
      const std::int64_t margin = (std::int64_t{1} << (kTErrorUnit + error)) +
                                  (std::int64_t{1} << (kTErrorUnit + best.t_error));
      const std::int64_t apart = static_cast<std::int64_t>(math_.to_word(t)) -
                                 static_cast<std::int64_t>(math_.to_word(best.t));
      if (std::abs(apart) <= margin) {
        ++counters_.near_ties;
        report(nearer ? best.record : i, TestReport::Kind::kNearTie);
      }
    }
    if (!found || nearer) {
      best.record = i;
      best.t = t;
      best.t_error = error;
      found = true;
    }
  }
  if (!found) return;
  best.point = variant_point(math_, bundle.records[best.record], direction);
  counters_.coordinates += 3;
  results.hits.push_back(best);
}

void VariantPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const glm::vec3 direction = math_.read(tests[i].direction),
                    normal = math_.read(tests[i].normal);
    const float d = math_.read(tests[i].d);
    // The accumulator starts from +0.
    float dot = math_.add(0.0f, math_.multiply(normal.x, direction.x));
    dot = math_.add(dot, math_.multiply(normal.y, direction.y));
    dot = math_.add(dot, math_.multiply(normal.z, direction.z));
    for (int k = 0; k < 3; ++k) {
      points[i][k] = math_.divide(math_.multiply(d, direction[k]), dot);
    }
  }
}

}  // namespace raygate
