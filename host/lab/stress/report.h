// The outcome on paper.
#pragma once

#include <string>
#include <vector>

#include "host/lab/stress/runner.h"

namespace raygate::stress {

struct Report {
  RunOptions options;
  std::vector<VariantKind> variants;
  std::vector<SuiteOutcome> outcomes;

  /// Every exact variant spotless (see Tally), in tests that were really done, and no claim broken.
  [[nodiscard]] bool passed() const;
  /// Every suite against every variant of this build.
  [[nodiscard]] bool complete() const;
  /// One line: "stress: PASSED: 20 suites, ...".
  [[nodiscard]] std::string summary() const;
  /// Everything, for plots and other programs.
  [[nodiscard]] std::string json() const;
};

}  // namespace raygate::stress
