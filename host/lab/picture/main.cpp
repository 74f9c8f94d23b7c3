// Pictures by any variant of arithmetic, timed and judged: what `make bench` is made of.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "host/film/pending_file.h"
#include "host/lab/picture/bench_run.h"
#include "host/lab/variants/variant_check.h"
#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

using nlohmann::json;

json table_of_variants() {
  json list = json::array();
  for (const Variant& variant : all_variants_of_arithmetic()) {
    list.push_back({{"name", variant.name},
                    {"unit", variant.unit == Variant::Unit::kPipeline ? "pipeline" : "serial"},
                    {"exponent_bits", variant.math.exponent_bits},
                    {"digits", variant.math.digits},
                    {"rounding", static_cast<int>(variant.math.rounding)},
                    {"flush", variant.math.flush},
                    {"quotient_digits", variant.math.quotient_digits},
                    {"fused", variant.math.fused},
                    {"doubts", variant.doubts},
                    {"hardware", variant.has_hardware()}});
  }
  return list;
}

json check_all(std::uint64_t tests, std::uint64_t seed) {
  json list = json::array();
  for (const Variant& variant : all_variants_of_arithmetic()) {
    if (!variant.has_hardware()) continue;
    std::fprintf(stderr, "%s: twin against hardware\n", variant.name.c_str());
    const VariantCheck check = check_variant(variant, tests, seed);
    list.push_back({{"variant", variant.name},
                    {"tests", check.tests},
                    {"misses", check.misses},
                    {"hits", check.hits},
                    {"doubts", check.doubts},
                    {"near_ties", check.near_ties},
                    {"clocks", check.clocks},
                    {"seed", seed},
                    {"difference", check.difference}});
  }
  return list;
}

json read_json(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw InputError(file + ": cannot be read");
  try {
    return json::parse(in);
  } catch (const json::exception& error) {
    throw InputError(file + ": " + error.what());
  }
}

int run_bench(int argc, char** argv) {
  std::string run, runs_file, output;
  bool list = false;
  std::uint64_t tests = 0, seed = 1;
  CLI::App app("Renders, times and judges pictures in any variant of arithmetic; prints JSON.");
  auto* what = app.add_option_group("what");
  what->add_option("--run", run, "one run, a JSON object (see host/lab/picture/bench_run.h)");
  what->add_option("--runs", runs_file, "a file with an array of them, their repeats interleaved");
  what->add_flag("--list", list, "the variants of arithmetic that there are");
  what->add_option("--check", tests, "so many tests of each variant: is its twin the hardware?");
  what->require_option(1);
  app.add_option("--seed", seed, "of --check");
  app.add_option("-o,--output", output, "write there and not to standard output");
  CLI11_PARSE(app, argc, argv);

  json result;
  if (list) {
    result = table_of_variants();
  } else if (tests != 0) {
    result = check_all(tests, seed);
  } else {
    const json objects =
        runs_file.empty() ? json::array({json::parse(run, nullptr, false)}) : read_json(runs_file);
    if (!objects.is_array()) throw InputError(runs_file + ": expected an array of runs");
    std::vector<BenchRun> runs;
    for (const json& object : objects) runs.push_back(parse_run(object));
    result =
        measure(runs, [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); });
  }
  const std::string text = result.dump(1) + "\n";
  if (output.empty()) {
    std::fputs(text.c_str(), stdout);
  } else {
    PendingFile(output, text).commit();
  }
  if (tests == 0) return 0;
  return std::ranges::all_of(
             result, [](const json& c) { return c["difference"].get<std::string>().empty(); })
             ? 0
             : 1;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  try {
    return raygate::run_bench(argc, argv);
  } catch (const raygate::InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
