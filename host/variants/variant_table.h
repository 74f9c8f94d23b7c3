// The variants of arithmetic that are compared, from variants.json.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/variants/arithmetic.h"

namespace raygate {

using Json = nlohmann::ordered_json;

/// `object` with the values of `usual` where it has none. Throws InputError, "WHAT has ...": an
/// unknown name, or a value that is not of the usual one's kind.
[[nodiscard]] Json with_usual(const Json& object, Json usual, const std::string& what);

/// Throws InputError, "NAME is ..., expected LOW to HIGH".
int in_range(const std::string& name, int value, int low, int high);

/// An object of variants.json. What it leaves out is as in binary32:
///
///   variant          its name; -raw where doubts are ignored
///   unit             "pipeline" (decides, t, P), or "serial": the paper's, P alone
///   exponent_bits, digits, rounding ("nearest-even", "toward-zero", "down", "up", "nearest-away"),
///   flush, quotient_digits (serial alone), fused (no hardware)      see Arithmetic
///   doubts           whether exact arithmetic on the host resolves them; else there are no bounds
///   brought          a folder of modules in place of those of hw/ (synth/brought.py); "": none
///
/// That is all there is to a new variant: CMake verilates its design, if hw/ has such parameters,
/// and `make bench` and `make stress` take their rows from here.
struct Variant {
  enum class Unit : std::uint8_t {
    kPipeline,  ///< decides hit, miss or doubt, orders hits, gives t and P
    kSerial,    ///< the paper's: gives P; software decides, in binary32 and exactly
  };

  std::string name = "binary32";
  Unit unit = Unit::kPipeline;
  Arithmetic math;
  bool doubts = true;  ///< false: no error bounds; what the unit says is taken as it comes

  std::string brought;

  /// Whether hw/ can be given these parameters; else there is the reference model alone.
  [[nodiscard]] bool has_hardware() const { return !math.flush && !math.fused; }
  /// All columns of the object, and `hardware`.
  [[nodiscard]] Json row() const;
};

/// Reads such a table. Throws InputError that names `file` and the variant: unknown or wrong
/// values, or a format for which no bound of its errors is proven although its doubts are to be
/// resolved (see variant_hit_tester.h).
[[nodiscard]] std::vector<Variant> parse_variants(std::string_view text, const std::string& file);

/// variants.json as it was when the program was built.
[[nodiscard]] const std::vector<Variant>& all_variants_of_arithmetic();

/// The pipelined unit in a format such as e8p15: 8 exponent bits, 15 digits; e8p15-raw ignores
/// doubts. Nothing for other texts. Throws InputError for a format without hardware or bounds.
[[nodiscard]] std::optional<Variant> variant_of_format(std::string_view text);

/// The one of that name. Throws InputError, with the names that there are.
[[nodiscard]] const Variant& variant_named(std::string_view name);

}  // namespace raygate
