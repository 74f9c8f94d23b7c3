// Stress test: checks engines and variants against exact integers, on hard cases.
#include "host/lab/stress/stress.h"

#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>

namespace raygate::lab {
namespace {

constexpr std::uint64_t kBlockTests = 4096;  // tests per block

/// Returns the FNV-1a hash.
std::uint64_t digest(std::string_view bytes) {
  std::uint64_t result = 14695981039346656037u;
  for (const char c : bytes) result = (result ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return result;
}

/// Returns the number of rays that claim to start inside a mesh but, by the oracle, cross it an
/// even number of times. Either the generator or RaySpawner, for reflected rays, is wrong.
std::uint64_t broken_claims(const Shot& shot, const Truth& truth) {
  return !shot.inside ? 0
                      : static_cast<std::uint64_t>(std::ranges::count_if(
                            truth.orders, [](const auto& hits) { return hits.size() % 2 == 0; }));
}

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

}  // namespace

std::vector<Row> run(const Suite& suite, std::vector<SubjectKind> kinds, std::uint64_t tests,
                     std::uint64_t seed) {
  std::erase_if(kinds, [&](const SubjectKind& kind) { return suite.binary64 && !kind.binary64; });
  const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
  std::vector<Tally> tallies(kinds.size());
  std::uint64_t broken = 0;
  std::vector<std::unique_ptr<Subject>> subjects;
  subjects.reserve(kinds.size());
  for (const SubjectKind& kind : kinds) subjects.push_back(kind.make());
  Random random(seed ^ digest(suite.name));
  const Generator generate = suite.make();
  std::vector<Shot> shots;
  std::vector<Truth> truths;
  Answers answers;
  for (bool more = true; more;) {
    more = false;
    shots.clear();
    truths.clear();
    for (std::uint64_t made = 0; made < kBlockTests; made += shots.back().tests()) {
      shots.push_back(generate(random));
      truths.push_back(find_truth(shots.back()));
      broken += broken_claims(shots.back(), truths.back());
    }
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      const auto wanted = static_cast<std::uint64_t>(kinds[i].share * static_cast<double>(tests));
      if (tallies[i].tests != 0 && tallies[i].tests >= wanted) continue;
      answers.orders.clear();  // only some subjects set it
      answers.refused.clear();
      subjects[i]->run(shots, answers);
      count(shots, truths, answers, kinds[i], tallies[i]);
      more = more || tallies[i].tests < wanted;
    }
  }
  const double seconds = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    Row& row = rows.emplace_back(Row{{"table", "stress"},
                                     {"suite", suite.name},
                                     {"suite_is", suite.what},
                                     {"binary64", suite.binary64},
                                     {"subject", kinds[i].name},
                                     {"subject_is", kinds[i].what},
                                     {"exact", kinds[i].exact},
                                     {"simulated", kinds[i].simulated},
                                     {"spotless", tallies[i].spotless()},
                                     {"broken_claims", broken},
                                     {"seconds", seconds}});
    row.update(tallies[i].row());
  }
  return rows;
}

void add_stress(CLI::App& lab) {
  struct Asked {
    std::uint64_t tests = 10'000'000, seed = 1;
    std::vector<std::string> suites = names_of(all_suites()), subjects = names_of(all_subjects());
    bool listed = false;
  };
  auto* app = lab.add_subcommand("stress", "engines and cheaper arithmetic in hard cases");
  const auto asked = std::make_shared<Asked>();
  app->add_option("--tests", asked->tests,
                  "tests of the cpu engine for each suite; others do their share of it");
  app->add_option("--seed", asked->seed, "of everything random");
  app->add_option("--suite", asked->suites, "only these suites")
      ->check(CLI::IsMember(asked->suites));
  app->add_option("--subject", asked->subjects, "only these engines and variants")
      ->check(CLI::IsMember(asked->subjects));
  app->add_flag("--list", asked->listed, "the suites' names, and no more");
  app->callback([asked] {
    // Makes the heap keep freed memory: some suites repeatedly allocate 2 MB to compare distances
    // exactly, and its pages would be returned to the system each time.
    mallopt(M_MMAP_THRESHOLD, 1 << 24);
    mallopt(M_TRIM_THRESHOLD, 1 << 25);
    std::vector<SubjectKind> subjects = all_subjects();
    std::erase_if(subjects, [&](const SubjectKind& kind) {
      return std::ranges::count(asked->subjects, kind.name) == 0;
    });
    for (const Suite& suite : all_suites()) {
      if (std::ranges::count(asked->suites, suite.name) == 0) continue;
      if (asked->listed) {
        std::printf("%s\n", suite.name.c_str());
        continue;
      }
      for (const Row& row : run(suite, subjects, asked->tests, asked->seed)) print(row);
    }
  });
}

}  // namespace raygate::lab
