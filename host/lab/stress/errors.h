// Quantiles of any number of errors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace raygate::stress {

/// Counts errors in bins that are 1/64 of themselves wide or less, so that what several runs have
/// counted adds up exactly, in any order.
class Errors {
 public:
  struct Summary {
    std::uint64_t count = 0;
    double median = 0.0, p99 = 0.0;  ///< rounded up to the end of their bins: by 1/64 at most
    double max = 0.0;                ///< as it was
  };

  /// Not negative, no NaN; infinity is an error like others.
  void add(double error);
  void add(const Errors& other);
  [[nodiscard]] Summary summary() const;

  /// All it knows, for a file; and back.
  [[nodiscard]] std::map<std::size_t, std::uint64_t> bins() const;
  [[nodiscard]] double max() const { return max_; }
  Errors() = default;
  Errors(const std::map<std::size_t, std::uint64_t>& bins, double max);

 private:
  std::vector<std::uint64_t> bins_;  // none, or kBins
  double max_ = 0.0;
};

}  // namespace raygate::stress
