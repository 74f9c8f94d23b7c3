#include "host/bench/stress/report.h"

#include <bit>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace raygate::stress {
namespace {

using nlohmann::ordered_json;

ordered_json to_json(const Errors& errors) {
  const Errors::Summary s = errors.summary();
  return {{"count", s.count}, {"median", s.median}, {"p99", s.p99}, {"max", s.max}};
}

ordered_json to_json(const Tally& tally) {
  ordered_json angles = ordered_json::array(), failures = ordered_json::array();
  for (const Errors& errors : tally.t_ulp_by_angle) angles.push_back(to_json(errors));
  for (const Failure& failure : tally.failures) failures.push_back(to_text(failure));
  return {{"tests", tally.tests},
          {"rays", tally.rays},
          {"wrong", tally.wrong},
          {"ties", tally.ties},
          {"wrong_ties", tally.wrong_ties},
          {"leaks", tally.leaks},
          {"escapes", tally.escapes},
          {"double_hits", tally.double_hits},
          {"wrong_nearest", tally.wrong_nearest},
          {"wrong_tied_nearest", tally.wrong_tied_nearest},
          {"hits", tally.hits},
          {"doubts", tally.doubts},
          {"t_ulp", to_json(tally.t_ulp)},
          {"t_relative", to_json(tally.t_relative)},
          {"point_ulp", to_json(tally.point_ulp)},
          {"t_ulp_by_angle", angles},
          {"worst_of_bound", tally.worst_of_bound},
          {"failures", failures}};
}

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

std::string Report::summary() const {
  Tally exact;
  std::uint64_t broken_claims = 0;
  for (const SuiteOutcome& outcome : outcomes) {
    broken_claims += outcome.broken_claims;
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (variants[v].exact) exact.add(outcome.tallies[v]);
    }
  }
  const auto n = [](std::uint64_t count) { return std::to_string(count); };
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.0f s", this->seconds);
  return std::string("stress: ") + (passed() ? "PASSED" : "FAILED") + ": " + n(outcomes.size()) +
         " suites, " + n(exact.tests) +
         " tests by the engines: " + n(exact.wrong + exact.wrong_ties) + " wrong, " +
         n(exact.leaks) + " leaks, " + n(exact.double_hits) + " double hits, " +
         n(exact.wrong_nearest + exact.wrong_tied_nearest) + " wrong nearest, " + n(broken_claims) +
         " broken claims, " + n(exact.doubts) + " doubts; seed " + n(options.seed) + ", " + seconds;
}

std::string Report::json() const {
  ordered_json kinds = ordered_json::array(), suites = ordered_json::array();
  for (std::size_t v = 0; v < variants.size(); ++v) {
    kinds.push_back({{"name", variants[v].name},
                     {"what", variants[v].what},
                     {"exact", variants[v].exact},
                     {"significand", variants[v].significand},
                     {"total", to_json(total(*this, v))}});
  }
  for (const SuiteOutcome& outcome : outcomes) {
    ordered_json tallies = ordered_json::array();
    for (const Tally& tally : outcome.tallies) tallies.push_back(to_json(tally));
    suites.push_back({{"name", outcome.suite->name},
                      {"what", outcome.suite->what},
                      {"broken_claims", outcome.broken_claims},
                      {"seconds", outcome.seconds},
                      {"variants", tallies}});
  }
  const ordered_json json = {{"passed", passed()},   {"tests", options.tests},
                             {"seed", options.seed}, {"threads", options.threads},
                             {"seconds", seconds},   {"variants", kinds},
                             {"suites", suites}};
  return json.dump(1) + "\n";
}

std::string to_text(const Failure& failure) {
  std::string text;
  const auto add = [&](const glm::vec3& v) {
    for (int k = 0; k < 3; ++k) {
      char word[16];
      std::snprintf(word, sizeof word, "%s%08X", text.empty() ? "" : " ",
                    std::bit_cast<std::uint32_t>(v[k]));
      text += word;
    }
  };
  add(failure.origin);
  add(failure.direction);
  for (const glm::vec3& vertex : failure.triangle) add(vertex);
  return text;
}

}  // namespace raygate::stress
