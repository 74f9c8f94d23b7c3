// The stress test: engines and cheaper variants against exact integers, on cases made to be hard.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "host/bench/stress/report.h"

namespace raygate::stress {
namespace {

template <class List, class Name>
std::vector<std::string> names_of(const List& list, Name name) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& item : list) names.push_back(name(item));
  return names;
}

int run_stress(int argc, char** argv) {
  const auto suite_names = names_of(all_suites(), [](const Suite& s) { return s.name; });
  const auto variant_names = names_of(all_variants(), [](const VariantKind& v) { return v.name; });
  Report report;
  report.options.tests = 10'000'000;
  std::string json_file;
  std::vector<std::string> wanted_suites, wanted_variants;
  bool quiet = false;

  CLI::App app("Stress test of hit decisions. Exit status 1: an engine decided wrongly.");
  app.add_option("--tests", report.options.tests,
                 "tests of the cpu engine for each suite; others do their share of it");
  app.add_option("--seed", report.options.seed, "of everything random");
  app.add_option("--threads", report.options.threads, "suites run at once")
      ->check(CLI::PositiveNumber);
  app.add_option("--suite", wanted_suites, "only these suites")->check(CLI::IsMember(suite_names));
  app.add_option("--variant", wanted_variants, "only these variants")
      ->check(CLI::IsMember(variant_names));
  app.add_option("--json", json_file, "write everything there");
  app.add_flag("--quiet", quiet, "the last line only");
  CLI11_PARSE(app, argc, argv);

  const auto wanted = [](const std::vector<std::string>& list, const std::string& name) {
    return list.empty() || std::ranges::count(list, name) > 0;
  };
  std::vector<const Suite*> suites;
  for (const Suite& suite : all_suites()) {
    if (wanted(wanted_suites, suite.name)) suites.push_back(&suite);
  }
  for (VariantKind& kind : all_variants()) {
    if (wanted(wanted_variants, kind.name)) report.variants.push_back(std::move(kind));
  }
  const auto start = std::chrono::steady_clock::now();
  const auto write = [&] {
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (json_file.empty()) return;
    const std::string json = report.json();  // takes a while: opening the file empties it
    if (!(std::ofstream(json_file) << json))
      throw std::runtime_error(json_file + ": cannot be written");
  };
  report.outcomes = run(suites, report.variants, report.options, [&](const SuiteOutcome& outcome) {
    report.outcomes.push_back(outcome);  // a long run that is cut short leaves what it has
    write();
    if (quiet) return;
    std::printf("%-18s %6.1f s", outcome.suite->name.c_str(), outcome.seconds);
    for (std::size_t v = 0; v < report.variants.size(); ++v) {
      const Tally& tally = outcome.tallies[v];
      const std::uint64_t bad =
          tally.wrong + tally.leaks + tally.double_hits + tally.wrong_nearest +
          (report.variants[v].exact ? tally.wrong_ties + tally.wrong_tied_nearest : 0);
      std::printf("  %s %llu", report.variants[v].name.c_str(),
                  static_cast<unsigned long long>(bad));
    }
    std::printf("\n");
    std::fflush(stdout);
  });
  write();
  for (const SuiteOutcome& outcome : report.outcomes) {
    for (std::size_t v = 0; v < report.variants.size(); ++v) {
      if (!report.variants[v].exact) continue;
      for (const Failure& failure : outcome.tallies[v].failures) {
        std::printf("%s, %s: %s\n", report.variants[v].name.c_str(), outcome.suite->name.c_str(),
                    to_text(failure).c_str());
      }
    }
  }
  std::printf("%s\n", report.summary().c_str());
  return report.passed() ? 0 : 1;
}

}  // namespace
}  // namespace raygate::stress

int main(int argc, char** argv) {
  try {
    return raygate::stress::run_stress(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
