// Measures how fast the units are simulated: tests per second on one thread (median of several
// runs) and, if valgrind is installed, instructions per test. This program checks nothing.
//
//   unit_bench                           the table
//   unit_bench ARITH LANES AIMED ROUNDS  only ROUNDS rounds of the stream, for valgrind
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "host/intersect/unit/burst_unit.h"
#include "sim/bench/test_stream.h"
#include "sim/rtl_units.h"

namespace raygate {
namespace {

constexpr int kBursts = 1024, kTests = 8;  // 8,192 tests per round
constexpr int kRuns = 9, kRounds = 8;

struct Kind {
  const char* name;
  Arith arith;
};
constexpr Kind kKinds[] = {{"structural", Arith::kStructural},
                           {"behavioural", Arith::kBehavioural}};

/// Returns the tests per second, the median of kRuns runs.
template <class Round>
double tests_per_second(const Round& round) {
  round();  // warms up the caches
  std::vector<double> rates;
  for (int run = 0; run < kRuns; ++run) {
    const std::clock_t start = std::clock();
    for (int i = 0; i < kRounds; ++i) round();
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    rates.push_back(kRounds * kBursts * kTests / seconds);
  }
  std::nth_element(rates.begin(), rates.begin() + kRuns / 2, rates.end());
  return rates[kRuns / 2];
}

/// Returns the instructions of `command` that valgrind counts; 0 without valgrind.
double instructions(const std::string& command) {
  const std::string counted =
      "valgrind --tool=callgrind --callgrind-out-file=/dev/null " + command + " 2>&1";
  // NOLINTNEXTLINE(bugprone-command-processor): the command is this program under valgrind
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(counted.c_str(), "r"), pclose);
  double count = 0.0;
  char line[512];
  while (pipe != nullptr && std::fgets(line, sizeof line, pipe.get()) != nullptr) {
    const char* colon = std::strstr(line, "Collected :");
    if (colon != nullptr) count = std::strtod(colon + sizeof "Collected :" - 1, nullptr);
  }
  return count;
}

/// Returns the instructions per test, without start-up, from the difference between a long run and
/// a short one.
double instructions_per_test(const char* program, const Kind& kind, int lanes, double aimed) {
  const std::string command = std::string(program) + " " + kind.name + " " + std::to_string(lanes) +
                              " " + std::to_string(aimed) + " ";
  const double few = instructions(command + "1"), many = instructions(command + "4");
  return (many - few) / (3.0 * kBursts * kTests);
}

void run_rounds(Arith arith, int lanes, double aimed, int rounds) {
  const TestStream stream = random_stream(kBursts, kTests, aimed);
  RtlBurstUnit unit(lanes, arith);
  BurstResults results;
  for (int i = 0; i < rounds; ++i) {
    results.clear();
    unit.run(stream.bundles, results);
  }
}

double share_of_hits(const TestStream& stream) {
  ReferenceBurstUnit unit;
  BurstResults results;
  unit.run(stream.bundles, results);
  return 100.0 * static_cast<double>(unit.counters().hits) /
         static_cast<double>(unit.counters().tests);
}

void print_row(const char* unit, const char* arith, const std::string& lanes, double hits,
               double rate, double count) {
  std::printf("%-10s %-12s %5s %8.1f %12.0f", unit, arith, lanes.c_str(), hits, rate);
  if (count > 0.0) std::printf(" %14.0f", count);
  std::printf("\n");
}

void bench(const char* program) {
  // NOLINTNEXTLINE(bugprone-command-processor): a fixed command
  const bool valgrind = std::system("command -v valgrind >/dev/null") == 0;
  std::printf("Median of %d runs of %d tests, on the processor time of one thread.\n", kRuns,
              kRounds * kBursts * kTests);
  std::printf("%-10s %-12s %5s %8s %12s %14s\n", "unit", "arithmetic", "lanes", "hits, %",
              "tests/s", "instructions");
  for (const double aimed : {0.0, 0.5}) {
    const TestStream stream = random_stream(kBursts, kTests, aimed);
    const double hits = share_of_hits(stream);
    for (const Kind& kind : kKinds) {
      for (const int lanes : {1, 2, 4, 8}) {
        RtlBurstUnit unit(lanes, kind.arith);
        BurstResults results;
        const double rate = tests_per_second([&] {
          results.clear();
          unit.run(stream.bundles, results);
        });
        print_row("pipeline", kind.name, std::to_string(lanes), hits, rate,
                  valgrind ? instructions_per_test(program, kind, lanes, aimed) : 0.0);
      }
    }
    ReferenceBurstUnit twin;
    BurstResults results;
    print_row("its twin", "C++", "-", hits, tests_per_second([&] {
                results.clear();
                twin.run(stream.bundles, results);
              }),
              0.0);
  }
  const TestStream stream = random_stream(kBursts, kTests, 0.0);
  std::vector<glm::vec3> points(stream.plane_tests.size());
  for (const Kind& kind : kKinds) {
    RtlPlaneUnit serial(kind.arith);
    print_row("serial", kind.name, "-", share_of_hits(stream),
              tests_per_second([&] { serial.intersect(stream.plane_tests, points); }), 0.0);
  }
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  if (argc == 1) {
    raygate::bench(argv[0]);
    return 0;
  }
  if (argc == 5) {
    for (const raygate::Kind& kind : raygate::kKinds) {
      if (std::strcmp(argv[1], kind.name) != 0) continue;
      raygate::run_rounds(kind.arith, static_cast<int>(std::strtol(argv[2], nullptr, 10)),
                          std::strtod(argv[3], nullptr),
                          static_cast<int>(std::strtol(argv[4], nullptr, 10)));
      return 0;
    }
  }
  std::fputs("usage: unit_bench [structural|behavioural LANES AIMED ROUNDS]\n", stderr);
  return 2;
}
