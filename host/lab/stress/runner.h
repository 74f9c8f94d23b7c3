// Runs suites against subjects.
#pragma once

#include <cstdint>
#include <functional>
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

/// What each subject did in a suite.
struct SuiteOutcome {
  const Suite* suite = nullptr;
  std::vector<Tally> tallies;
  /// Rays that start inside a closed mesh but cross it an even number of times, in truth: the
  /// generator's own claim is broken, or the rule for the origins of mirrored rays.
  std::uint64_t broken_claims = 0;
  double seconds = 0.0;  ///< of a processor
};

/// Every suite against every subject. Each suite draws from its own random numbers and is run by
/// one thread, so the outcome does not depend on how many there are. `done` is called after each
/// suite, by one thread at a time.
[[nodiscard]] std::vector<SuiteOutcome> run(const std::vector<const Suite*>& suites,
                                            const std::vector<SubjectKind>& subjects,
                                            const StressOptions& options,
                                            const std::function<void(const SuiteOutcome&)>& done);

/// A row for each subject, as it is kept.
[[nodiscard]] std::vector<Row> rows_of(const SuiteOutcome& outcome,
                                       const std::vector<SubjectKind>& subjects);

/// What a whole run comes to, from its rows.
struct Verdicts {
  bool judged = false;  ///< any exact subject
  /// Every exact subject spotless (see Tally), in tests that were really done, and no claim broken.
  bool passed = false;
  std::string summary;  ///< one line: "stress: PASSED: 20 suites, ..."
};
[[nodiscard]] Verdicts sum_up(std::span<const Row> rows, std::uint64_t seed);

}  // namespace raygate::lab
