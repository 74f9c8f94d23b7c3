// The Verilated hit-test units with a variant's parameters, and whether their reference models in
// C++ are the same.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "host/intersect/unit/burst_unit.h"
#include "host/variants/variant_table.h"

namespace raygate {

/// hit_test_pipeline, Verilated with the variant's format and rounding; null where the hardware has
/// no such parameters. Floats that go in must be numbers of the format. Not for use by two threads.
[[nodiscard]] std::unique_ptr<BurstUnit> make_rtl_burst_unit(const Variant& variant);

/// hit_test_unit likewise, with its QuotientBits; words are rounded to the format first.
[[nodiscard]] std::unique_ptr<PlaneUnit> make_rtl_plane_unit(const Variant& variant);

/// The tester with the Verilated unit in it; null as above.
[[nodiscard]] std::unique_ptr<HitTester> make_rtl_variant_tester(const Variant& variant);

/// What a comparison found.
struct VariantCheck {
  std::uint64_t tests = 0;  ///< hit tests through both
  // Of the pipelined unit, by its own events: the sample has something of everything.
  std::uint64_t misses = 0, hits = 0, doubts = 0, near_ties = 0;
  std::uint64_t clocks = 0;
  std::string difference;  ///< the first one, with its inputs; empty: there is none
};

/// Sends about `tests` random and adversarial tests through the Verilated unit and the twin and
/// compares every bit of every result, and the events. Of the records half are triangles as the
/// host would send them, the others have replaced words, bounds next to |U|, distances next to the
/// margin of a near tie, and random bits. The variant must have hardware.
[[nodiscard]] VariantCheck check_variant(const Variant& variant, std::uint64_t tests,
                                         std::uint64_t seed);

}  // namespace raygate
