// Runs suites against variants.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/lab/stress/suites.h"
#include "host/lab/stress/tally.h"

namespace raygate::stress {

struct RunOptions {
  std::uint64_t tests = 0;  ///< for each suite, by the variants whose share is 1
  std::uint64_t seed = 1;
  int threads = 1;
};

/// One row of the outcome: a suite, and a tally for each variant.
struct SuiteOutcome {
  const Suite* suite = nullptr;
  std::vector<Tally> tallies;
  /// Rays that start inside a closed mesh but cross it an even number of times, in truth: the
  /// generator's own claim is broken, or the rule for the origins of mirrored rays.
  std::uint64_t broken_claims = 0;
  double seconds = 0.0;  ///< of a processor
};

/// Every suite against every variant. Each suite draws from its own random numbers and is run by
/// one thread, so the outcome does not depend on how many there are. `done` is called after each
/// suite, by one thread at a time.
[[nodiscard]] std::vector<SuiteOutcome> run(const std::vector<const Suite*>& suites,
                                            const std::vector<VariantKind>& variants,
                                            const RunOptions& options,
                                            const std::function<void(const SuiteOutcome&)>& done);

}  // namespace raygate::stress
