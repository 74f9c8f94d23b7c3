// check_vectors: runs test vectors from standard input through the Verilated float cores.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <map>
#include <string>

#include "host/base/input_error.h"
#include "sim/fp/vector_check.h"

namespace raygate {
namespace {

constexpr const char* kDescription =
    "Runs test vectors in Berkeley TestFloat's text format through raygate's Verilated float "
    "cores,\n"
    "for example\n"
    "  testfloat_gen -rminMag f32_mul | check_vectors f32_mul --rounding minMag\n"
    "A vector is a line of two operands, the result and the flags, in hexadecimal.\n"
    "Any NaN result matches any NaN unless --check-nans is given.";

constexpr const char* kFooter =
    "Prints the first 20 differences and a count. Exit status: 0 when there is no difference,\n"
    "1 when there is one or there are no vectors, 2 when the input or the options make no sense.";

int run(int argc, char** argv) {
  const std::map<std::string, RoundingMode> roundings = {
      {"near_even", RoundingMode::kNearestEven},
      {"near_maxMag", RoundingMode::kNearestMaxMagnitude},
      {"minMag", RoundingMode::kTowardZero},
      {"min", RoundingMode::kDown},
      {"max", RoundingMode::kUp}};
  const std::map<std::string, Tininess> tininesses = {{"before", Tininess::kBeforeRounding},
                                                      {"after", Tininess::kAfterRounding}};
  std::map<std::string, VectorFunction> functions;
  for (const VectorFunction& function : vector_functions()) {
    functions.emplace(function.name, function);
  }
  std::string function_name;
  std::string rounding = "near_even";
  std::string tininess = "after";
  VectorCheckOptions options;

  CLI::App app(kDescription, "check_vectors");
  app.footer(kFooter);
  app.add_option("function", function_name, "what the vectors are of")
      ->required()
      ->check(CLI::IsMember(functions));
  app.add_option("--rounding", rounding, "rounding mode")
      ->check(CLI::IsMember(roundings))
      ->capture_default_str();
  app.add_option("--tininess", tininess, "when underflow is detected: before or after rounding")
      ->check(CLI::IsMember(tininesses))
      ->capture_default_str();
  app.add_flag("--check-nans", options.check_nans, "NaN results must agree bit for bit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  const VectorFunction& function = functions.at(function_name);
  options.op = function.op;
  options.rounding = roundings.at(rounding);
  options.tininess = tininesses.at(tininess);
  std::ios::sync_with_stdio(false);
  const auto cores = rtl_float_cores(function.format);
  const VectorCheckSummary summary =
      check_vectors(std::cin, "standard input", *cores, options, std::cout);
  std::cout << function_name << ": " << summary.vectors << " vectors, " << summary.differences
            << " differences\n";
  if (summary.vectors == 0) std::cerr << "check_vectors: no vectors on standard input\n";
  return summary.vectors == 0 || summary.differences != 0 ? 1 : 0;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  try {
    return raygate::run(argc, argv);
  } catch (const raygate::InputError& error) {
    std::cout.flush();
    std::cerr << "check_vectors: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "check_vectors: " << error.what() << '\n';
    return 2;
  }
}
