// Runs suites against subjects.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/lab/stress/suites.h"
#include "host/lab/stress/tally.h"

namespace raygate::lab {

struct StressOptions {
  std::uint64_t tests = 0;  ///< for each suite, by the subjects whose share is 1
  std::uint64_t seed = 1;
  int threads = 1;
};

/// Every suite against every subject: a row for each pair, suite by suite. Each suite draws from
/// its own random numbers and is run by one thread, so the rows do not depend on how many there
/// are.
[[nodiscard]] std::vector<Row> run(const std::vector<const Suite*>& suites,
                                   const std::vector<SubjectKind>& subjects,
                                   const StressOptions& options);

/// What a whole run comes to, from its rows.
struct Verdicts {
  bool judged = false;  ///< any exact subject
  /// Every exact subject spotless (see Tally), in tests that were really done, and no claim broken.
  bool passed = false;
  std::string summary;  ///< one line: "stress: PASSED: 20 suites, ..."
};
[[nodiscard]] Verdicts sum_up(std::span<const Row> rows, std::uint64_t seed);

}  // namespace raygate::lab
