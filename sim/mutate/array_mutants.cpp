#include "sim/mutate/array_mutants.h"

#include <algorithm>
#include <exception>
#include <iterator>
#include <stdexcept>

#include "Vhit_test_array_mutants.h"
#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "sim/array_model.h"
#include "sim/random_bursts.h"

namespace raygate {
namespace {

/// The netlist with the fault that was chosen last.
class FaultyArray : public Vhit_test_array_mutants {
 public:
  static inline std::uint16_t chosen = 0;

  FaultyArray(VerilatedContext* context, const char* name)
      : Vhit_test_array_mutants(context, name) {
    mutant = chosen;
  }
};

/// A run of batches under random stalls, and what should come out.
struct Run {
  BurstStalls stalls;
  std::vector<BurstBatch> batches;
  std::vector<BurstResults> expected;
  BurstCounters counters;
};

/// As in rtl_burst_unit_test, so many tests in all.
std::vector<Run> make_runs(std::uint64_t tests) {
  std::vector<Run> runs;
  RandomBursts random(1);
  std::mt19937_64 size(1);
  for (const auto& [no_test, not_taken, share] : {std::tuple{0, 0, 4},
                                                  {64, 0, 8},
                                                  {0, 96, 8},
                                                  {40, 64, 4},
                                                  {200, 0, 16},
                                                  {0, 230, 16},
                                                  {100, 200, 8}}) {
    Run& run = runs.emplace_back();
    run.stalls = {no_test, not_taken, 1};
    ReferenceBurstUnit reference;
    for (std::uint64_t part = 0; part < tests / static_cast<std::uint64_t>(share);) {
      run.batches.push_back(random.make(1 + size() % (size() % 2 == 0 ? 50 : 5'000)));
      part += run.batches.back().tests;
      reference.run(run.batches.back().bundles, run.expected.emplace_back());
    }
    run.counters = reference.counters();
  }
  return runs;
}

/// Batches follow each other closely: each starts before the one before is over.
bool as_expected(const Run& run) {
  ArrayModel<FaultyArray> array(1, run.stalls);
  const auto finish = [&](std::size_t i) {
    BurstResults got;
    array.finish(got);
    require_same(run.batches[i].bundles, got, run.expected[i]);
  };
  array.start(run.batches[0].bundles);
  for (std::size_t i = 1; i < run.batches.size(); ++i) {
    array.start(run.batches[i].bundles);
    finish(i - 1);
  }
  finish(run.batches.size() - 1);
  const BurstCounters got = array.counters();
  return got.tests == run.counters.tests && got.misses == run.counters.misses &&
         got.hits == run.counters.hits && got.doubts == run.counters.doubts &&
         got.near_ties == run.counters.near_ties && got.distances == run.counters.distances &&
         got.coordinates == run.counters.coordinates;
}

bool survives(std::uint32_t fault, const std::vector<Run>& runs) {
  FaultyArray::chosen = static_cast<std::uint16_t>(fault);
  try {
    return std::ranges::all_of(runs, as_expected);
  } catch (const std::exception&) {  // a difference, a result for nobody, or none for long
    return false;
  }
}

}  // namespace

std::vector<std::uint32_t> array_survivors(const std::vector<std::uint32_t>& faults,
                                           std::uint64_t one_in) {
  constexpr std::uint64_t kTests = 1'000'000;
  const std::vector<Run> few = make_runs(200), all = make_runs(kTests / one_in);
  if (!survives(0, all)) throw std::logic_error("the netlist without a fault is wrong");
  std::vector<std::uint32_t> survivors;
  std::ranges::copy_if(faults, std::back_inserter(survivors), [&](std::uint32_t fault) {
    return survives(fault, few) && survives(fault, all);
  });
  return survivors;
}

}  // namespace raygate
