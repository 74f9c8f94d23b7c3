// Drives a serial hit-test unit over its bus, for tests and tools.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <vector>

namespace raygate {

/// One test of a unit whose tests have NumWords words.
template <std::size_t NumWords>
struct BusTest {
  std::array<std::uint32_t, NumWords> words;  ///< in the order of the bus
  unsigned gap = 0;  ///< clocks to wait before the first word, from when the unit is ready
};

struct BusResult {
  std::array<std::uint32_t, 3> point;  ///< Px, Py, Pz
  std::uint64_t first_word;            ///< number, from 1, of the edge that took the first word
  std::uint64_t last_component;        ///< number of the edge after which Pz was on the bus
};

/// Sends `tests` through `unit`, a Model or WaveModel that has been reset. Each test starts as soon
/// as the unit is ready and the test's gap is over. Between tests the input bus carries noise.
/// Calls `after_clock()` after each clock, including that of the last result. Throws
/// std::runtime_error if a result comes before its test, or if nothing happens for 64 clocks.
template <class UnitModel, std::size_t NumWords, class AfterClock>
std::vector<BusResult> stream_tests(UnitModel& unit, const std::vector<BusTest<NumWords>>& tests,
                                    AfterClock&& after_clock) {
  std::mt19937 noise(1);
  std::vector<BusResult> results;
  std::size_t word = 0;            // next word of the test that is being sent
  unsigned waited = 0;             // clocks for which the unit has been ready for the next test
  std::size_t component = 0;       // next component; three per result
  std::uint64_t quiet_until = 64;  // the edge by which something must have happened
  for (std::uint64_t edge = 1; component < 3 * tests.size(); ++edge) {
    const bool more = results.size() < tests.size();
    const bool first = word == 0 && more && unit->ready_o && waited++ == tests[results.size()].gap;
    if (first) {
      results.push_back({.point = {}, .first_word = edge, .last_component = 0});
      waited = 0;
    }
    const bool sending = first || word != 0;
    unit->valid_i = first;
    unit->bus_i = sending ? tests[results.size() - 1].words[word] : noise();
    if (sending) word = (word + 1) % NumWords;
    unit.clock();
    if (unit->valid_o) {
      if (component >= 3 * results.size()) throw std::runtime_error("a result before its test");
      BusResult& result = results[component / 3];
      result.point[component % 3] = unit->bus_o;
      result.last_component = edge;
      ++component;
    }
    if (sending || waited != 0 || unit->valid_o) quiet_until = edge + 64;
    if (edge == quiet_until) throw std::runtime_error("the unit gives no result");
    after_clock();
  }
  return results;
}

template <class UnitModel, std::size_t NumWords>
std::vector<BusResult> stream_tests(UnitModel& unit, const std::vector<BusTest<NumWords>>& tests) {
  return stream_tests(unit, tests, [] {});
}

}  // namespace raygate
