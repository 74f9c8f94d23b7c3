// Hit-test units: interfaces of the pipelined unit (bursts in, nearest hits out) and of the paper's
// unit. Also their reference models in C++, in any number format and rounding.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "host/intersect/intersector.h"
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

/// Tests batches of bundles in two steps: the unit works while the caller prepares another batch.
template <class Result>
class BatchTester {
 public:
  virtual ~BatchTester() = default;

  /// Starts a batch, which must live until its finish(). At most two batches may be unfinished.
  virtual void start(std::span<const RayBundle> batch) {
    assert(started_count_ < 2);
    started_[started_count_++] = batch;
  }
  /// Completes the oldest batch and appends its results, in the order of the batch.
  virtual void finish(std::vector<Result>& results) = 0;

  /// Tests a batch in one call. No other batch may be in progress.
  void run(std::span<const RayBundle> batch, std::vector<Result>& results) {
    start(batch);
    finish(results);
  }

  /// Returns the number of tests below which a batch leaves the unit mostly idle.
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

/// A test that binary32 does not exclude from being the nearest hit of its burst.
struct BurstResult {
  enum class Kind : std::uint32_t {
    kHit = 0,      ///< the nearest sure hit of the burst
    kDoubt = 1,    ///< neither a sure hit nor a sure miss, or t cannot be computed
    kNearTie = 2,  ///< a sure hit that may be nearer than the kHit
  };

  std::uint32_t bundle = 0, lane = 0;  ///< index of the bundle in the batch, and lane
  std::uint32_t record = 0;            ///< index into the bundle's records
  Kind kind = Kind::kHit;
  // The fields below are 0 unless the kind is kHit.
  float t = 0.0f;             ///< positive and normal
  std::uint32_t t_error = 0;  ///< at most 2^(6 + t_error) floats lie between t and the exact t
  glm::vec3 point{0.0f};      ///< hit point P, relative to the ray's origin

  friend bool operator==(const BurstResult& a, const BurstResult& b) {  ///< compares all bits
    using Words = std::array<std::uint32_t, sizeof(BurstResult) / 4>;
    return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
  }
};

/// The results of a batch, in the order of bundles and lanes. Results of a burst are in the order
/// of its tests, except that its kHit comes last.
using BurstResults = std::vector<BurstResult>;

/// Tests every ray of every bundle against the bundle's records, in binary32, rounded to nearest
/// even after each operation. Every implementation gives the same bits, for every bit pattern.
/// For a direction I and a record with normal N, d, edges E_k and bounds b_k:
///
///   U_k = (E_kx Ix + E_ky Iy) + E_kz Iz,  V likewise with N,  t = d / V,  P_k = (d I_k) / V
///
///   U_k is sure if b_k < |U_k| < infinity (not with a NaN or negative b_k)
///   miss   d is 0, or a sure U_k has not the sign of d
///   hit    no miss; all U_k are sure; V is normal, has d's sign and an exponent at most 12
///          below the largest exponent of N's words; t is a positive normal number
///   doubt  neither miss nor hit
///
/// The error of t is 2^(6 + e) floats. Here e is how far V's exponent is below the largest in N,
/// or 0 (proof in hw/hit_test/hit_test_pkg.sv). Each burst keeps its hit with the smallest t (of
/// equal ones, the first). If a later hit and the kept hit are no more floats apart than the sum of
/// their errors, the hit that is not kept is reported as a near tie.
class BurstUnit : public BatchTester<BurstResult> {
 public:
  /// Returns statistics since construction, without `unit_tests`. Idle clocks and stalls are
  /// counted per lane of the hardware: together they are lanes * clocks - tests. Must not be called
  /// between start and finish.
  [[nodiscard]] virtual HitCounters counters() const = 0;
};

/// The seven input words of one test by the paper's unit (equation 10).
struct PlaneTest {
  glm::vec3 direction;  ///< the ray's direction I, any finite floats
  glm::vec3 normal;     ///< the polygon's normal H (the record's N)
  float d;              ///< H . V for a vertex V of the polygon, relative to the ray's origin
};

/// Computes P = d I / (I . H) for a stream of tests, in binary32, rounded to nearest even after
/// each operation, in this order: dot = ((0 + Hx Ix) + Hy Iy) + Hz Iz; P[k] = (d I[k]) / dot. A ray
/// parallel to the plane gives infinities or NaN, as in IEEE 754. A NaN is always 0x7FC00000. Every
/// implementation gives the same bits.
class PlaneUnit {
 public:
  virtual ~PlaneUnit() = default;

  /// Sets points[i] to the result of tests[i]; the spans have the same size.
  virtual void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) = 0;

  /// Returns simulated clock cycles since construction; 0 without simulation.
  [[nodiscard]] virtual std::uint64_t clocks() const { return 0; }
};

/// The unit's verdict on a single test.
enum class UnitVerdict : std::uint8_t { kMiss, kHit, kDoubt };

/// Counts a test with this verdict.
inline void count(UnitVerdict verdict, HitCounters& counters) {
  ++counters.tests;
  counters.misses += verdict == UnitVerdict::kMiss;
  counters.hits += verdict == UnitVerdict::kHit;
  counters.edge_doubts += verdict == UnitVerdict::kDoubt;
}

/// A hit's distance: at most 2^(6 + error) numbers of the format lie between t and the exact t.
struct HitDistance {
  float t = 0.0f;
  std::uint32_t error = 0;
};

/// Returns the interval of the exact t, from a positive t and its error.
template <class Math>
Interval around(const HitDistance& distance, const Math& math) {
  const std::uint32_t word = math.to_word(distance.t), margin = 64u << distance.error;
  const std::uint32_t infinity = math.to_word(std::numeric_limits<float>::infinity());
  return {math.from_word(word - std::min(word, margin)),
          math.from_word(std::min(word + margin, infinity))};
}

/// Implements BurstUnit in the format and rounding of `Math` (Binary32, or Arithmetic of
/// host/variants). All floats of records, rays and results are numbers of that format. Results have
/// the bits of hit_test_pipeline for the same format and rounding.
template <typename Math>
class BasicReferenceBurstUnit : public BurstUnit {
 public:
  explicit BasicReferenceBurstUnit(const Math& math = {}) : math_(math) {}

  void finish(BurstResults& results) override {
    const std::span<const RayBundle> batch = this->pop_started();
    for (std::uint32_t i = 0; i < batch.size(); ++i) {
      for (const int lane : SetBits(batch[i].lanes)) {
        run_burst(batch[i], i, static_cast<std::uint32_t>(lane), results);
      }
    }
  }

  [[nodiscard]] HitCounters counters() const override { return counters_; }

  /// Returns the verdict that a batch would give for this test. Sets `distance` if it is kHit.
  [[nodiscard]] UnitVerdict verdict(const PolygonRecord& record, const glm::vec3& direction,
                                    HitDistance& distance) const {
    const UnitVerdict inside = edges_verdict(record, direction);
    if (inside != UnitVerdict::kHit) return inside;
    if (!is_divisor(record, math_.dot(record.normal, direction))) return UnitVerdict::kDoubt;
    distance = this->distance(record, direction);
    return math_.is_normal(distance.t) ? UnitVerdict::kHit : UnitVerdict::kDoubt;
  }

  /// Returns the verdict of the edges alone. kHit: all edges surely have the sign of d, so the ray
  /// hits the triangle in front of its origin. If d is NaN, edges of different signs give kMiss,
  /// all other edges kDoubt.
  [[nodiscard]] UnitVerdict edges_verdict(const PolygonRecord& record,
                                          const glm::vec3& direction) const {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (record.d == 0.0f) return UnitVerdict::kMiss;
    const bool side = std::signbit(record.d);
    bool all_sure = !std::isnan(record.d), any_agrees = all_sure, any_differs = false;
    for (int k = 0; k < 3; ++k) {
      const float u = math_.dot(record.edges[k], direction);
      const float bound = record.bounds[k];
      const bool sure = !std::signbit(bound) && std::abs(u) > bound && std::abs(u) < kInfinity;
      any_agrees |= sure && std::signbit(u) == side;
      any_differs |= sure && std::signbit(u) != side;
      if (any_agrees && any_differs) return UnitVerdict::kMiss;
      all_sure = all_sure && sure;
    }
    return all_sure ? UnitVerdict::kHit : UnitVerdict::kDoubt;
  }

  /// Returns whether `v`, the computed V = I . N, can be the divisor of t.
  [[nodiscard]] bool is_divisor(const PolygonRecord& record, float v) const {
    return math_.is_normal(v) && std::signbit(v) == std::signbit(record.d) &&
           grazing(record.normal, v) <= std::max(math_.fraction_bits() - 11, 0);  // max_grazing
  }

  /// Returns BurstUnit's t and its error for a record that the ray surely hits.
  [[nodiscard]] HitDistance distance(const PolygonRecord& record,
                                     const glm::vec3& direction) const {
    const float v = math_.dot(record.normal, direction);
    return {math_.divide(record.d, v),
            static_cast<std::uint32_t>(std::max(grazing(record.normal, v), 0))};
  }

  /// Returns BurstUnit's hit point P (the paper's equation 10); any NaN is 0x7FC00000.
  [[nodiscard]] glm::vec3 point(const PolygonRecord& record, const glm::vec3& direction) const {
    // The paper's accumulator starts from +0, which decides the sign of v if v is 0.
    const float v = math_.add(0.0f, math_.dot(record.normal, direction));
    glm::vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = math_.divide(math_.multiply(record.d, direction[k]), v);
    return p;
  }

 private:
  static constexpr int kTErrorUnit = 6;  // hit_test_pkg::TErrorUnit

  /// Returns how far the exponent of `v` is below the largest exponent of `n`'s components.
  [[nodiscard]] int grazing(const glm::vec3& n, float v) const {
    return std::max(
               {math_.exponent_field(n.x), math_.exponent_field(n.y), math_.exponent_field(n.z)}) -
           math_.exponent_field(v);
  }

  /// Returns whether two positive distances differ by at most the sum of their errors.
  [[nodiscard]] bool near_tie(const HitDistance& a, const BurstResult& b) const {
    const std::int64_t margin = (std::int64_t{1} << (kTErrorUnit + a.error)) +
                                (std::int64_t{1} << (kTErrorUnit + b.t_error));
    return std::abs(static_cast<std::int64_t>(math_.to_word(a.t)) -
                    static_cast<std::int64_t>(math_.to_word(b.t))) <= margin;
  }

  void run_burst(const RayBundle& bundle, std::uint32_t index, std::uint32_t lane,
                 BurstResults& results) {
    using Kind = BurstResult::Kind;
    const glm::vec3 direction = bundle.lane_direction(static_cast<int>(lane));
    BurstResult best{index, lane};
    bool found = false;
    for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
      const PolygonRecord& record = bundle.records[i];
      HitDistance hit;
      const UnitVerdict verdict = this->verdict(record, direction, hit);
      count(verdict, counters_);
      if (verdict == UnitVerdict::kDoubt) results.push_back({index, lane, i, Kind::kDoubt});
      if (verdict != UnitVerdict::kHit) continue;
      const bool nearer = hit.t < best.t;
      if (found && near_tie(hit, best)) {
        ++counters_.depth_doubts;
        results.push_back({index, lane, nearer ? best.record : i, Kind::kNearTie});
      }
      if (found && !nearer) continue;
      best.record = i;
      best.t = hit.t;
      best.t_error = hit.error;
      found = true;
    }
    if (!found) return;
    best.point = point(bundle.records[best.record], direction);
    ++counters_.plane_tests;
    results.push_back(best);
  }

  Math math_;
  HitCounters counters_;
};

/// The reference model in the host's float arithmetic.
using ReferenceBurstUnit = BasicReferenceBurstUnit<Binary32>;

/// Sets `point`, with the bits of BasicReferenceBurstUnit::point in binary32, and `point_error`.
inline void set_point(const PolygonRecord& record, const glm::vec3& direction, NearestHit& hit) {
  const auto d = std::bit_cast<std::int32_t>(record.d),
             v = std::bit_cast<std::int32_t>(Binary32::dot(record.normal, direction));
  const std::int32_t error = point_error_of(d, v, grazing_of(largest_field(record.normal), v));
  hit.point = ReferenceBurstUnit().point(record, direction);
  hit.point_error = std::bit_cast<float>(error);
}

/// The reference model of the paper's unit; its points have the same bits as BurstUnit's.
template <class Math>
class BasicReferencePlaneUnit : public PlaneUnit {
 public:
  explicit BasicReferencePlaneUnit(const Math& math = {}) : math_(math) {}

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override {
    std::ranges::transform(tests, points.begin(), [&](const PlaneTest& test) {
      const PolygonRecord record{.normal = math_.read(test.normal), .d = math_.read(test.d)};
      return BasicReferenceBurstUnit<Math>(math_).point(record, math_.read(test.direction));
    });
  }

 private:
  Math math_;
};
using ReferencePlaneUnit = BasicReferencePlaneUnit<Binary32>;

}  // namespace raygate
