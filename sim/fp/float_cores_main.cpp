// float_cores: one operation of the Verilated float cores on words from standard input. For other
// programs: raygate.float of Python runs it.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <vector>

#include "sim/fp/float_cores.h"

namespace raygate {
namespace {

constexpr const char* kOperations[] = {"+", "-", "*", "/", "==", "<", "<="};
constexpr const char* kUsage =
    "usage: float_cores + | - | * | / | == | < | <=  EXPONENT_BITS FRACTION_BITS ROUNDING 0|1\n"
    "Reads pairs of operands from standard input, writes result and flags of each to standard\n"
    "output, all as 32-bit words, little-endian. ROUNDING is the number of a RoundingMode; the\n"
    "last word is 1 where tininess is detected before rounding.\n";

/// As many pairs as there are; less than one at the end is refused.
int run(FloatOp op, FloatCores& cores, RoundingMode rounding, Tininess tininess) {
  std::vector<std::uint32_t> words(std::size_t{1} << 16);
  const std::uint32_t unknown = ~cores.format().mask();
  for (;;) {
    const std::size_t bytes = std::fread(words.data(), 1, 4 * words.size(), stdin);
    if (bytes == 0) break;
    if (bytes % 8 != 0) {
      std::fputs("float_cores: found half a pair at the end of the input\n", stderr);
      return 2;
    }
    for (std::size_t i = 0; i < bytes / 4; i += 2) {
      if (((words[i] | words[i + 1]) & unknown) != 0) {
        std::fputs("float_cores: found a word of more bits than the format has\n", stderr);
        return 2;
      }
      const FloatResult result = cores.run(op, words[i], words[i + 1], rounding, tininess);
      words[i] = result.bits;
      words[i + 1] = result.flags;
    }
    if (std::fwrite(words.data(), 1, bytes, stdout) != bytes) return 2;
  }
  return std::fflush(stdout) == 0 ? 0 : 2;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  using namespace raygate;  // NOLINT(google-build-using-namespace)
  int op = 0;
  while (argc == 6 && op < int{std::size(kOperations)} &&
         std::strcmp(argv[1], kOperations[op]) != 0) {
    ++op;
  }
  if (argc != 6 || op == int{std::size(kOperations)}) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  const auto number = [&](int i) { return static_cast<int>(std::strtol(argv[i], nullptr, 10)); };
  const auto cores = rtl_float_cores({number(2), number(3)});
  const int rounding = number(4);
  if (!cores || rounding < 0 || rounding > 4) {
    std::fputs(
        "float_cores: expected a format of 8 and 23, 5 and 10, 8 and 7 or 4 and 3 bits, and "
        "a rounding from 0 to 4\n",
        stderr);
    return 2;
  }
  return run(static_cast<FloatOp>(op), *cores, rounding_of(rounding),
             argv[5][0] == '1' ? Tininess::kBeforeRounding : Tininess::kAfterRounding);
}
