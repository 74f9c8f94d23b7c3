// Reference models of the units, and hit testers, with a variant's arithmetic.
#pragma once

#include <memory>

#include "host/intersect/unit/hit_tester.h"
#include "host/variants/variant_table.h"

namespace raygate {

/// Reference model of the pipelined unit. In binary32 it equals ReferenceBurstUnit but is slower.
using VariantBurstUnit = BasicReferenceBurstUnit<Arithmetic>;

/// Reference model of the paper's unit, bit-exact to hit_test_unit with the same parameters. Rounds
/// its inputs to the format first, as the host does.
using VariantPlaneUnit = BasicReferencePlaneUnit<Arithmetic>;

/// Converts a record to a variant's format and rounds to nearest. If the format has fewer exponents
/// than binary32, N with d, and each edge, are scaled by powers of two first. Without `doubts`, the
/// bounds are 0. Otherwise |U - I . E| < bound for the exact edge plane E, any float32 direction I
/// with components below 2, and the unit's dot product U with I rounded to nearest in the format.
[[nodiscard]] PolygonRecord variant_record(const Variant& variant, const PolygonRecord& record);

/// Returns t for a record of make_record(), as computed by the variant's unit. For the serial unit,
/// the host computes t in binary32.
[[nodiscard]] float variant_t(const Variant& variant, const PolygonRecord& record,
                              const glm::vec3& direction);

/// Returns a tester for a pipelined variant, whose unit computes in the variant's format. Rays and
/// records are converted to the format. P has the unit's bits.
///
/// With Variant::doubts, HitTester's guarantee holds in any format of 11 digits or more. Without,
/// the format's arithmetic decides: edge values of 0 are inside, a hit has three equal signs and a
/// positive t, and the hit with the smaller t is nearer (the first of equals). Exact arithmetic is
/// never used: t is reported as exact, and equal values of t are separated by less than an ulp.
[[nodiscard]] std::unique_ptr<HitTester> make_variant_tester(const Variant& variant,
                                                             std::unique_ptr<BurstUnit> unit);

/// Returns a tester for a serial variant, whose unit (the paper's) computes P alone.
[[nodiscard]] std::unique_ptr<HitTester> make_variant_tester(const Variant& variant,
                                                             std::unique_ptr<PlaneUnit> unit);

/// Returns a tester that uses the reference model of a pipelined or a serial variant's unit.
[[nodiscard]] std::unique_ptr<HitTester> make_variant_tester(const Variant& variant);

}  // namespace raygate
