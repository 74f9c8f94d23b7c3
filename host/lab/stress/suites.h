// Suites: generators of hard cases, one for each way in which a hit test goes wrong.
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
  /// Makes a generator with what it keeps from shot to shot: one for each thread.
  std::function<Generator()> make;
};

/// All suites, in the order of the report.
[[nodiscard]] const std::vector<Suite>& all_suites();

}  // namespace raygate::lab
