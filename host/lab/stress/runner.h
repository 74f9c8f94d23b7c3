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
  std::uint64_t tests = 0;  ///< per suite, for subjects whose share is 1
  std::uint64_t seed = 1;
  int threads = 1;
};

/// Runs every suite with every subject and returns a row for each pair, ordered by suite. Each
/// suite has its own random numbers and is run by one thread, so the rows do not depend on the
/// number of threads.
[[nodiscard]] std::vector<Row> run(const std::vector<const Suite*>& suites,
                                   const std::vector<SubjectKind>& subjects,
                                   const StressOptions& options);

/// Summary of a run.
struct Verdicts {
  bool judged = false;  ///< whether there were exact subjects
  /// Whether all exact subjects are spotless (see Tally), with tests, and no claim is broken.
  bool passed = false;
  std::string summary;  ///< one line: "stress: PASSED: 20 suites, ..."
};
[[nodiscard]] Verdicts sum_up(std::span<const Row> rows, std::uint64_t seed);

}  // namespace raygate::lab
