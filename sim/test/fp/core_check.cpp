#include "sim/test/fp/core_check.h"

#include <cstdio>
#include <cstdlib>

#include "sim/test/fp/x86_fpu.h"

namespace raygate {
namespace {

constexpr RoundingMode kModes[] = {RoundingMode::kNearestEven, RoundingMode::kTowardZero,
                                   RoundingMode::kDown, RoundingMode::kUp,
                                   RoundingMode::kNearestMaxMagnitude};
constexpr Tininess kTininess[] = {Tininess::kBeforeRounding, Tininess::kAfterRounding};

}  // namespace

void CoreCheck::differ(OperandPair operands, RoundingMode rounding, Tininess tininess,
                       FloatResult got, FloatResult expected, const char* whose) {
  if (++differences_ > 20) return;
  char line[160];
  std::snprintf(line, sizeof line,
                "%08x, %08x, rounding %d, tininess %d: got %08x %02x, %s gives %08x %02x\n",
                operands.a, operands.b, static_cast<int>(rounding), static_cast<int>(tininess),
                got.bits, got.flags, whose, expected.bits, expected.flags);
  report_ += line;
}

void CoreCheck::check(OperandPair operands, const ExactValue& exact, RoundingMode rounding,
                      Tininess tininess) {
  const auto [a, b] = operands;
  ++cases_;
  const FloatResult got = cores_.run(op_, a, b, rounding, tininess);
  const FloatResult expected = round_exact(format_, exact, rounding, tininess);
  if (got != expected) differ(operands, rounding, tininess, got, expected, "MPFR");
  if (format_ == kBinary32 && x86_has(rounding) && tininess == Tininess::kAfterRounding) {
    const FloatResult x86 = x86_result(op_, a, b, rounding);
    if (got != x86) differ(operands, rounding, tininess, got, x86, "FPU");
  }
}

void CoreCheck::pair(OperandPair operands, RoundingMode rounding, Tininess tininess) {
  check(operands, exact_result(format_, op_, operands.a, operands.b), rounding, tininess);
}

void CoreCheck::pair(OperandPair operands) {
  const auto [a, b] = operands;
  if (is_comparison(op_)) {
    ++cases_;
    const FloatResult got = cores_.run(op_, a, b, kModes[0], kTininess[0]);
    const FloatResult expected = oracle_compare(format_, op_, a, b);
    if (got != expected) differ(operands, kModes[0], kTininess[0], got, expected, "C++");
    return;
  }
  const ExactValue exact = exact_result(format_, op_, a, b);
  for (const RoundingMode rounding : kModes) {
    for (const Tininess tininess : kTininess) check(operands, exact, rounding, tininess);
  }
}

void CoreCheck::exhaustive() {
  for (std::uint32_t a = 0; a <= format_.mask(); ++a) {
    for (std::uint32_t b = 0; b <= format_.mask(); ++b) pair({a, b});
  }
}

void CoreCheck::structured(std::uint64_t count, std::uint64_t seed) {
  for (const OperandPair operands : crossed_edges(format_)) pair(operands);
  PairSource source(format_, op_, seed);
  for (std::uint64_t i = 0; i < count; ++i) pair(source.next());
}

std::uint64_t test_seed() {
  static const std::uint64_t seed = [] {
    const char* text = std::getenv("RAYGATE_SEED");
    const std::uint64_t value = text != nullptr ? std::strtoull(text, nullptr, 0) : 1;
    std::printf("seed %llu (set RAYGATE_SEED for another)\n",
                static_cast<unsigned long long>(value));
    return value;
  }();
  return seed;
}

}  // namespace raygate
