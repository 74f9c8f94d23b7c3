// The outcome on paper.
#pragma once

#include <string>
#include <vector>

#include "host/bench/stress/runner.h"

namespace raygate::stress {

struct Report {
  RunOptions options;
  std::vector<VariantKind> variants;
  std::vector<SuiteOutcome> outcomes;
  double seconds = 0.0;

  /// Every exact variant spotless, in tests that were really done, and no claim broken.
  [[nodiscard]] bool passed() const;
  /// "stress: PASSED: 21 suites, ...".
  [[nodiscard]] std::string summary() const;
  /// Everything, for plots and other programs.
  [[nodiscard]] std::string json() const;
};

/// As tests/regressions.txt has it: 15 words in hex, origin, direction, triangle.
[[nodiscard]] std::string to_text(const Failure& failure);

}  // namespace raygate::stress
