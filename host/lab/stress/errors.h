// Any number of errors, for quantiles.
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

}  // namespace raygate::lab
