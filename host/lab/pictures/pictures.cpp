// Pictures by any variant of arithmetic, and whether the variants' reference models are the
// hardware: what `make bench` is made of.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "host/base/input_error.h"
#include "host/lab/commands.h"
#include "host/lab/pictures/picture_run.h"
#include "host/lab/variants/variant_check.h"

namespace raygate::lab {
namespace {

/// Whether the reference model is the hardware.
bool check(const Variant& variant, std::uint64_t tests, std::uint64_t seed, Results& results,
           TextTable& table) {
  const VariantCheck check = check_variant(variant, tests, seed);
  const Row row = {{"table", "checks"},
                   {"variant", variant.name},
                   {"tests", check.tests},
                   {"misses", check.misses},
                   {"hits", check.hits},
                   {"doubts", check.doubts},
                   {"near_ties", check.near_ties},
                   {"clocks", check.clocks},
                   {"seed", seed},
                   {"difference", check.difference.empty() ? "none" : check.difference}};
  results.add(row);
  table.print(row);
  return check.difference.empty();
}

std::vector<PictureRun> read_runs(const std::string& run, const std::string& file) {
  std::ifstream in(file);
  if (run.empty() && !in) throw InputError(file + ": cannot be read");
  const Row given =
      run.empty() ? Row::parse(in, nullptr, false) : Row::array({Row::parse(run, nullptr, false)});
  if (!given.is_array()) throw InputError(file + ": expected a JSON array of runs");
  std::vector<PictureRun> runs;
  for (const Row& object : given) runs.push_back(parse_run(object));
  return runs;
}

}  // namespace

void add_variants(CLI::App& lab, Common& common) {
  auto* app = lab.add_subcommand("variants", "the variants of arithmetic that there are");
  app->callback([&common] {
    Results results(common.results);
    TextTable table({{"variant", "variant", -1, 18},
                     {"unit", "unit", -1, 8},
                     {"exponent_bits", "exponent bits"},
                     {"digits", "digits"},
                     {"rounding", "rounding"}});
    for (const Variant& variant : all_variants_of_arithmetic()) {
      Row row = {{"table", "variants"}};
      row.update(variant.row());
      results.add(row);
      table.print(row);
    }
  });
}

void add_check(CLI::App& lab, Common& common) {
  auto* app = lab.add_subcommand(
      "check", "is each variant's reference model its hardware? exit status 1: no");
  struct Asked {
    std::uint64_t tests = 1'000'000, seed = 1;
  };
  const auto asked = std::make_shared<Asked>();
  app->add_option("--tests", asked->tests, "of each variant");
  app->add_option("--seed", asked->seed, "of everything random");
  app->callback([asked, &common] {
    Results results(common.results);
    TextTable table({{"variant", "variant", -1, 18},
                     {"tests", "tests", -1, 9},
                     {"misses", "misses", -1, 9},
                     {"hits", "hits", -1, 9},
                     {"doubts", "doubts", -1, 9},
                     {"near_ties", "near ties", -1, 9},
                     {"difference", "difference"}});
    for (const Variant& variant : all_variants_of_arithmetic()) {
      if (!variant.has_hardware()) continue;
      if (!check(variant, asked->tests, asked->seed, results, table)) common.status = 1;
    }
  });
}

void add_pictures(CLI::App& lab, Common& common) {
  auto* app = lab.add_subcommand("pictures", "pictures in any variant, timed and judged");
  struct Asked {
    std::string run, file;
  };
  const auto asked = std::make_shared<Asked>();
  auto* what = app->add_option_group("what");
  what->add_option("--run", asked->run, "one run, a JSON object (host/lab/pictures/picture_run.h)");
  what->add_option("--runs", asked->file, "a file with an array of them, repeats interleaved");
  what->require_option(1);
  app->callback([asked, &common] {
    Results results(common.results);
    const auto rows = measure(read_runs(asked->run, asked->file), [](const std::string& line) {
      std::fprintf(stderr, "%s\n", line.c_str());
    });
    for (const Row& row : rows) {
      results.add(row);
      if (common.results.empty()) std::printf("%s\n", row.dump(1).c_str());
    }
  });
}

}  // namespace raygate::lab
