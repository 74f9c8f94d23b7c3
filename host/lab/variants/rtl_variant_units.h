// The Verilated hit-test units with a variant's parameters.
#pragma once

#include <memory>

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/plane_unit.h"
#include "host/lab/variants/variant_table.h"

namespace raygate {

/// hit_test_pipeline, Verilated with the variant's format and rounding; null where the hardware has
/// no such parameters. Floats that go in must be numbers of the format. Not for use by two threads.
[[nodiscard]] std::unique_ptr<BurstUnit> make_rtl_burst_unit(const Variant& variant);

/// hit_test_unit likewise, with its QuotientBits; words are rounded to the format first.
[[nodiscard]] std::unique_ptr<PlaneUnit> make_rtl_plane_unit(const Variant& variant);

/// The tester with the Verilated unit in it; null as above.
[[nodiscard]] std::unique_ptr<HitTester> make_rtl_variant_tester(const Variant& variant);

}  // namespace raygate
