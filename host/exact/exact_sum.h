// Exact sums of any number of doubles.
#pragma once

#include <vector>

#include "host/exact/expansion.h"

namespace raygate {

/// A sum of doubles without rounding: what an Expansion is, without a bound of its size
/// (Shewchuk's GROW-EXPANSION with zero elimination). Terms and sums must not overflow.
class ExactSum {
 public:
  void add(double term) {
    std::size_t kept = 0;
    for (const double part : parts_) {
      const ExactPair pair = two_sum(term, part);
      if (pair.error != 0.0) parts_[kept++] = pair.error;
      term = pair.value;
    }
    parts_.resize(kept);
    if (term != 0.0) parts_.push_back(term);
  }
  /// -1, 0 or 1.
  [[nodiscard]] int sign() const { return parts_.empty() ? 0 : (parts_.back() > 0.0 ? 1 : -1); }

 private:
  std::vector<double> parts_;  // not overlapping, of growing magnitude
};

}  // namespace raygate
