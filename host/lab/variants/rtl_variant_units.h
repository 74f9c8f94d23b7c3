// Verilated hit-test units with a variant's parameters, and checks of their C++ reference models.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "host/intersect/unit/hit_tester.h"
#include "host/variants/variant_table.h"

namespace raygate {

/// Returns hit_test_pipeline, Verilated with the variant's format and rounding, or null if the
/// hardware has no such parameters. Input floats must be numbers of the format. Not thread-safe.
[[nodiscard]] std::unique_ptr<BurstUnit> make_rtl_burst_unit(const Variant& variant);

/// Returns hit_test_unit likewise, with its QuotientBits. Words are rounded to the format first.
[[nodiscard]] std::unique_ptr<PlaneUnit> make_rtl_plane_unit(const Variant& variant);

/// Returns a tester with the Verilated unit, or null as above.
[[nodiscard]] std::unique_ptr<HitTester> make_rtl_variant_tester(const Variant& variant);

/// Result of a comparison.
struct VariantCheck {
  std::uint64_t tests = 0;  ///< hit tests through unit and model
  // Events of the pipelined unit, which show what the sample covers.
  std::uint64_t misses = 0, hits = 0, doubts = 0, near_ties = 0;
  std::uint64_t clocks = 0;
  std::string difference;  ///< first difference, with its inputs; empty: none
};

/// Sends about `tests` random and adversarial tests through the Verilated unit and its reference
/// model, and compares every bit of every result, and the events. Half of the records are triangles
/// as the host would send them; the others have replaced words, bounds close to |U|, distances
/// close to the margin of a near tie, and random bits. The variant must have hardware.
[[nodiscard]] VariantCheck check_variant(const Variant& variant, std::uint64_t tests,
                                         std::uint64_t seed);

}  // namespace raygate
