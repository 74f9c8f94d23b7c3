// `bench FILE REPEATS` drives a core of float_peers.sv. Each line of FILE has a, b and the right result (hexadecimal).
// Prints the numbers of operations, clocks and wrong results. All NaNs count as equal. Exit status 1: the core hangs.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "Vcore.h"

namespace {
struct Operation {
  unsigned a, b, result;
};
bool is_nan(unsigned bits) { return (bits & 0x7fffffffu) > 0x7f800000u; }
}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  std::vector<Operation> operations;
  std::FILE* file = std::fopen(argv[1], "r");
  for (Operation o{}; file != nullptr && std::fscanf(file, "%x %x %x", &o.a, &o.b, &o.result) == 3;) operations.push_back(o);
  const std::size_t all = operations.size() * std::strtoul(argv[2], nullptr, 10);
  Vcore core;
  std::size_t begun = 0, ended = 0, clocks = 0, differences = 0;
  for (core.rst_ni = 0; ended < all; ++clocks) {
    if (clocks == 4) core.rst_ni = 1;
    if (clocks > 100 * (all + 100)) return 1;
    core.clk_i = 0;
    core.eval();
    core.valid_i = clocks > 4 && begun < all;
    const Operation& next = operations[begun % operations.size()];
    core.a_i = next.a;
    core.b_i = next.b;
    core.eval();
    if (core.valid_i && core.ready_o) ++begun;
    if (clocks > 4 && core.valid_o) {
      const unsigned wanted = operations[ended++ % operations.size()].result;
      differences += core.result_o != wanted && !(is_nan(core.result_o) && is_nan(wanted));
    }
    core.clk_i = 1;
    core.eval();
  }
  std::printf("%zu %zu %zu\n", all, clocks, differences);
  return 0;
}
