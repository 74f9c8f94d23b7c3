// Errors of t and P: how far off they may be, by the angle between ray and plane, and histograms.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace raygate::lab {

/// Counts errors in bins that are 1/64 of themselves wide or less, so that what several runs have
/// counted adds up exactly, in any order (host/lab/targets/stress.py does that).
class Errors {
 public:
  /// Not negative, no NaN; infinity is an error like others.
  void add(double error);

  [[nodiscard]] double max() const { return max_; }
  /// The bins that hold any: where a bin ends (all its errors are smaller; in the last one they may
  /// be anything), and how many.
  [[nodiscard]] std::vector<std::pair<double, std::uint64_t>> bins() const;

 private:
  std::vector<std::uint64_t> bins_;  // none, or kBins
  double max_ = 0.0;
};

/// The largest relative error that the unit's t = d / (I . N) may have in a sure hit, and its
/// P_k = (d I_k) / (I . N), the exact ones being normal floats; `sine` of the angle between ray
/// and plane. About (2 + 4 / sine) 2^-24 and (3 + 4 / sine) 2^-24; infinite where nothing is
/// proven. errors.cpp has the proof.
[[nodiscard]] double bound_of_t(double sine);
[[nodiscard]] double bound_of_point(double sine);

/// The same as errors in ulp (the step of floats near the exact value).
[[nodiscard]] double in_ulp(double relative);

/// What the host delivers in the end, refined from the corners (precise_hit in host/exact/exact.h),
/// is off by no more than so many ulp, at any angle.
inline constexpr double kDeliveredUlp = 0.5 + 0x1p-10;

}  // namespace raygate::lab
