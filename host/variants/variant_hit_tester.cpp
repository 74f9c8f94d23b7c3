#include "host/variants/variant_hit_tester.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

// The bound of an edge test in a format with the unit roundoff u = 2^-digits
//
// This bounds |U - I . E|. E is the exact edge plane, F the record's edge words in the format, I a
// float32 direction with |I_i| < 2, and J is I rounded to the format, so |J_i| <= 2. U is J . F as
// computed by the unit. |.|_1 is the sum of magnitudes. edge_bound() adds these terms:
// 1. Record. Rounding to F changes J . E by at most 2 u |F|_1. edge_normal's own error adds less
//    than 2^-7 u |F|_1 (see polygon_record.cpp).
// 2. Direction. |J_i - I_i| <= 2 u, so |(J - I) . E| <= 2 u (1 + u) |F|_1. In float32, J = I.
// 3. Dot product. Each product is rounded at most three times: the error is at most
//    3 u / (1 - 3 u) |J|.|F| <= 6 u / (1 - 3 u) |F|_1. If rounded once: u |J . F| <= 2 u |F|_1.
// 4. Words of formats narrower than float32 were first rounded to float32: 2 * 2^-24 (1 + u) |F|_1.
// 5. Subnormals. Let q be the least positive number. Six words and five operations are off by q / 2
//    each, times at most 2: 11 q. In formats with less than 8 exponent bits, the largest |F_i| is
//    at least 1, so this is at most 11 q |F|_1. With 8 exponent bits, 11 q is negligible: the
//    largest |F_i| is at least 2^-60, and edge_bound() rounds the 2^-7 of step 1 up to 2^-6.
//
// The error of t = d / V. V is N . J as computed, e(x) the exponent of x, g = max e(N_k) - e(V).
// 1. In V, the first two products are rounded three times, the third twice. With the roundings of N
//    and J, these are 5, 5 and 4 roundings.
// 2. |J_k| <= 2 and |N_k| < 2 * 2^g |V|. So V's relative error is at most r = 2 * 2 * (5 + 5 + 4) u
//    2^g = 56 u 2^g. With 11 digits or more, g <= max_grazing and r < 2^-5.
// 3. d adds 2 u and the division u, so t has a relative error of at most
//    (56 * 2^g + 3.2) u / (1 - r) < 64 u 2^g, which is 2^(TErrorUnit + g) u.

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Returns the format with rounding to nearest even, in which the host converts numbers.
Arithmetic to_nearest(Arithmetic math) {
  math.rounding = Rounding::kNearestEven;
  return math;
}

float rounded_up(const Arithmetic& math, double x) {
  const float wide = static_cast<float>(x);
  const float nearest = to_nearest(math).read(wide);
  return nearest > x ? nearest : math.from_word(math.to_word(nearest) + 1);
}

/// Returns NearestHit's point_error for a `point` computed in the format, or infinity if the
/// format's range is too small for a coordinate. `wide` is the direction before conversion.
float format_error(const Arithmetic& math, float d, const glm::vec3& direction,
                   const glm::vec3& wide, const glm::vec3& point, std::uint32_t t_error) {
  for (int k = 0; k < 3; ++k) {
    const bool in_range = math.is_normal(direction[k]) && math.is_normal(point[k]) &&
                          math.is_normal(math.multiply(d, direction[k]));
    if (wide[k] != 0.0f && !in_range) return kInfinity;
  }
  return static_cast<float>(std::ldexp(math.unit_roundoff(), 6 + static_cast<int>(t_error)));
}

/// Returns the bound of an edge test in units of 2^-digits |E|_1, for rounding to nearest.
double edge_bound(const Arithmetic& math) {
  const double u = math.unit_roundoff();
  const bool narrow = math.digits < 24;
  const double record = 2.0 + 0x1p-6, direction = narrow ? 2.0 * (1.0 + u) : 0.0;
  const double dot = math.fused ? 2.0 : 6.0 / (1.0 - 3.0 * u);
  const double twice_rounded = narrow ? 2.0 * 0x1p-24 * (1.0 + u) / u : 0.0;
  const double quantum = std::ldexp(1.0, math.min_exponent() - math.fraction_bits());
  return record + direction + dot + twice_rounded + 11.0 * quantum / u;
}

}  // namespace

PolygonRecord variant_record(const Variant& variant, const PolygonRecord& wide) {
  const Arithmetic math = to_nearest(variant.math);
  PolygonRecord record = wide;
  const bool few_exponents = math.exponent_bits < 8;
  const int shift = few_exponents ? to_unit(wide.normal) : 0;
  record.normal = math.read(scaled_by(wide.normal, shift));
  record.d = math.read(std::ldexp(wide.d, shift));
  bool too_far = false;
  if (wide.d != 0.0f && !math.is_normal(record.d)) {
    // Keep the sign. Exact arithmetic handles the lost magnitude.
    too_far = true;
    const double low = std::ldexp(1.0, math.min_exponent());
    const double high = std::ldexp(2.0 - std::ldexp(1.0, 1 - math.digits), math.max_exponent());
    record.d = static_cast<float>(
        std::copysign(std::clamp(std::abs(static_cast<double>(record.d)), low, high), wide.d));
  }
  for (int k = 0; k < 3; ++k) {
    const int edge_shift = few_exponents ? to_unit(wide.edges[k]) : 0;
    record.edges[k] = math.read(scaled_by(wide.edges[k], edge_shift));
    if (!variant.doubts) {
      record.bounds[k] = 0.0f;
    } else if (too_far || std::isinf(wide.bounds[k])) {
      record.bounds[k] = kInfinity;
    } else if (math != Arithmetic{}) {
      const glm::dvec3 e = glm::abs(glm::dvec3(record.edges[k]));
      record.bounds[k] =
          rounded_up(math, edge_bound(math) * math.unit_roundoff() * (e.x + e.y + e.z));
    }
  }
  return record;
}

float variant_t(const Variant& variant, const PolygonRecord& record, const glm::vec3& direction) {
  static const Variant host;
  const Variant& used = variant.unit == Variant::Unit::kSerial ? host : variant;
  return VariantBurstUnit(used.math)
      .distance(variant_record(used, record), to_nearest(used.math).read(direction))
      .t;
}

namespace {

class VariantHitTester : public PipelineHitTester {
 public:
  VariantHitTester(const Variant& variant, std::unique_ptr<BurstUnit> unit)
      : PipelineHitTester(std::move(unit)), variant_(variant), twin_(variant.math) {}

  // finish() starts the unit with narrowed records, which PipelineHitTester::start() would not do.
  // NOLINTNEXTLINE(bugprone-parent-virtual-call)
  void start(std::span<const RayBundle> batch) override { HitTester::start(batch); }

  void finish(HitReports& reports) override {
    const std::span<const RayBundle> batch = pop_started();
    narrow(batch);
    results_.clear();
    unit_->run(batch_, results_);
    for (const BurstResult& result : results_) {
      const RayBundle &wide = batch[result.bundle], &bundle = batch_[result.bundle];
      const PolygonRecord& record = bundle.records[result.record];
      const int lane = static_cast<int>(result.lane);
      const glm::vec3 direction = bundle.lane_direction(lane);
      const bool is_hit = result.kind == BurstResult::Kind::kHit;
      const HitDistance distance =
          is_hit ? HitDistance{result.t, result.t_error} : twin_.distance(record, direction);
      HitReport report{result.bundle,
                       result.lane,
                       result.kind != BurstResult::Kind::kDoubt,
                       {.primitive = wide.first_tag + result.record,
                        .point = is_hit ? result.point : twin_.point(record, direction)}};
      if (!variant_.doubts) {
        if (result.kind != BurstResult::Kind::kNearTie) take_as_it_is(distance.t, report, reports);
        continue;
      }
      // A doubt's P is as accurate as a sure hit's if V = N . I is a divisor and d is not clamped.
      const float v = variant_.math.dot(record.normal, direction);
      const bool divisible = twin_.is_divisor(record, v) && !std::isinf(record.bounds[0]);
      if (report.is_sure || divisible) {
        report.hit.point_error =
            format_error(variant_.math, record.d, direction, wide.lane_direction(lane),
                         report.hit.point, distance.error);
      }
      if (report.is_sure) report.hit.t = around(distance, variant_.math);
      reports.push_back(report);
    }
  }

 private:
  /// Sets batch_ and records_ to the batch in the variant's format.
  void narrow(std::span<const RayBundle> batch) {
    const Arithmetic math = to_nearest(variant_.math);
    std::size_t count = 0;
    for (const RayBundle& bundle : batch) count += bundle.record_count;
    records_.clear();
    records_.reserve(count);  // bundles point into records_
    batch_.assign(batch.begin(), batch.end());
    for (RayBundle& bundle : batch_) {
      const PolygonRecord* wide = bundle.records;
      bundle.records = records_.data() + records_.size();
      for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
        records_.push_back(variant_record(variant_, wide[i]));
      }
      for (auto& component : bundle.direction) {
        for (float& x : component) x = math.read(x);
      }
    }
  }

  /// If doubts are ignored: keeps a burst's nearest hit. Doubts with positive, finite t are hits.
  static void take_as_it_is(float t, HitReport& report, HitReports& reports) {
    if (!(t > 0.0f) || std::isinf(t)) return;
    // Separates equal distances in the order of the tags, far below the precision of float32.
    const double told_apart =
        t * (1.0 + std::ldexp(static_cast<double>(report.hit.primitive), -52));
    report.is_sure = true;
    report.hit.t = {told_apart, told_apart};
    report.hit.point_error = 0.0f;  // without bounds, the unit's P counts as exact
    const bool same_burst = !reports.empty() && reports.back().bundle == report.bundle &&
                            reports.back().lane == report.lane;
    if (!same_burst) {
      reports.push_back(report);
    } else if (told_apart < reports.back().hit.t.low) {
      reports.back() = report;
    }
  }

  Variant variant_;
  VariantBurstUnit twin_;  // computes t and P of doubts and near ties
  // Reused buffers.
  std::vector<PolygonRecord> records_;
  std::vector<RayBundle> batch_;
};

}  // namespace

std::unique_ptr<HitTester> make_variant_tester(const Variant& variant,
                                               std::unique_ptr<BurstUnit> unit) {
  return std::make_unique<VariantHitTester>(variant, std::move(unit));
}

std::unique_ptr<HitTester> make_variant_tester(const Variant& variant,
                                               std::unique_ptr<PlaneUnit> unit) {
  if (variant.math == Arithmetic{}) return std::make_unique<SerialHitTester>(std::move(unit));
  // Scales a relative error from binary32 to the format; in ulps, both are equal. Errors above 1/8
  // become infinite, because the bound of V's error does not hold for them.
  const auto adapt = [digits = variant.math.digits, host = to_nearest(variant.math)](
                         const PolygonRecord& record, const glm::vec3& direction, NearestHit& hit) {
    hit.point_error = std::ldexp(hit.point_error, 24 - digits);
    const bool in_range = !std::isinf(
        format_error(host, host.read(record.d), host.read(direction), direction, hit.point, 0));
    if (!in_range || hit.point_error > 0.125f) hit.point_error = kInfinity;
  };
  return std::make_unique<SerialHitTester>(std::move(unit), adapt);
}

std::unique_ptr<HitTester> make_variant_tester(const Variant& variant) {
  if (variant.unit == Variant::Unit::kSerial) {
    return make_variant_tester(variant, std::make_unique<VariantPlaneUnit>(variant.math));
  }
  return make_variant_tester(variant, std::make_unique<VariantBurstUnit>(variant.math));
}

}  // namespace raygate
