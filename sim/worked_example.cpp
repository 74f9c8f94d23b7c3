// Sends the paper's worked example (section 4.2) through the paper's unit, one clock at a time.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <exception>
#include <limits>
#include <string>

#include "Vhit_test_unit_open.h"
#include "Vhit_test_unit_open___024root.h"
#include "Vhit_test_unit_paper.h"
#include "Vhit_test_unit_paper___024root.h"
#include "sim/bus_stream.h"
#include "sim/wave_model.h"

namespace {

using raygate::BusTest;
using raygate::InputError;
using raygate::WaveModel;

constexpr const char* kUsage =
    R"(usage: worked_example [--paper-divider] [--trace FILE]

Sends the paper's worked example through the simulated hit-test unit and prints what every register
holds after each clock edge, as IEEE binary32 words; - where it holds no word of the example.

  --paper-divider  cut quotients off after 21 significand bits, as the paper's divider did
  --trace FILE     write the waveform to FILE (VCD, for GTKWave and others)
)";

// I, H and d: the only values that give the paper's own results.
constexpr std::array<float, 7> kWords = {3.3125f,  5.875f,    2.921875f, 15.1875f,
                                         0.46875f, 2.109375f, 1.75f};
constexpr std::array<const char*, 7> kNames = {"Ix", "Iy", "Iz", "a", "b", "c", "d"};

// Prints a register's word after the edges `first` to `last`, when it belongs to the example, or
// else "-". After other edges the word is the reset value or a bus word from between tests.
void print_register(std::uint32_t word, std::uint64_t edge, std::uint64_t first,
                    std::uint64_t last = std::numeric_limits<std::uint64_t>::max()) {
  if (first <= edge && edge <= last) {
    std::printf(" %08X", word);
  } else {
    std::printf(" %-8s", "-");
  }
}

struct Options {
  bool paper_divider = false;
  std::string trace;
};

template <class Top>
void run(const Options& options) {
  WaveModel<Top> unit;
  if (!options.trace.empty()) unit.record(options.trace);
  unit.reset();

  BusTest<7> test;
  std::transform(kWords.begin(), kWords.end(), test.words.begin(),
                 [](float value) { return std::bit_cast<std::uint32_t>(value); });
  std::printf("I = (%.9g, %.9g, %.9g), N = (%.9g, %.9g, %.9g), d = %.9g: the words 1 to 7\n",
              kWords[0], kWords[1], kWords[2], kWords[3], kWords[4], kWords[5], kWords[6]);
  std::printf("edge  in  I-1      I-2      I-3      N        d        accum.   divisor  out\n");
  const auto* inside = unit->rootp;
  const auto results = raygate::stream_tests(unit, std::vector{test}, [&] {
    const std::uint64_t edge = unit.clocks();
    std::printf("%4d  %-2s ", static_cast<int>(edge),
                edge <= kNames.size() ? kNames[edge - 1] : "");
    print_register(inside->hit_test_unit__DOT__direction_1_q, edge, 4, 10);
    print_register(inside->hit_test_unit__DOT__direction_2_q, edge, 3, 9);
    print_register(inside->hit_test_unit__DOT__direction_3_q, edge, 2, 8);
    print_register(inside->hit_test_unit__DOT__normal_q, edge, 1, 7);
    print_register(inside->hit_test_unit__DOT__d_q, edge, 7);
    print_register(inside->hit_test_unit__DOT__accumulator_q, edge, 4);
    print_register(inside->hit_test_unit__DOT__divisor_q, edge, 7);
    if (unit->valid_o) std::printf(" %08X", unit->bus_o);
    std::printf("\n");
  });
  const auto& result = results.front();
  std::printf("P = %08X %08X %08X = (%.9g, %.9g, %.9g), %d clocks after the first word\n",
              result.point[0], result.point[1], result.point[2],
              std::bit_cast<float>(result.point[0]), std::bit_cast<float>(result.point[1]),
              std::bit_cast<float>(result.point[2]),
              static_cast<int>(result.last_component - result.first_word + 1));
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--paper-divider") == 0) {
      options.paper_divider = true;
    } else if (std::strcmp(argv[i], "--trace") == 0 && i + 1 < argc) {
      options.trace = argv[++i];
    } else {
      throw InputError(std::string(argv[i]) + ": expected --paper-divider or --trace FILE");
    }
  }
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--help") == 0) {
    std::fputs(kUsage, stdout);
    return 0;
  }
  try {
    const Options options = parse(argc, argv);
    if (options.paper_divider) {
      run<Vhit_test_unit_paper>(options);
    } else {
      run<Vhit_test_unit_open>(options);
    }
  } catch (const InputError& error) {
    std::fprintf(stderr, "worked_example: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {  // a fault of the unit
    std::fprintf(stderr, "worked_example: %s\n", error.what());
    return 1;
  }
}
