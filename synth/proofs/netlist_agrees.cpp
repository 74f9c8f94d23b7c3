// Feeds a netlist and its RTL the same inputs and compares every output bit. The Verilated module
// "twins" (made by synth/netlists.py) instantiates netlist and RTL; differ_o is high if any of
// their outputs differ.
//
// Inputs: uniform random bits, and hard words for float cores: runs of ones and of zeros, and
// smallest and largest exponents.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "Vtwins.h"
#include "verilated.h"

int main(int argc, char** argv) {
  const std::uint64_t vectors = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100000;
  constexpr std::uint64_t kSeed = 20;
  std::mt19937_64 random(kSeed);
  VerilatedContext context;
  Vtwins twins(&context);

  const auto word = [&]() -> std::uint32_t {
    const std::uint64_t bits = random();
    const std::uint32_t low = static_cast<std::uint32_t>(bits);
    switch (bits >> 61) {
      case 0: return (low & 0x807FFFFF) | 0x3F800000;              // near 1
      case 1: return low & 0x807FFFFF;                             // subnormal or zero
      case 2: return low | 0x7F800000;                             // not a number
      case 3: return (low & 0x80000000) | (0x7F800000 * (low & 1));  // zero or infinity
      case 4: return (1U << (low & 31)) - 1;                       // a run of ones
      case 5: return ~((1U << (low & 31)) - 1);
      default: return low;
    }
  };

  for (std::uint64_t i = 0; i < vectors; ++i) {
    twins.clk_i = 0;
    for (std::uint32_t& input : twins.in_i.m_storage) input = word();
    twins.rst_ni = i > 1 && (i % 1000) != 0;
    twins.eval();
    if (twins.differ_o) {
      std::printf("netlist and RTL differ, vector %llu of seed %llu\n",
                  static_cast<unsigned long long>(i), static_cast<unsigned long long>(kSeed));
      std::printf("inputs, lowest word first:");
      for (const std::uint32_t input : twins.in_i.m_storage) std::printf(" %08x", input);
      std::printf("\n");
      return 1;
    }
    twins.clk_i = 1;
    twins.eval();
  }
  std::printf("%llu vectors\n", static_cast<unsigned long long>(vectors));
  return vectors > 0 ? 0 : 1;
}
