// Errors of t and P: bounds by the angle between ray and plane, and histograms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace raygate::lab {

/// A histogram of errors. Bins are at most 1/64 of their value wide, the same in all runs, so that
/// sums over runs are exact in any order (see host/lab/targets/stress.py).
class Errors {
 public:
  /// Adds an error, which is not negative and not NaN; it may be infinite.
  void add(double error);

  [[nodiscard]] double max() const { return max_; }
  /// Returns the end and the count of each non-empty bin. Errors are smaller than the end, except
  /// that those in the last bin have no upper limit.
  [[nodiscard]] std::vector<std::pair<double, std::uint64_t>> bins() const;

 private:
  std::vector<std::uint64_t> bins_;  // empty, or kBins
  double max_ = 0.0;
};

/// Return the largest relative errors of the unit's t = d / (I . N) and P_k = (d I_k) / (I . N) in
/// a sure hit whose exact values are normal floats. `sine` is that of the angle between ray and
/// plane. About (2 + 4 / sine) 2^-24 and (3 + 4 / sine) 2^-24; infinite if no bound is proven. See
/// errors.cpp for the proof.
[[nodiscard]] double bound_of_t(double sine);
[[nodiscard]] double bound_of_point(double sine);

/// Largest error in ulps of the hits that the host delivers, which are computed from the corners
/// (precise_hit in host/exact/exact.h), at any angle.
inline constexpr double kDeliveredUlp = 0.5 + 0x1p-10;

}  // namespace raygate::lab
