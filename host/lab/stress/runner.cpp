#include "host/lab/stress/runner.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "host/base/threads.h"
#include "host/lab/timing.h"

namespace raygate::lab {
namespace {

constexpr std::uint64_t kBlockTests = 4096;  // tests per block

/// Runs a suite with all subjects, and returns a row for each.
std::vector<Row> run_suite(const Suite& suite, const std::vector<SubjectKind>& kinds,
                           const StressOptions& options) {
  const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
  std::vector<Tally> tallies(kinds.size());
  // Rays that start inside a closed mesh but cross it an even number of times, by the oracle:
  // either the generator's claim is wrong, or the rule for origins of reflected rays.
  std::uint64_t broken_claims = 0;
  std::vector<std::unique_ptr<Subject>> subjects;
  std::vector<std::uint64_t> wanted;
  for (const SubjectKind& kind : kinds) {
    subjects.push_back(kind.make());
    wanted.push_back(std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(kind.share * static_cast<double>(options.tests))));
  }
  Random random(options.seed ^ digest(suite.name));
  const Generator generate = suite.make();
  std::vector<Shot> shots;
  std::vector<Truth> truths;
  Answers answers;
  for (bool more = true; more;) {
    more = false;
    shots.clear();
    truths.clear();
    for (std::uint64_t tests = 0; tests < kBlockTests; tests += shots.back().tests()) {
      shots.push_back(generate(random));
      const Shot& shot = shots.back();
      const Truth& truth = truths.emplace_back(find_truth(shot));
      if (!shot.inside) continue;
      auto verdict = truth.verdicts.begin();
      for (std::size_t ray = 0; ray < shot.directions.size(); ++ray) {
        std::uint64_t hits = 0;
        for (std::size_t i = 0; i < shot.mesh->triangles.size(); ++i) hits += (verdict++)->hit;
        broken_claims += hits % 2 == 0;
      }
    }
    for (std::size_t v = 0; v < subjects.size(); ++v) {
      Tally& tally = tallies[v];
      if (tally.tests >= wanted[v]) continue;
      answers.orders.clear();  // only some subjects set it
      answers.refused.clear();
      subjects[v]->run(shots, answers);
      count(shots, truths, answers, kinds[v], tally);
      more = more || tally.tests < wanted[v];
    }
  }
  const double seconds = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Row& row = rows.emplace_back(Row{{"table", "stress"},
                                     {"suite", suite.name},
                                     {"suite_is", suite.what},
                                     {"subject", kinds[i].name},
                                     {"subject_is", kinds[i].what},
                                     {"exact", kinds[i].exact},
                                     {"simulated", kinds[i].simulated},
                                     {"spotless", tallies[i].spotless()},
                                     {"broken_claims", broken_claims},
                                     {"seconds", seconds}});
    row.update(tallies[i].row());
  }
  return rows;
}

}  // namespace

std::vector<Row> run(const std::vector<const Suite*>& suites,
                     const std::vector<SubjectKind>& subjects, const StressOptions& options) {
  std::vector<std::vector<Row>> found(suites.size());
  for_each_on_threads(options.threads, suites.size(),
                      [&](std::size_t i) { found[i] = run_suite(*suites[i], subjects, options); });
  std::vector<Row> rows;
  for (const std::vector<Row>& suite : found) rows.insert(rows.end(), suite.begin(), suite.end());
  return rows;
}

Verdicts sum_up(std::span<const Row> rows, std::uint64_t seed) {
  Verdicts verdicts;
  std::set<std::string> suites;
  std::uint64_t broken_claims = 0;
  double seconds = 0.0;
  bool spotless = true;
  for (const Row& row : rows) {
    if (suites.insert(row["suite"]).second) {  // these two columns are the suite's
      broken_claims += row["broken_claims"].get<std::uint64_t>();
      seconds += row["seconds"].get<double>();
    }
    if (!row["exact"]) continue;
    verdicts.judged = true;
    spotless = spotless && row["spotless"] && row["tests"] != 0;
  }
  if (!verdicts.judged) {
    verdicts.summary = "stress: none of the engines was asked for, so nothing can pass or fail";
    return verdicts;
  }
  verdicts.passed = spotless && broken_claims == 0;
  // All subjects see prefixes of one sequence of cases, so the longest one contains all cases.
  const auto cases = [&](const char* key) {
    std::map<std::string, std::uint64_t> most;
    for (const Row& row : rows) {
      std::uint64_t& suite = most[row["suite"]];
      if (row[key]) suite = std::max(suite, row["tests"].get<std::uint64_t>());
    }
    std::uint64_t total = 0;
    for (const auto& [suite, tests] : most) total += tests;
    return std::to_string(total);
  };
  const auto sum = [&](std::initializer_list<const char*> keys) {
    std::uint64_t total = 0;
    for (const Row& row : rows) {
      for (const char* key : keys) total += row["exact"] ? row[key].get<std::uint64_t>() : 0;
    }
    return std::to_string(total);
  };
  verdicts.summary =
      std::string("stress: ") + (verdicts.passed ? "PASSED" : "FAILED") + ": " +
      std::to_string(suites.size()) + " suites, " + cases("exact") + " cases, " +
      cases("simulated") + " of them by the simulated hardware: " + sum({"wrong", "wrong_ties"}) +
      " wrong, " + sum({"escapes"}) + " escapes, " + sum({"double_hits"}) + " double hits, " +
      sum({"wrong_nearest", "wrong_tied_nearest"}) + " wrong nearest, " + sum({"wrong_order"}) +
      " wrong orders, " + std::to_string(broken_claims) + " broken claims, " + sum({"doubts"}) +
      " doubts; seed " + std::to_string(seed) + ", " + std::to_string(std::lround(seconds)) +
      " s of processor time";
  return verdicts;
}

}  // namespace raygate::lab
