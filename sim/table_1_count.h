// Counts what the two serial hit-test units compute: the figures of the paper's Table 1.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raygate {

/// Numbers of clocks in which the simulated unit used the result of its multiplier, adder, divider.
struct OperationCount {
  std::uint64_t multiplications = 0;
  std::uint64_t additions = 0;
  std::uint64_t quotients = 0;  ///< results of the divider
  std::uint64_t divisors = 0;   ///< loaded divisors; the paper counts these as its divisions
  std::uint64_t clocks = 0;     ///< from the first test's first word to the last test's result

  bool operator==(const OperationCount&) const = default;
};

/// Runs `num_tests` random tests back to back through hit_test_unit (equation 10).
[[nodiscard]] OperationCount count_proposed_form(std::size_t num_tests);

/// Runs `num_tests` random tests through general_hit_test_unit (equations 4 and 5).
[[nodiscard]] OperationCount count_general_form(std::size_t num_tests);

}  // namespace raygate
