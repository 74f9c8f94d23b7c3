#include "host/lab/stress/runner.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <exception>
#include <mutex>
#include <thread>

namespace raygate::stress {
namespace {

constexpr std::uint64_t kBlockTests = 4096;  // made, decided and counted at once

std::uint64_t hash(const std::string& text) {  // FNV-1a
  std::uint64_t result = 14695981039346656037u;
  for (const char c : text) result = (result ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return result;
}

/// Of this thread. On a machine that does other things as well, the time on the wall says little.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

SuiteOutcome run_suite(const Suite& suite, const std::vector<VariantKind>& kinds,
                       const RunOptions& options) {
  const double start = processor_seconds();
  SuiteOutcome outcome;
  outcome.suite = &suite;
  outcome.tallies.resize(kinds.size());
  std::vector<std::unique_ptr<Variant>> variants;
  std::vector<std::uint64_t> wanted;
  for (const VariantKind& kind : kinds) {
    variants.push_back(kind.make());
    wanted.push_back(std::max<std::uint64_t>(
        1, static_cast<std::uint64_t>(kind.share * static_cast<double>(options.tests))));
  }
  Random random(options.seed ^ hash(suite.name));
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
        outcome.broken_claims += hits % 2 == 0;
      }
    }
    for (std::size_t v = 0; v < variants.size(); ++v) {
      Tally& tally = outcome.tallies[v];
      if (tally.tests >= wanted[v]) continue;
      variants[v]->run(shots, answers);
      count(shots, truths, answers, kinds[v].exact, tally);
      more = more || tally.tests < wanted[v];
    }
  }
  outcome.seconds = processor_seconds() - start;
  return outcome;
}

}  // namespace

std::vector<SuiteOutcome> run(const std::vector<const Suite*>& suites,
                              const std::vector<VariantKind>& variants, const RunOptions& options,
                              const std::function<void(const SuiteOutcome&)>& done) {
  std::vector<SuiteOutcome> outcomes(suites.size());
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for (std::size_t i; (i = next++) < suites.size();) {
        outcomes[i] = run_suite(*suites[i], variants, options);
        const std::scoped_lock lock(mutex);
        done(outcomes[i]);
      }
    } catch (...) {
      const std::scoped_lock lock(mutex);
      error = std::current_exception();
      next = suites.size();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < options.threads; ++i) threads.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
  return outcomes;
}

}  // namespace raygate::stress
