// Burst unit: the interface of the pipelined hit-test unit, bursts of tests in, nearest hits out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "host/intersect/unit/hit_tester.h"

namespace raygate {

/// The nearest sure hit of a burst, as far as float32 can tell: near ties are reported beside it.
struct BurstHit {
  std::uint32_t bundle = 0, lane = 0;  ///< whose burst: index into the batch, lane of the bundle
  std::uint32_t record = 0;            ///< which of the bundle's records
  float t = 0.0f;                      ///< d / (I . N), positive and normal
  std::uint32_t t_error = 0;  ///< at most 2^(6 + t_error) floats lie between t and the truth
  glm::vec3 point{0.0f};      ///< P = d I / (I . N)

  friend bool operator==(const BurstHit& a, const BurstHit& b);  ///< of all bits
};

/// A test that float32 leaves open.
struct TestReport {
  enum class Kind : std::uint8_t {
    kDoubt = 1,    ///< neither surely hit nor surely missed, or its t cannot be had
    kNearTie = 2,  ///< a sure hit that may be nearer than the one that was kept
  };
  std::uint32_t bundle = 0, lane = 0, record = 0;
  Kind kind = Kind::kDoubt;

  friend bool operator==(const TestReport&, const TestReport&) = default;
};

/// What a batch of bursts gave. Both in the order of the batch, bundle by bundle and in it lane by
/// lane; the reports of a burst in the order in which they arose.
struct BurstResults {
  std::vector<BurstHit> hits;
  std::vector<TestReport> reports;

  void clear() {
    hits.clear();
    reports.clear();
  }
};

/// What a unit has done since it was made. Clocks are 0 where nothing is simulated; idle clocks and
/// stalls are counted for each lane of the hardware, so that they add up to lanes * clocks - tests.
struct BurstCounters {
  std::uint64_t tests = 0;          ///< misses + hits + doubts
  std::uint64_t misses = 0;         ///< surely missed
  std::uint64_t hits = 0;           ///< surely hit, near ties included
  std::uint64_t doubts = 0;         ///< neither
  std::uint64_t near_ties = 0;      ///< sure hits reported beside the one that was kept
  std::uint64_t distances = 0;      ///< divisions for t
  std::uint64_t coordinates = 0;    ///< divisions for the coordinates of P
  std::uint64_t clocks = 0;         ///< simulated clock cycles
  std::uint64_t idle_clocks = 0;    ///< no test was there
  std::uint64_t output_stalls = 0;  ///< a result was not taken

  friend bool operator==(const BurstCounters&, const BurstCounters&) = default;
};

/// Tests every ray of every bundle against the bundle's records, in binary32, rounded to nearest
/// even after each operation. Every implementation gives the same bits, for every bit pattern:
///
///     U_k = (E_kx Ix + E_ky Iy) + E_kz Iz,  V likewise with N,  t = d / V,  P_k = (d I_k) / V
///
///     U_k is sure where b_k < |U_k| < infinity (a NaN or negative b_k leaves nothing sure)
///     miss   d is 0, or a sure U_k has the other sign than d
///     hit    else, if all U_k are sure, V is normal and of d's sign, with an exponent at most 12
///            below the largest of N's, and t is a positive normal number
///     doubt  else
///
/// The error of t is 2^(6 + e), e being how far V's exponent is below the largest of N's, or 0
/// (hw/hit_test/hit_test_pkg.sv has the proof). Of a burst's hits one is kept: the first; then
/// each one whose t is smaller takes its place. Where the two are no farther apart, in floats,
/// than the sum of their errors, the one that isn't kept is reported as a near tie.
class BurstUnit : public BatchTester<BurstResults> {
 public:
  /// Not between a start and its finish.
  [[nodiscard]] virtual BurstCounters counters() const = 0;
};

/// Thrown by require_same. Its text is ready to replay: the burst's direction and the 16 words of
/// each record in hex, and what each unit made of them.
class BurstUnitMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws BurstUnitMismatch at the first burst where `actual` is not `expected`, bit for bit; both
/// are results of `batch`.
void require_same(std::span<const RayBundle> batch, const BurstResults& actual,
                  const BurstResults& expected);

/// One test of the paper's unit (equation 10): its seven input words.
struct PlaneTest {
  glm::vec3 direction;  ///< I, any finite floats
  glm::vec3 normal;     ///< H (the record's N)
  float d;              ///< H . V for a vertex V of the polygon, seen from the ray's origin
};

/// Computes P = d I / (I . H) for a stream of tests, in binary32, rounded to nearest even after
/// each operation, in this order: dot = ((0 + Hx Ix) + Hy Iy) + Hz Iz; P[k] = (d I[k]) / dot.
/// A ray parallel to the plane gives infinities or NaN, as IEEE 754 has them.
/// A NaN's bits are always 0x7FC00000. Every implementation gives the same bits.
class PlaneUnit {
 public:
  virtual ~PlaneUnit() = default;

  /// `points[i]` becomes the result of `tests[i]`; both spans have one size.
  virtual void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) = 0;

  /// Simulated clock cycles since construction; 0 where nothing is simulated.
  [[nodiscard]] virtual std::uint64_t clocks() const { return 0; }
};

}  // namespace raygate
