// Interfaces of the pipelined hit-test unit (bursts in, nearest hits out) and of the paper's unit.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "host/intersect/unit/hit_tester.h"

namespace raygate {

/// The nearest sure hit of a burst in binary32; near ties are reported separately.
struct BurstHit {
  std::uint32_t bundle = 0, lane = 0;  ///< index of the bundle in the batch, and lane
  std::uint32_t record = 0;            ///< index into the bundle's records
  float t = 0.0f;                      ///< d / (I . N), positive and normal
  std::uint32_t t_error = 0;  ///< at most 2^(6 + t_error) floats lie between t and the exact t
  glm::vec3 point{0.0f};      ///< P = d I / (I . N)

  friend bool operator==(const BurstHit& a, const BurstHit& b);  ///< compares all bits
};

/// A test that binary32 does not decide.
struct TestReport {
  enum class Kind : std::uint8_t {
    kDoubt = 1,    ///< neither a sure hit nor a sure miss, or t cannot be computed
    kNearTie = 2,  ///< a sure hit that may be nearer than the one in BurstHit
  };
  std::uint32_t bundle = 0, lane = 0, record = 0;
  Kind kind = Kind::kDoubt;

  friend bool operator==(const TestReport&, const TestReport&) = default;
};

/// The results of a batch of bursts, in the order of bundles and lanes; the reports of a burst are
/// in the order of its tests.
struct BurstResults {
  std::vector<BurstHit> hits;
  std::vector<TestReport> reports;

  void clear() {
    hits.clear();
    reports.clear();
  }
};

/// Statistics of a unit since its construction. Clocks are 0 without simulation. Idle clocks and
/// stalls are counted per lane of the hardware; together they are lanes * clocks - tests.
struct BurstCounters {
  std::uint64_t tests = 0;          ///< misses + hits + doubts
  std::uint64_t misses = 0;         ///< sure misses
  std::uint64_t hits = 0;           ///< sure hits, including near ties
  std::uint64_t doubts = 0;         ///< neither sure hits nor sure misses
  std::uint64_t near_ties = 0;      ///< sure hits reported as near ties
  std::uint64_t distances = 0;      ///< divisions for t
  std::uint64_t coordinates = 0;    ///< divisions for the coordinates of P
  std::uint64_t clocks = 0;         ///< simulated clock cycles
  std::uint64_t idle_clocks = 0;    ///< clocks without a test
  std::uint64_t output_stalls = 0;  ///< clocks stalled by the consumer

  friend bool operator==(const BurstCounters&, const BurstCounters&) = default;
};

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
class BurstUnit : public BatchTester<BurstResults> {
 public:
  /// Must not be called between start and finish.
  [[nodiscard]] virtual BurstCounters counters() const = 0;
};

/// Thrown by require_same. The text can be replayed: the burst's direction, the 16 words of each
/// record in hexadecimal, and the results of both units.
class BurstUnitMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws BurstUnitMismatch at the first burst whose `actual` bits differ from those `expected`.
void require_same(std::span<const RayBundle> batch, const BurstResults& actual,
                  const BurstResults& expected);

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
