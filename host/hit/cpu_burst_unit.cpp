#include "host/hit/cpu_burst_unit.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kMaxGrazing = 12;    // exponents that V may be below N (hit_test_pkg::max_grazing)
constexpr int kTErrorUnit = 6;     // hit_test_pkg::TErrorUnit
constexpr int kMaxExponent = 255;  // that of infinities and NaNs

/// The hardware has one NaN; this machine's carries the sign and payload of an operand.
float canonical(float x) { return std::isnan(x) ? std::bit_cast<float>(0x7FC00000u) : x; }

int exponent(float x) { return static_cast<int>(std::bit_cast<std::uint32_t>(x) >> 23 & 0xFF); }

bool normal(float x) { return exponent(x) != 0 && exponent(x) != kMaxExponent; }

float dot(const glm::vec3& a, const glm::vec3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

/// How far V's exponent is below the largest of N's.
int grazing(const glm::vec3& n, float v) {
  return std::max({exponent(n.x), exponent(n.y), exponent(n.z)}) - exponent(v);
}

enum class Verdict { kMiss, kHit, kDoubt };

Verdict decide(const PolygonRecord& record, const glm::vec3& direction, float v) {
  if (record.d == 0.0f) return Verdict::kMiss;
  const bool side = std::signbit(record.d);
  bool all_sure = true;
  for (int k = 0; k < 3; ++k) {
    const float u = dot(record.edges[k], direction);
    const float bound = record.bounds[k];
    const bool sure = !std::signbit(bound) && std::abs(u) > bound && std::abs(u) < kInfinity;
    if (sure && std::signbit(u) != side) return Verdict::kMiss;
    all_sure = all_sure && sure;
  }
  const bool divisible =
      normal(v) && std::signbit(v) == side && grazing(record.normal, v) <= kMaxGrazing;
  return all_sure && divisible ? Verdict::kHit : Verdict::kDoubt;
}

/// For positive floats: how many lie from one to the other.
std::int64_t floats_between(float from, float to) {
  return static_cast<std::int64_t>(std::bit_cast<std::uint32_t>(to)) -
         static_cast<std::int64_t>(std::bit_cast<std::uint32_t>(from));
}

}  // namespace

bool operator==(const BurstHit& a, const BurstHit& b) {
  const auto same = [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  };
  return a.bundle == b.bundle && a.lane == b.lane && a.record == b.record && same(a.t, b.t) &&
         a.t_error == b.t_error && same(a.point.x, b.point.x) && same(a.point.y, b.point.y) &&
         same(a.point.z, b.point.z);
}

HitDistance hit_distance(const PolygonRecord& record, const glm::vec3& direction) {
  const float v = dot(record.normal, direction);
  return {record.d / v, static_cast<std::uint32_t>(std::max(grazing(record.normal, v), 0))};
}

glm::vec3 plane_point(const PolygonRecord& record, const glm::vec3& direction) {
  // The paper's accumulator starts from +0, which matters where V is a zero.
  const float v = 0.0f + dot(record.normal, direction);
  glm::vec3 point;
  for (int k = 0; k < 3; ++k) point[k] = canonical((record.d * direction[k]) / v);
  return point;
}

void CpuBurstUnit::run(std::span<const RayBundle> batch, BurstResults& results) {
  for (std::uint32_t i = 0; i < batch.size(); ++i) {
    for (LaneMask lanes = batch[i].lanes; lanes != 0; lanes &= lanes - 1) {
      run_burst(batch[i], i, static_cast<std::uint32_t>(std::countr_zero(lanes)), results);
    }
  }
}

void CpuBurstUnit::run_burst(const RayBundle& bundle, std::uint32_t index, std::uint32_t lane,
                             BurstResults& results) {
  const glm::vec3 direction = bundle.lane_direction(static_cast<int>(lane));
  BurstHit best{index, lane, 0, 0.0f, 0, glm::vec3{0.0f}};
  bool found = false;
  const auto report = [&](std::uint32_t record, TestReport::Kind kind) {
    results.reports.push_back({index, lane, record, kind});
  };
  for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
    const PolygonRecord& record = bundle.records[i];
    const float v = dot(record.normal, direction);
    Verdict verdict = decide(record, direction, v);
    HitDistance distance;
    if (verdict == Verdict::kHit) {
      ++counters_.distances;
      distance = hit_distance(record, direction);
      if (!normal(distance.t)) verdict = Verdict::kDoubt;
    }
    ++counters_.tests;
    counters_.misses += verdict == Verdict::kMiss;
    counters_.hits += verdict == Verdict::kHit;
    counters_.doubts += verdict == Verdict::kDoubt;
    if (verdict == Verdict::kDoubt) report(i, TestReport::Kind::kDoubt);
    if (verdict != Verdict::kHit) continue;
    const bool nearer = distance.t < best.t;
    if (found) {
      const std::int64_t margin = (std::int64_t{1} << (kTErrorUnit + distance.error)) +
                                  (std::int64_t{1} << (kTErrorUnit + best.t_error));
      if (std::abs(floats_between(distance.t, best.t)) <= margin) {
        ++counters_.near_ties;
        report(nearer ? best.record : i, TestReport::Kind::kNearTie);
      }
    }
    if (!found || nearer) {
      best.record = i;
      best.t = distance.t;
      best.t_error = distance.error;
      found = true;
    }
  }
  if (!found) return;
  best.point = plane_point(bundle.records[best.record], direction);
  counters_.coordinates += 3;
  results.hits.push_back(best);
}

}  // namespace raygate
