// Stress test: checks engines and variants against exact integers, on hard cases.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <set>

#include "host/lab/commands.h"
#include "host/lab/stress/errors.h"
#include "host/lab/stress/minimise.h"
#include "host/lab/stress/runner.h"
#include "host/lab/stress/watertight.h"

namespace raygate::lab {
namespace {

struct Asked {
  StressOptions options{.tests = 10'000'000};
  std::vector<std::string> suites, subjects;
  bool minimised = false, listed = false;
};

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  names.reserve(std::size(list));
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

/// Prints the failures of exact subjects, or of all, as lines of test/regressions.txt.
void print_failures(std::span<const Row> rows, const std::vector<SubjectKind>& subjects, bool all) {
  for (const SubjectKind& kind : subjects) {
    if (!kind.exact && !all) continue;
    std::set<std::string> seen;
    const auto subject = kind.make();
    const auto fails = [&](const Case& failure) {
      return decides_wrongly(kind, *subject, failure);
    };
    for (const Row& row : rows) {
      if (row["subject"] != kind.name) continue;
      for (const std::string text : row["failures"]) {
        // The decision may differ for the case alone.
        const Case failure = case_from(text);
        const bool alone = fails(failure);
        const std::string line = alone ? to_text(minimise(failure, fails)) : text;
        if (!seen.insert(line).second) continue;
        std::printf("# %s, %s%s\n%s\n", kind.name.c_str(), row["suite"].get<std::string>().c_str(),
                    alone ? "" : ": only among other rays", line.c_str());
      }
    }
  }
}

/// Makes the heap keep freed memory. Some suites repeatedly allocate 2 MB for exact comparisons of
/// distances, whose pages would otherwise be returned to the system each time.
void keep_memory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 24);
  mallopt(M_TRIM_THRESHOLD, 1 << 25);
}

/// Returns the bounds of the unit's error of t, for sines from 1 to 1e-8, ten steps per decade.
Row bounds() {
  Row sines = Row::array(), ulps = Row::array();
  for (int tenths = 0; tenths <= 80; ++tenths) {
    sines.push_back(std::pow(10.0, -0.1 * tenths));
    ulps.push_back(in_ulp(bound_of_t(sines.back())));
  }
  return {{"table", "bounds"}, {"sine", sines}, {"t_ulp", ulps}};
}

int run_stress(const Asked& asked, Results& results) {
  if (asked.listed) {
    for (const Suite& suite : all_suites()) std::printf("%s\n", suite.name.c_str());
    return 0;
  }
  keep_memory();
  const auto wanted = [](const std::vector<std::string>& list, const std::string& name) {
    return list.empty() || std::ranges::count(list, name) > 0;
  };
  std::vector<SubjectKind> subjects = all_subjects();
  std::erase_if(subjects, [&](const SubjectKind& s) { return !wanted(asked.subjects, s.name); });
  std::vector<const Suite*> suites;
  for (const Suite& suite : all_suites()) {
    if (wanted(asked.suites, suite.name)) suites.push_back(&suite);
  }
  const std::vector<Row> rows = run(suites, subjects, asked.options);
  results.keep(bounds());
  for (const Row& row : rows) results.keep(row);
  print_failures(rows, subjects, asked.minimised);
  const Verdicts verdicts = sum_up(rows, asked.options.seed);
  std::printf("%s\n", verdicts.summary.c_str());
  return verdicts.passed || !verdicts.judged ? 0 : 1;
}

}  // namespace

void add_stress(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand(
      "stress", "engines and cheaper arithmetic in hard cases; exit status 1: an engine was wrong");
  const auto asked = std::make_shared<Asked>();
  app->add_option("--tests", asked->options.tests,
                  "tests of the cpu engine for each suite; others do their share of it");
  app->add_option("--seed", asked->options.seed, "of everything random");
  app->add_option("--threads", asked->options.threads, "suites run at once")
      ->check(CLI::PositiveNumber);
  app->add_option("--suite", asked->suites, "only these suites")
      ->check(CLI::IsMember(names_of(all_suites())));
  app->add_option("--subject", asked->subjects, "only these engines and variants")
      ->check(CLI::IsMember(names_of(all_subjects())));
  app->add_flag("--minimise", asked->minimised,
                "print some wrong decisions of all subjects, made as simple as they can be");
  app->add_flag("--list", asked->listed, "the suites' names, and no more");
  app->callback([asked, &outcome] { outcome.status = run_stress(*asked, outcome.results); });
}

void add_watertight(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand("watertight",
                                 "public tests of watertightness; exit status 1: an engine failed");
  const auto asked = std::make_shared<WatertightOptions>();
  app->add_option("--triangles", asked->triangles, "triangles of a mesh, and rays")
      ->check(CLI::Range(4, 1 << 20));
  app->add_option("--seeds", asked->seeds, "meshes of nomiss")->check(CLI::Range(1, 100));
  app->callback([asked, &outcome] {
    for (Row& row : watertight_rows(*asked)) {
      if (row["exact"] && !is_watertight(row)) outcome.status = 1;
      outcome.results.add(std::move(row));
    }
  });
}

}  // namespace raygate::lab
