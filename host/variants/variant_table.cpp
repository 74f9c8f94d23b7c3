#include "host/variants/variant_table.h"

#include <algorithm>
#include <regex>
#include <utility>

#include "host/base/input_error.h"
#include "host/variants/variants_text.h"

namespace raygate {
namespace {

constexpr const char* kRoundings[] = {"nearest-even", "toward-zero", "down", "up", "nearest-away"};

/// Throws InputError if the format has no hardware or no proven bounds.
void require_possible(const Variant& variant) {
  const auto fail = [](const char* what) { throw InputError(what); };
  const Arithmetic& math = variant.math;
  if (math.fraction_bits() > 1 << (math.exponent_bits - 1)) {  // required by fp_pkg
    fail("too many digits for so few exponent bits");
  }
  const bool pipeline = variant.unit == Variant::Unit::kPipeline;
  if (pipeline && math.quotient_digits != 0) fail("the pipelined unit rounds its quotients");
  if (!pipeline && math.fused) fail("the serial unit has one adder: it cannot be fused");
  if (!pipeline && !variant.doubts) fail("the serial unit has no doubts to ignore");
  if (pipeline && variant.doubts &&
      (math.rounding != Rounding::kNearestEven || math.flush || math.digits < 11)) {
    fail("doubts are resolved, expected nearest-even, subnormals and 11 digits or more");
  }
}

/// Returns `value`. Throws InputError if it is out of range.
int in_range(const std::string& column, int value, int low, int high) {
  if (low <= value && value <= high) return value;
  throw InputError(column + " is " + std::to_string(value) + ", expected " + std::to_string(low) +
                   " to " + std::to_string(high));
}

/// Returns all columns of a variant, with defaults for missing ones. Throws InputError for an
/// unknown column or a value of another type than the default.
Json with_defaults(const Json& object) {
  Json row = Variant{}.row();
  row.erase("hardware");  // follows from the other columns
  std::string columns = ", expected";
  for (const auto& column : row.items()) columns.append(" ").append(column.key());
  if (!object.is_object()) throw InputError("found no object" + columns);
  for (const auto& [name, value] : object.items()) {
    if (!row.contains(name)) throw InputError(("a variant has " + name).append(columns));
    const Json& like = row[name];
    if (like.is_number() ? !value.is_number_integer() : value.type() != like.type()) {
      throw InputError(name + " is " + value.dump() + ", expected a value like " + like.dump());
    }
    row[name] = value;
  }
  return row;
}

Variant parse_variant(const Json& object) {
  const Json row = with_defaults(object);
  const auto number = [&](const char* column, int low, int high) {
    return in_range(column, row[column], low, high);
  };
  Variant variant;
  variant.name = row["variant"];
  variant.doubts = row["doubts"];
  variant.brought = row["brought"];
  if (row["unit"] == "serial") {
    variant.unit = Variant::Unit::kSerial;
  } else if (row["unit"] != "pipeline") {
    throw InputError("unit is " + row["unit"].dump() + ", expected pipeline or serial");
  }
  const auto rounding = std::ranges::find(kRoundings, row["rounding"].get<std::string>());
  if (rounding == std::end(kRoundings)) {
    throw InputError("rounding is " + row["rounding"].dump() + ", expected nearest-even, ...");
  }
  variant.math = {.digits = number("digits", 3, 24),
                  .exponent_bits = number("exponent_bits", 3, 8),
                  .rounding = static_cast<Rounding>(rounding - kRoundings),
                  .flush = row["flush"],
                  .fused = row["fused"]};
  variant.math.quotient_digits = number("quotient_digits", 0, variant.math.digits);
  require_possible(variant);
  return variant;
}

}  // namespace

Json Variant::row() const {
  return {{"variant", name},
          {"unit", unit == Unit::kSerial ? "serial" : "pipeline"},
          {"exponent_bits", math.exponent_bits},
          {"digits", math.digits},
          {"rounding", kRoundings[static_cast<int>(math.rounding)]},
          {"flush", math.flush},
          {"quotient_digits", math.quotient_digits},
          {"fused", math.fused},
          {"doubts", doubts},
          {"brought", brought},
          {"hardware", has_hardware()}};
}

std::vector<Variant> parse_variants(std::string_view text, const std::string& file) {
  std::vector<Variant> variants;
  const Json objects = Json::parse(text, nullptr, false);
  if (!objects.is_array()) throw InputError(file + ": expected a JSON array of variants");
  for (const Json& object : objects) {
    try {
      Variant variant = parse_variant(object);
      if (std::ranges::count(variants, variant.name, &Variant::name) != 0) {
        throw InputError("its name is taken");
      }
      variants.push_back(std::move(variant));
    } catch (const InputError& error) {
      throw InputError(file + ": " + object.dump() + ": " + error.what());
    }
  }
  return variants;
}

const std::vector<Variant>& all_variants_of_arithmetic() {
  static const std::vector<Variant> variants =
      parse_variants(kVariantsText, "host/variants/variants.json");
  return variants;
}

std::optional<Variant> variant_of_format(std::string_view text) {
  static const std::regex kFormat("e([3-8])p([0-9]{1,2})(-raw)?");
  std::cmatch words;
  if (!std::regex_match(text.begin(), text.end(), words, kFormat)) return std::nullopt;
  Variant variant;
  variant.name = text;
  variant.doubts = !words[3].matched;
  variant.math.exponent_bits = std::stoi(words[1]);
  variant.math.digits = in_range("digits", std::stoi(words[2]), 3, 24);
  require_possible(variant);
  return variant;
}

}  // namespace raygate
