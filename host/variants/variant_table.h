// Table of the arithmetic variants to compare, read from variants.json.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/variants/arithmetic.h"

namespace raygate {

using Json = nlohmann::ordered_json;

/// An object of variants.json. Defaults are those of binary32:
///
///   variant          its name; ends in -raw if doubts are ignored
///   unit             "pipeline" (decides, computes t and P) or "serial" (the paper's: P alone)
///   exponent_bits, digits, rounding ("nearest-even", "toward-zero", "down", "up", "nearest-away"),
///   flush, quotient_digits (serial only), fused (no hardware)      see Arithmetic
///   doubts           whether the host resolves doubts exactly; otherwise there are no bounds
///   brought          a folder of modules that replace modules of hw/ (synth/brought.py); "": none
/// CMake verilates the design of each object that hw/ supports.
struct Variant {
  enum class Unit : std::uint8_t {
    kPipeline,  ///< decides hit, miss or doubt, orders hits, computes t and P
    kSerial,    ///< the paper's: computes P; software decides, in binary32 and exactly
  };

  std::string name = "binary32";
  Unit unit = Unit::kPipeline;
  Arithmetic math;
  bool doubts = true;  ///< false: no error bounds; decisions of the unit are final

  std::string brought;

  /// Returns whether hw/ supports these parameters. Otherwise only the reference model exists.
  [[nodiscard]] bool has_hardware() const { return !math.flush && !math.fused; }
  /// Returns all columns of the object, and `hardware`.
  [[nodiscard]] Json row() const;
};

/// Parses a table of variants. Throws InputError that names `file` and the variant, for unknown
/// names, invalid values, and doubts to resolve without a proven error bound.
[[nodiscard]] std::vector<Variant> parse_variants(std::string_view text, const std::string& file);

/// Returns the contents of variants.json at build time.
[[nodiscard]] const std::vector<Variant>& all_variants_of_arithmetic();

/// Returns the pipelined variant of a format such as e8p15: 8 exponent bits, 15 digits; -raw at the
/// end ignores doubts. Returns nullopt for other texts. Throws InputError for unsupported formats.
[[nodiscard]] std::optional<Variant> variant_of_format(std::string_view text);

}  // namespace raygate
