// The variants of arithmetic that are compared, from variants.txt.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host/lab/variants/arithmetic.h"

namespace raygate {

/// A line of variants.txt.
struct Variant {
  enum class Unit : std::uint8_t {
    kPipeline,  ///< decides hit, miss or doubt, orders hits, gives t and P
    kSerial,    ///< the paper's: gives P; software decides, in binary32 and exactly
  };

  std::string name;
  Unit unit = Unit::kPipeline;
  Arithmetic math;
  bool doubts = true;  ///< false: no error bounds; what the unit says is taken as it comes

  /// Whether hw/ can be given these parameters; else there is the C++ twin alone.
  [[nodiscard]] bool has_hardware() const { return !math.flush && !math.fused; }
};

/// Reads such a table. Throws InputError (with `name` and the line's number): columns missing, a
/// value that is none of those allowed, or a format for which no bound of its errors is proven
/// although its doubts are to be resolved (see variant_hit_tester.h).
[[nodiscard]] std::vector<Variant> parse_variants(std::string_view text, std::string_view name);

/// variants.txt as it was when the program was built.
[[nodiscard]] const std::vector<Variant>& all_variants_of_arithmetic();

/// The one of that name. Throws InputError, with the names that there are.
[[nodiscard]] const Variant& variant_named(std::string_view name);

}  // namespace raygate
