// The stress test: engines and cheaper variants against exact integers, on cases made to be hard.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>

#include "host/film/pending_file.h"
#include "host/lab/stress/minimise.h"
#include "host/lab/stress/report.h"
#include "host/lab/stress/saved_outcomes.h"

namespace raygate::stress {
namespace {

template <class List, class Name>
std::vector<std::string> names_of(const List& list, Name name) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& item : list) names.push_back(name(item));
  return names;
}

/// Those of exact variants, and with `all` everyone's, as test/regressions.txt takes them.
void print_failures(const Report& report, bool all) {
  for (std::size_t v = 0; v < report.variants.size(); ++v) {
    const VariantKind& kind = report.variants[v];
    if (!kind.exact && !all) continue;
    std::set<std::string> seen;
    const auto variant = kind.make();
    const auto fails = [&](const Case& failure) {
      return decides_wrongly(kind, *variant, failure);
    };
    for (const SuiteOutcome& outcome : report.outcomes) {
      for (const Case& failure : outcome.tallies[v].failures) {
        // Alone, it may be decided otherwise than among others.
        const bool alone = fails(failure);
        const std::string line = to_text(alone ? minimise(failure, fails) : failure);
        if (!seen.insert(line).second) continue;
        std::printf("# %s, %s%s\n%s\n", kind.name.c_str(), outcome.suite->name.c_str(),
                    alone ? "" : ": only among other rays", line.c_str());
      }
    }
  }
}

/// Exact arithmetic about depths asks for 2 MB, all the time in some suites: the heap keeps them,
/// or the system would take and give every page of them again and again.
void keep_memory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 24);
  mallopt(M_TRIM_THRESHOLD, 1 << 25);
}

int run_stress(int argc, char** argv) {
  keep_memory();
  const auto suite_names = names_of(all_suites(), [](const Suite& s) { return s.name; });
  const auto variant_names = names_of(all_variants(), [](const VariantKind& v) { return v.name; });
  Report report;
  report.options.tests = 10'000'000;
  std::string folder;
  std::vector<std::string> wanted_suites, wanted_variants;
  bool quiet = false, minimised = false;

  CLI::App app("Stress test of hit decisions. Exit status 1: an engine decided wrongly.");
  app.add_option("--tests", report.options.tests,
                 "tests of the cpu engine for each suite; others do their share of it");
  app.add_option("--seed", report.options.seed, "of everything random");
  app.add_option("--threads", report.options.threads, "suites run at once")
      ->check(CLI::PositiveNumber);
  app.add_option("--suite", wanted_suites, "only these suites")->check(CLI::IsMember(suite_names));
  app.add_option("--variant", wanted_variants, "only these variants")
      ->check(CLI::IsMember(variant_names));
  app.add_option("--results", folder,
                 "a folder for all that is found; what is there of the same run is not run again");
  app.add_flag("--minimise", minimised,
               "print some wrong decisions of all variants, made as simple as they can be");
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
  const auto say = [&](const SuiteOutcome& outcome) {
    if (quiet) return;
    std::printf("%-18s %6.1f s", outcome.suite->name.c_str(), outcome.seconds);
    for (std::size_t v = 0; v < report.variants.size(); ++v) {
      const Tally& tally = outcome.tallies[v];
      const std::uint64_t bad =
          tally.wrong_decisions(report.variants[v].exact) + tally.leaks + tally.double_hits;
      std::printf("  %s %llu", report.variants[v].name.c_str(),
                  static_cast<unsigned long long>(bad));
    }
    std::printf("\n");
    std::fflush(stdout);
  };
  std::optional<SavedOutcomes> saved;
  if (!folder.empty()) saved.emplace(folder, report.options, report.variants);
  std::vector<const Suite*> to_run;
  for (const Suite* suite : suites) {
    if (auto outcome = saved ? saved->load(*suite) : std::nullopt) {
      say(*outcome);
      report.outcomes.push_back(std::move(*outcome));
    } else {
      to_run.push_back(suite);
    }
  }
  if (!report.outcomes.empty() && !quiet) {
    std::printf("(%zu suites were there already, in %s)\n", report.outcomes.size(), folder.c_str());
  }
  for (SuiteOutcome& outcome :
       run(to_run, report.variants, report.options, [&](const SuiteOutcome& done) {
         if (saved) saved->save(done);
         say(done);
       })) {
    report.outcomes.push_back(std::move(outcome));
  }
  std::ranges::sort(report.outcomes, {}, &SuiteOutcome::suite);  // they are in one array
  if (saved) PendingFile(std::filesystem::path(folder) / "run.json", report.json()).commit();
  print_failures(report, minimised);
  std::printf("%s\n", report.summary().c_str());
  const bool any_exact = std::ranges::any_of(report.variants, &VariantKind::exact);
  return report.passed() || !any_exact ? 0 : 1;
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
