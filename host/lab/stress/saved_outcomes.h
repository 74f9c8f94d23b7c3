// What a run has found so far, suite by suite in a folder, so that it can be interrupted.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/lab/stress/runner.h"

namespace raygate::stress {

/// A file for each suite. Each says of which run it is: which program (a digest of the executable),
/// how many tests, seed, variants; files of other runs are as good as none.
class SavedOutcomes {
 public:
  /// Makes the folder; InputError where it cannot.
  SavedOutcomes(std::filesystem::path folder, const RunOptions& options,
                const std::vector<VariantKind>& variants);

  [[nodiscard]] std::optional<SuiteOutcome> load(const Suite& suite) const;
  /// InputError where it cannot be written; never leaves half a file.
  void save(const SuiteOutcome& outcome) const;

 private:
  [[nodiscard]] std::filesystem::path file_of(const Suite& suite) const;

  std::filesystem::path folder_;
  std::string run_;  // what all its files have in common, as JSON
};

}  // namespace raygate::stress
