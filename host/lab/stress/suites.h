// Suites: generators of hard cases, one for each kind of failure of hit tests.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host/lab/stress/random.h"
#include "host/lab/stress/shot.h"

namespace raygate::lab {

using Generator = std::function<Shot(Random&)>;

struct Suite {
  std::string name;
  std::string what;  ///< one line for the report
  /// Makes a generator with its own state; called once per thread.
  std::function<Generator()> make;
};

/// Returns all suites, in the order of the report.
[[nodiscard]] const std::vector<Suite>& all_suites();

}  // namespace raygate::lab
