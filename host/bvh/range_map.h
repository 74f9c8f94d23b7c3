// Range map: finds which of many consecutive ranges a number is in.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raygate {

/// Consecutive runs of numbers, none of them empty. Finding a number's run takes as long as it does
/// to look into a table, where the runs are about equally long.
class RangeMap {
 public:
  RangeMap() = default;
  /// RangeMap of these lengths from `begin` on; their end is below 2^32.
  RangeMap(std::uint32_t begin, const std::vector<std::uint32_t>& lengths) : begins_{begin} {
    begins_.reserve(lengths.size() + 1);
    for (const std::uint32_t length : lengths) begins_.push_back(begins_.back() + length);
    if (lengths.empty()) return;
    const std::uint32_t size = end() - begin;
    shift_ = std::bit_width(size / static_cast<std::uint32_t>(lengths.size()));
    for (std::uint32_t chunk = 0, run = 0; chunk <= (size - 1) >> shift_; ++chunk) {
      while (begins_[run + 1] - begin <= chunk << shift_) ++run;
      first_.push_back(run);
    }
    first_.push_back(static_cast<std::uint32_t>(lengths.size() - 1));
  }

  [[nodiscard]] std::uint32_t begin() const { return begins_.front(); }
  [[nodiscard]] std::uint32_t end() const { return begins_.back(); }
  [[nodiscard]] std::uint32_t begin(std::uint32_t run) const { return begins_[run]; }

  /// The run that a number from begin() to before end() is in.
  [[nodiscard]] std::uint32_t find(std::uint32_t number) const {
    const std::uint32_t* const chunk = &first_[(number - begins_[0]) >> shift_];
    const auto first = begins_.begin() + chunk[0] + 1, last = begins_.begin() + chunk[1] + 1;
    return static_cast<std::uint32_t>(std::upper_bound(first, last, number) - begins_.begin()) - 1;
  }

 private:
  std::vector<std::uint32_t> begins_{0};  // of the runs, and their end
  std::vector<std::uint32_t> first_;      // the run of the first number of each 2^shift_, and more
  int shift_ = 0;
};

}  // namespace raygate
