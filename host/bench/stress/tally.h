// How wrong a variant is: counts, and errors in units of the last place.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "host/bench/stress/oracle.h"
#include "host/bench/stress/random.h"
#include "host/bench/stress/variants.h"

namespace raygate::stress {

/// The median, the 99th percentile and the largest of any number of errors, the first two from a
/// random sample.
class Errors {
 public:
  struct Summary {
    std::uint64_t count = 0;
    double median = 0.0, p99 = 0.0, max = 0.0;
  };

  void add(double error);
  void add(const Errors& other);
  [[nodiscard]] Summary summary() const;

 private:
  static constexpr std::size_t kSample = 50000;
  std::vector<double> sample_;
  std::uint64_t count_ = 0;
  double max_ = 0.0;
  Random random_{1};
};

/// A case for the regression tests: one ray, one triangle.
struct Failure {
  glm::vec3 origin, direction;
  Corners triangle;
};

/// What one variant did in one suite.
struct Tally {
  std::uint64_t tests = 0, rays = 0;
  std::uint64_t wrong = 0;          ///< tests decided otherwise than the truth, ties aside
  std::uint64_t ties = 0;           ///< tests that only the tie-break decides
  std::uint64_t wrong_ties = 0;     ///< of these, decided otherwise: a sin of exact variants only
  std::uint64_t leaks = 0;          ///< rays from inside a closed mesh with an even number of hits
  std::uint64_t escapes = 0;        ///< of these, rays with none
  std::uint64_t double_hits = 0;    ///< rays from inside with more hits than there are
  std::uint64_t wrong_nearest = 0;  ///< rays whose first triangle is another, ties aside
  std::uint64_t wrong_tied_nearest = 0;  ///< the same among ties
  std::uint64_t hits = 0, doubts = 0;
  /// Of hits that are hits: t in ulp, P in ulp (of each coordinate, the worst), t relative.
  Errors t_ulp, point_ulp, t_relative;
  /// The same t_ulp by the angle between ray and plane: decade k holds sines from 10^-k-1 to 10^-k.
  static constexpr int kDecades = 8;
  std::array<Errors, kDecades> t_ulp_by_angle;
  /// The largest error of t over its bound (see bound_of_t).
  double worst_of_bound = 0.0;
  std::vector<Failure> failures;  ///< the first few

  void add(const Tally& other);
  [[nodiscard]] bool spotless() const {
    return wrong + wrong_ties + leaks + double_hits + wrong_nearest + wrong_tied_nearest == 0;
  }
};

/// The bound of the relative error of t = d / (I . N) for an angle of this sine between ray and
/// plane, in float32. d is off by 2^-24 + 2^-32 (exact.h, and its rounding to float). V = I . N is
/// an edge test like any other, off by kEdgeBound 2^-24 |N|_1, and |N|_1 <= sqrt(3) |N|,
/// |V| = |I| |N| sine, |I| >= 1: off by r = kEdgeBound sqrt(3) 2^-24 / sine of itself. The division
/// rounds once more. Infinite where r >= 1. For sines near 1 that is 16 * 2^-24.
[[nodiscard]] double bound_of_t(double sine);

/// Compares the answers for some shots with the truth about them.
void count(std::span<const Shot> shots, std::span<const Truth> truths, const Answers& answers,
           Tally& tally);

}  // namespace raygate::stress
