// Prints COUNT operations with MPFR's results, one per line: rounding mode, tininess, operands,
// result and flags, in decimal. Arguments: exponent width, fraction width, FloatOp, COUNT.
#include <cstdio>
#include <cstdlib>
#include <random>

#include "sim/fp/vectors.h"
#include "sim/test/fp/oracle.h"

using namespace raygate;

int main(int, char** argv) {
  const FloatFormat format{std::atoi(argv[1]), std::atoi(argv[2])};
  const auto op = static_cast<FloatOp>(std::atoi(argv[3]));
  const long count = std::atol(argv[4]);
  const std::vector<OperandPair> edges = crossed_edges(format);
  PairSource source(format, op, 1);
  std::mt19937 engine(1);
  for (long i = 0; i < count; ++i) {
    // Every second pair of operands is from `edges`.
    const auto [a, b] = i % 2 == 0 ? edges[engine() % edges.size()] : source.next();
    const auto rounding = static_cast<RoundingMode>(engine() % 5);
    const auto tininess = static_cast<Tininess>(engine() % 2);
    const FloatResult result =
        is_comparison(op) ? oracle_compare(format, op, a, b)
                          : round_exact(format, exact_result(format, op, a, b), rounding, tininess);
    std::printf("%d %d %u %u %u %d\n", static_cast<int>(rounding), static_cast<int>(tininess), a, b,
                result.bits, result.flags);
  }
}
