#include "host/lab/stress/report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "host/lab/stress/error_bounds.h"
#include "host/lab/stress/tally_json.h"

namespace raygate::stress {
namespace {

using nlohmann::ordered_json;

Tally total(const Report& report, std::size_t variant) {
  Tally sum;
  for (const SuiteOutcome& outcome : report.outcomes) sum.add(outcome.tallies[variant]);
  return sum;
}

}  // namespace

bool Report::passed() const {
  bool any = false;
  for (const SuiteOutcome& outcome : outcomes) {
    if (outcome.broken_claims != 0) return false;
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (!variants[v].exact) continue;
      const Tally& tally = outcome.tallies[v];
      if (tally.tests == 0 || !tally.spotless()) return false;
      any = true;
    }
  }
  return any;
}

bool Report::complete() const {
  return outcomes.size() == all_suites().size() && variants.size() == all_variants().size();
}

std::string Report::summary() const {
  Tally exact;
  std::uint64_t broken_claims = 0;
  bool any_exact = false;
  for (const VariantKind& variant : variants) any_exact = any_exact || variant.exact;
  if (!any_exact) return "stress: none of the engines was asked for, so nothing can pass or fail";
  for (const SuiteOutcome& outcome : outcomes) {
    broken_claims += outcome.broken_claims;
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (variants[v].exact) exact.add(outcome.tallies[v]);
    }
  }
  const auto n = [](std::uint64_t count) { return std::to_string(count); };
  double seconds = 0.0;
  for (const SuiteOutcome& outcome : outcomes) seconds += outcome.seconds;
  char time[64];
  std::snprintf(time, sizeof time, "%.0f s of processor time", seconds);
  return std::string("stress: ") + (passed() ? "PASSED" : "FAILED") + ": " + n(outcomes.size()) +
         " suites, " + n(exact.tests) +
         " tests by the engines: " + n(exact.wrong + exact.wrong_ties) + " wrong, " +
         n(exact.leaks) + " leaks, " + n(exact.double_hits) + " double hits, " +
         n(exact.wrong_nearest + exact.wrong_tied_nearest) + " wrong nearest, " + n(broken_claims) +
         " broken claims, " + n(exact.doubts) + " doubts; seed " + n(options.seed) + ", " + time;
}

std::string Report::json() const {
  ordered_json kinds = ordered_json::array(), suites = ordered_json::array();
  for (std::size_t v = 0; v < variants.size(); ++v) {
    kinds.push_back({{"name", variants[v].name},
                     {"what", variants[v].what},
                     {"exact", variants[v].exact},
                     {"significand", variants[v].significand},
                     {"total", summed_up(total(*this, v))}});
  }
  for (const SuiteOutcome& outcome : outcomes) {
    ordered_json tallies = ordered_json::array();
    for (const Tally& tally : outcome.tallies) tallies.push_back(summed_up(tally));
    suites.push_back({{"name", outcome.suite->name},
                      {"what", outcome.suite->what},
                      {"broken_claims", outcome.broken_claims},
                      {"seconds", outcome.seconds},
                      {"variants", tallies}});
  }
  ordered_json bounds = ordered_json::array();
  for (int tenths = 0; tenths <= 80; ++tenths) {
    const double sine = std::pow(10.0, -0.1 * tenths);
    bounds.push_back({{"sine", sine},
                      {"t_ulp", in_ulp(bound_of_t(sine))},
                      {"point_ulp", in_ulp(bound_of_point(sine))}});
  }
  const ordered_json json = {{"passed", passed()},     {"complete", complete()},
                             {"tests", options.tests}, {"seed", options.seed},
                             {"bounds", bounds},       {"variants", kinds},
                             {"suites", suites}};
  return json.dump(1) + "\n";
}

}  // namespace raygate::stress
