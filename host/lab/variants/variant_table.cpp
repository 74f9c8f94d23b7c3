#include "host/lab/variants/variant_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <utility>

#include "host/lab/variants/variants_text.h"
#include "host/scene/io/input_error.h"

namespace raygate {
namespace {

/// One line of the table, word by word.
class Line {
 public:
  Line(std::string_view file, std::size_t number, const std::string& text)
      : file_(file), number_(number), words_(text) {}

  /// The next word.
  std::string word(const char* column) {
    std::string word;
    if (!(words_ >> word)) fail("no " + std::string(column));
    return word;
  }

  int number(const char* column, int low, int high) {
    return to_number(word(column), column, low, high);
  }

  int to_number(const std::string& word, const char* column, int low, int high) const {
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < low || value > high) {
      fail(std::string(column) + " is " + word + ", expected " + std::to_string(low) + " to " +
           std::to_string(high));
    }
    return value;
  }

  /// Which of `choices` the next word is.
  template <std::size_t n>
  int choice(const char* column, const std::array<const char*, n>& choices) {
    const std::string found = word(column);
    const auto place = std::ranges::find(choices, found);
    if (place == choices.end()) {
      std::string expected;
      for (const char* choice : choices)
        expected += (expected.empty() ? "" : ", ") + std::string(choice);
      fail(std::string(column) + " is " + found + ", expected one of " + expected);
    }
    return static_cast<int>(place - choices.begin());
  }

  void end() {
    std::string rest;
    if (words_ >> rest) fail("unexpected " + rest);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(std::string(file_), number_, what);
  }

 private:
  std::string_view file_;
  std::size_t number_;
  std::istringstream words_;
};

Variant parse_line(Line& line) {
  Variant variant;
  Arithmetic& math = variant.math;
  variant.name = line.word("name");
  variant.unit = static_cast<Variant::Unit>(line.choice<2>("unit", {"pipeline", "serial"}));
  math.exponent_bits = line.number("exp", 3, 8);
  math.digits = line.number("digits", 3, 24);
  math.rounding = static_cast<Rounding>(
      line.choice<5>("rounding", {"nearest-even", "toward-zero", "down", "up", "nearest-away"}));
  math.flush = line.choice<2>("subnormals", {"kept", "zeros"}) == 1;
  if (const std::string quotients = line.word("quotients"); quotients != "rounded") {
    math.quotient_digits = line.to_number(quotients, "quotients", 2, math.digits);
  }
  math.fused = line.choice<2>("dot", {"steps", "once"}) == 1;
  variant.doubts = line.choice<2>("doubts", {"resolved", "ignored"}) == 0;
  line.end();

  // What fp_pkg asks of a format.
  if (math.fraction_bits() > 1 << (math.exponent_bits - 1)) {
    line.fail("digits are " + std::to_string(math.digits) + ", expected at most " +
              std::to_string((1 << (math.exponent_bits - 1)) + 1) + " with so few exponent bits");
  }
  const bool pipeline = variant.unit == Variant::Unit::kPipeline;
  if (pipeline && math.quotient_digits != 0) line.fail("the pipelined unit rounds its quotients");
  if (!pipeline && math.fused) line.fail("the serial unit has one adder: dot must be steps");
  if (!pipeline && !variant.doubts) line.fail("the serial unit has no doubts to ignore");
  if (pipeline && variant.doubts &&
      (math.rounding != Rounding::kNearestEven || math.flush || math.digits < 11)) {
    line.fail("doubts are resolved, expected nearest-even, subnormals kept and 11 digits or more");
  }
  return variant;
}

}  // namespace

std::vector<Variant> parse_variants(std::string_view text, std::string_view name) {
  std::vector<Variant> variants;
  std::istringstream lines{std::string(text)};
  std::string words;
  for (std::size_t number = 1; std::getline(lines, words); ++number) {
    if (words.find_first_not_of(" \t\r") == std::string::npos || words.front() == '#') continue;
    Line line(name, number, words);
    Variant variant = parse_line(line);
    if (std::ranges::find(variants, variant.name, &Variant::name) != variants.end()) {
      line.fail("a second " + variant.name);
    }
    variants.push_back(std::move(variant));
  }
  return variants;
}

const std::vector<Variant>& all_variants_of_arithmetic() {
  static const std::vector<Variant> variants = parse_variants(kVariantsText, kVariantsFile);
  return variants;
}

const Variant& variant_named(std::string_view name) {
  const auto& variants = all_variants_of_arithmetic();
  const auto place = std::ranges::find(variants, name, &Variant::name);
  if (place != variants.end()) return *place;
  std::string expected;
  for (const Variant& variant : variants) expected += (expected.empty() ? "" : ", ") + variant.name;
  throw InputError("no variant " + std::string(name) + ", expected one of " + expected);
}

}  // namespace raygate
