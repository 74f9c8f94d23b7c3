#include "sim/table_1_count.h"

#include <bit>
#include <random>

#include "Vgeneral_hit_test_unit_open.h"
#include "Vgeneral_hit_test_unit_open___024root.h"
#include "Vhit_test_unit_open.h"
#include "Vhit_test_unit_open___024root.h"
#include "sim/bus_stream.h"
#include "sim/model.h"

namespace raygate {
namespace {

template <std::size_t NumWords>
std::vector<BusTest<NumWords>> random_tests(std::size_t num_tests) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> number(-1.0f, 1.0f);
  std::vector<BusTest<NumWords>> tests(num_tests);
  for (auto& test : tests) {
    for (auto& word : test.words) word = std::bit_cast<std::uint32_t>(number(random));
  }
  return tests;
}

}  // namespace

// The enables read after an edge take effect at the next edge. The first edge takes a word and
// computes nothing, so reading after every edge counts every operation.

OperationCount count_proposed_form(std::size_t num_tests) {
  Model<Vhit_test_unit_open> unit;
  unit.reset();
  OperationCount count;
  const auto* inside = unit->rootp;
  stream_tests(unit, random_tests<7>(num_tests), [&] {
    const bool accumulate = inside->hit_test_unit__DOT__accumulate;
    const bool divide = inside->hit_test_unit__DOT__divide;
    count.multiplications += accumulate || divide;
    count.additions += accumulate;
    count.quotients += divide;
    count.divisors += inside->hit_test_unit__DOT__load_d;
  });
  count.clocks = unit.clocks();
  return count;
}

OperationCount count_general_form(std::size_t num_tests) {
  Model<Vgeneral_hit_test_unit_open> unit;
  unit.reset();
  OperationCount count;
  const auto* inside = unit->rootp;
  stream_tests(unit, random_tests<10>(num_tests), [&] {
    const bool dot = inside->general_hit_test_unit__DOT__dot_origin ||
                     inside->general_hit_test_unit__DOT__dot_direction;
    const bool move = inside->general_hit_test_unit__DOT__move;
    const bool divide = inside->general_hit_test_unit__DOT__divide;
    count.multiplications += dot || move;
    count.additions += (dot && !inside->general_hit_test_unit__DOT__dot_first) || move;
    count.quotients += divide;
    count.divisors += inside->general_hit_test_unit__DOT__dot_last;
  });
  count.clocks = unit.clocks();
  return count;
}

}  // namespace raygate
