// The paper's hit-test unit for the page of `make page`: one test, clock by clock, with a
// fault-free adder or an adder with a broken gate.
#include <array>
#include <cstddef>
#include <cstdint>

#include "Vhit_test_unit_page.h"
#include "Vhit_test_unit_page___024root.h"
#include "sim/model.h"

namespace {

constexpr std::size_t kWords = 7;   // I, N, d
constexpr std::size_t kEdges = 10;  // until the last component is out

/// Registers of the unit after a clock edge, as binary32 words.
struct Row {
  std::uint32_t direction_3, direction_2, direction_1, normal, d, accumulator, divisor, output;
  std::uint32_t is_out;  ///< 1: `output` is a component of P
};

}  // namespace

/// Sends I, N and d (seven binary32 words) through the unit. `fault`: 0, or the number of a fault
/// in the list made with the adder's netlist. Returns ten Rows of nine words each, one Row per
/// clock edge; they are valid until the next call.
extern "C" const std::uint32_t* run_unit(const std::uint32_t* words, std::uint32_t fault) {
  static std::array<Row, kEdges> rows;
  raygate::Model<Vhit_test_unit_page> unit;
  Vhit_test_unit_page___024root& inside = *unit->rootp;
  inside.hit_test_unit__DOT__u_adder__DOT__mutant = static_cast<std::uint16_t>(fault);
  unit->rst_ni = 0;
  unit->valid_i = 0;
  unit.clock();
  unit->rst_ni = 1;
  for (std::size_t edge = 0; edge < kEdges; ++edge) {
    unit->valid_i = edge == 0;
    unit->bus_i = edge < kWords ? words[edge] : 0;
    unit.clock();
    rows[edge] = {.direction_3 = inside.hit_test_unit__DOT__direction_3_q,
                  .direction_2 = inside.hit_test_unit__DOT__direction_2_q,
                  .direction_1 = inside.hit_test_unit__DOT__direction_1_q,
                  .normal = inside.hit_test_unit__DOT__normal_q,
                  .d = inside.hit_test_unit__DOT__d_q,
                  .accumulator = inside.hit_test_unit__DOT__accumulator_q,
                  .divisor = inside.hit_test_unit__DOT__divisor_q,
                  .output = unit->bus_o,
                  .is_out = unit->valid_o};
  }
  static_assert(sizeof(Row) == 9 * sizeof(std::uint32_t));
  return &rows.front().direction_3;
}
