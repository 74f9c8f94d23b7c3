// Rows of measurements, times, and the commands of `lab`.
#pragma once

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <memory>
#include <vector>

#include "host/intersect/unit/hit_tester.h"
#include "host/variants/variant_table.h"

namespace CLI {
class App;
}

namespace raygate::lab {

/// A row; column `table` names its table. Infinity and NaN are null, as JSON has neither.
using Row = Json;

/// Prints a row: a JSON object, alone on its line.
inline void print(const Row& row) {
  std::printf("%s\n", row.dump().c_str());
  std::fflush(stdout);
}

/// Returns the time of CLOCK_THREAD_CPUTIME_ID (this thread) or CLOCK_PROCESS_CPUTIME_ID. Unlike
/// wall time, it excludes other processes.
inline double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Returns the quantile `part`, in [0, 1], of at least one value.
inline double quantile(std::vector<double> values, double part) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Returns a tester with the unit Verilated with the variant's parameters, or null if this build
/// has no such unit. Not thread-safe.
[[nodiscard]] std::unique_ptr<HitTester> make_rtl_variant_tester(const Variant& variant);

/// Declares a command and its options. Parsing a command's name runs the command; it prints rows.
using AddCommand = void(CLI::App& lab);

AddCommand add_stress;      ///< correctness of engines and variants in hard cases
AddCommand add_watertight;  ///< public tests of watertightness
AddCommand add_rays;        ///< rays per second, compared with Embree
AddCommand add_core;        ///< clocks per ray of the ray core
AddCommand add_variants;    ///< prints the table of variants
AddCommand add_check;       ///< reference models against hardware
AddCommand add_pictures;    ///< images by any variant, timed and audited

}  // namespace raygate::lab
