// Hit tests in a variant's arithmetic, for whole pictures.
#pragma once

#include <memory>
#include <vector>

#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/variants/variant_table.h"
#include "host/variants/variant_units.h"

namespace raygate {

/// Puts a record into a format, as the host would for such a unit: N and d, and each edge, scaled
/// by powers of two where the format has fewer exponents than float32, and rounded to nearest. The
/// bounds are 0 without `doubts`; with them |unit's U - exact I . E| < bound for any float32 I with
/// components below 2 (the ray in the format is I rounded to nearest).
[[nodiscard]] PolygonRecord variant_record(const Variant& variant, const PolygonRecord& record);

/// The bound in units of 2^-digits |E|_1, for rounding to nearest.
[[nodiscard]] double variant_edge_bound(const Arithmetic& math);

/// t as the variant's unit has it, by its own formula, of a record that make_record has made; of
/// the serial unit's host, in binary32.
[[nodiscard]] float variant_t(const Variant& variant, const PolygonRecord& record,
                              const glm::vec3& direction);

/// Rays and records go to the unit in the variant's format.
///
/// Doubts resolved: HitTester's promise holds in any format of 11 digits or more, since the bounds
/// are scaled with it; the narrower, the more doubts. P has the unit's bits.
///
/// Doubts ignored: what plain arithmetic does. Edges of 0 are inside, a hit is whatever has three
/// signs alike and a positive t, of two the one with the smaller t is nearer (of equals the first).
/// Nothing is ever asked of exact arithmetic: t is reported as if it were known, and equal ones are
/// told apart by less than their last digits.
class VariantHitTester : public HitTester {
 public:
  /// `unit`: computes in the format of `variant`, whose unit is the pipelined one.
  VariantHitTester(const Variant& variant, std::unique_ptr<BurstUnit> unit);

  void run(std::span<const RayBundle> batch, HitResults& results) override;
  [[nodiscard]] HitCounters counters() const override;

 private:
  void narrow(std::span<const RayBundle> batch);
  void report(const RayBundle& wide, HitResults& results, const TestReport& report);
  void resolve_nothing(std::span<const RayBundle> batch, HitResults& results);

  Variant variant_;
  std::unique_ptr<BurstUnit> unit_;
  VariantBurstUnit twin_;  // t and P of what the unit only reports
  // Room to work in.
  std::vector<PolygonRecord> records_;
  std::vector<RayBundle> batch_;
  BurstResults found_;
};

/// The paper's unit, which computes P alone: the tester of a serial variant.
[[nodiscard]] std::unique_ptr<HitTester> make_variant_tester(const Variant& variant,
                                                             std::unique_ptr<PlaneUnit> unit);

/// The reference model's tester for a variant of either unit.
[[nodiscard]] std::unique_ptr<HitTester> make_variant_tester(const Variant& variant);

}  // namespace raygate
