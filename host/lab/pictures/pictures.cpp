// Commands for `make bench`: images by any variant of arithmetic, and checks of the variants'
// reference models against hardware.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "host/base/input_error.h"
#include "host/lab/commands.h"
#include "host/lab/pictures/picture_run.h"
#include "host/lab/variants/rtl_variant_units.h"

namespace raygate::lab {
namespace {

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

void add_variants(CLI::App& lab, Outcome& outcome) {
  lab.add_subcommand("variants", "the variants of arithmetic that there are")->callback([&outcome] {
    for (const Variant& variant : all_variants_of_arithmetic()) {
      Row row = {{"table", "variants"}};
      row.update(variant.row());
      outcome.results.add(std::move(row));
    }
  });
}

void add_check(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand(
      "check", "is each variant's reference model its hardware? exit status 1: no");
  struct Asked {
    std::uint64_t tests = 1'000'000, seed = 1;
  };
  const auto asked = std::make_shared<Asked>();
  app->add_option("--tests", asked->tests, "of each variant");
  app->add_option("--seed", asked->seed, "of everything random");
  app->callback([asked, &outcome] {
    for (const Variant& variant : all_variants_of_arithmetic()) {
      if (!variant.has_hardware()) continue;
      const VariantCheck check = check_variant(variant, asked->tests, asked->seed);
      if (!check.difference.empty()) outcome.status = 1;
      outcome.results.add({{"table", "checks"},
                           {"variant", variant.name},
                           {"tests", check.tests},
                           {"misses", check.misses},
                           {"hits", check.hits},
                           {"doubts", check.doubts},
                           {"near_ties", check.near_ties},
                           {"clocks", check.clocks},
                           {"seed", asked->seed},
                           {"difference", check.difference.empty() ? "none" : check.difference}});
    }
  });
}

void add_pictures(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand("pictures", "pictures in any variant, timed and judged");
  struct Asked {
    std::string run, file;
  };
  const auto asked = std::make_shared<Asked>();
  auto* what = app->add_option_group("what");
  what->add_option("--run", asked->run, "one run, a JSON object (host/lab/pictures/picture_run.h)");
  what->add_option("--runs", asked->file, "a file with an array of them, repeats interleaved");
  what->require_option(1);
  app->callback([asked, &outcome] {
    for (Row& row : measure(read_runs(asked->run, asked->file))) {
      if (!asked->run.empty()) std::printf("%s\n", row.dump(1).c_str());
      outcome.results.keep(std::move(row));
    }
  });
}

}  // namespace raygate::lab
