// Prints the paper's Table 1 from operations counted in the simulated units.
#include <cstdio>

#include "sim/table_1_count.h"

using raygate::OperationCount;

namespace {

constexpr std::size_t kTests = 1000;

// The frame for which the paper counts operations.
constexpr double kPixels = 320 * 200;
constexpr double kPolygons = 500;
constexpr double kDepth = 4;  // reflections or refractions
constexpr double kFrameTests = kPixels * kPolygons * kDepth;

double per_test(std::uint64_t count) { return static_cast<double>(count) / kTests; }

// `divisions`: of all tests. `preparation`: operations per frame. Returns the operations per test.
double print_row(const char* form, const OperationCount& count, std::uint64_t divisions,
                 double preparation) {
  const double operations = per_test(count.multiplications + count.additions + divisions);
  const double hit_tests = operations * kFrameTests;
  std::printf("  %-10s %4g %4g %4g %6g   %.4e   %.4e   %.4e\n", form,
              per_test(count.multiplications), per_test(count.additions), per_test(divisions),
              operations, hit_tests, preparation, hit_tests + preparation);
  return operations;
}

void print_table(const char* title, const OperationCount& general, std::uint64_t general_divisions,
                 const OperationCount& proposed, std::uint64_t proposed_divisions) {
  // Three subtractions give a ray's direction; nine translate a polygon's three vertices.
  constexpr double kRays = 3 * kPixels;
  std::printf("%s\n  form          x    +    /    all    hit tests  preparation     together\n",
              title);
  const double before = print_row("general", general, general_divisions, kRays);
  const double after = print_row("proposed", proposed, proposed_divisions, kRays + 9 * kPolygons);
  std::printf("  %.1f %% fewer operations a test\n\n", 100 * (before - after) / before);
}

}  // namespace

int main() {
  const OperationCount general = raygate::count_general_form(kTests);
  const OperationCount proposed = raygate::count_proposed_form(kTests);
  std::printf(
      "Operations of a hit test, counted in %zu tests through each simulated unit, and of a frame\n"
      "of %g pixels, %g polygons and %g reflections or refractions (%g tests).\n\n",
      kTests, kPixels, kPolygons, kDepth, kFrameTests);
  print_table("As the paper counts, quotients of one divisor being one division:", general,
              general.divisors, proposed, proposed.divisors);
  print_table("Every quotient counted:", general, general.quotients, proposed, proposed.quotients);
  std::printf("Clocks: general %.2f a test, proposed %.2f.\n", per_test(general.clocks),
              per_test(proposed.clocks));
}
