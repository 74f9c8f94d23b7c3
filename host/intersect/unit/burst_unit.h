// Interfaces of the pipelined hit-test unit (bursts in, nearest hits out) and of the paper's unit.
#pragma once

#include <array>
#include <bit>
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

/// Tests batches of bundles in two steps, so that the unit is busy while the caller prepares the
/// next batch.
template <class Result>
class BatchTester {
 public:
  virtual ~BatchTester() = default;

  /// Starts a batch, which must live until its finish(). At most two batches may be started and not
  /// finished.
  virtual void start(std::span<const RayBundle> batch) {
    assert(started_count_ < 2);
    started_[started_count_++] = batch;
  }
  /// Completes the oldest batch and appends its results, in the order of the batch.
  virtual void finish(std::vector<Result>& results) = 0;

  /// Tests a batch if no other one is started.
  void run(std::span<const RayBundle> batch, std::vector<Result>& results) {
    start(batch);
    finish(results);
  }

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
  float t = 0.0f;             ///< d / (I . N), positive and normal
  std::uint32_t t_error = 0;  ///< at most 2^(6 + t_error) floats lie between t and the exact t
  glm::vec3 point{0.0f};      ///< P = d I / (I . N)

  friend bool operator==(const BurstResult& a, const BurstResult& b) {  ///< compares all bits
    using Words = std::array<std::uint32_t, sizeof(BurstResult) / 4>;
    return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
  }
};

/// The results of a batch, in the order of bundles and lanes; those of a burst are in the order of
/// its tests, except that its kHit comes last.
using BurstResults = std::vector<BurstResult>;

/// Tests every ray of every bundle against the bundle's records, in binary32, rounded to nearest
/// even after each operation. Every implementation gives the same bits, for every bit pattern:
///
///   U_k = (E_kx Ix + E_ky Iy) + E_kz Iz,  V likewise with N,  t = d / V,  P_k = (d I_k) / V
///
///   U_k is sure if b_k < |U_k| < infinity (not with a NaN or negative b_k)
///   miss   d is 0, or a sure U_k has the opposite sign of d
///   hit    otherwise, if all U_k are sure, V is normal and has d's sign, its exponent is at most
///   12
///          below the largest of N's, and t is a positive normal number
///   doubt  otherwise
///
/// The error of t is 2^(6 + e), where e is how far V's exponent is below the largest of N's, or 0
/// (proof in hw/hit_test/hit_test_pkg.sv). One hit of a burst is kept: the first, which each later
/// hit with a smaller t replaces. If the distance of two hits, in floats, is at most the sum of
/// their errors, the one that is not kept is reported as a near tie.
class BurstUnit : public BatchTester<BurstResult> {
 public:
  /// Returns statistics since construction, without `unit_tests` and `input_bytes`. Clocks are 0
  /// without simulation; idle clocks and stalls are counted per lane of the hardware: together they
  /// are lanes * clocks - tests. Must not be called between start and finish.
  [[nodiscard]] virtual HitCounters counters() const = 0;
};

/// One test of the paper's unit (equation 10): its seven input words.
struct PlaneTest {
  glm::vec3 direction;  ///< I, any finite floats
  glm::vec3 normal;     ///< H (the record's N)
  float d;              ///< H . V for a vertex V of the polygon, seen from the ray's origin
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

}  // namespace raygate
