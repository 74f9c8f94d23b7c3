// Stress test: checks engines and variants against exact integers, on hard cases.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iterator>

#include "host/lab/commands.h"
#include "host/lab/stress/runner.h"
#include "host/lab/stress/watertight.h"

namespace raygate::lab {
namespace {

struct Asked {
  StressOptions options{.tests = 10'000'000};
  std::vector<std::string> suites, subjects;
  bool listed = false;
};

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  names.reserve(std::size(list));
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

/// Prints the first wrong decisions of exact subjects as lines of test/regressions.txt.
void print_failures(std::span<const Row> rows) {
  for (const Row& row : rows) {
    if (!row["exact"]) continue;
    for (const std::string line : row["failures"]) {
      std::printf("# %s, %s\n%s\n", row["subject"].get<std::string>().c_str(),
                  row["suite"].get<std::string>().c_str(), line.c_str());
    }
  }
}

/// Makes the heap keep freed memory. Some suites repeatedly allocate 2 MB for exact comparisons of
/// distances, whose pages would otherwise be returned to the system each time.
void keep_memory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 24);
  mallopt(M_TRIM_THRESHOLD, 1 << 25);
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
  for (const Row& row : rows) results.keep(row);
  print_failures(rows);
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
