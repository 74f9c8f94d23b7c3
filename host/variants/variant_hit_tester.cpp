#include "host/variants/variant_hit_tester.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "host/intersect/unit/unit_hit_testers.h"

// The bound of an edge test in a format of u = 2^-digits
//
// Let E be the exact edge plane, F the record's words in the format, I the float32 direction with
// |I_i| < 2, J its rounding to the format, so |J_i| <= 2. |.|_1 is the sum of magnitudes.
//
// 1. Record. |J . F - J . E| <= 2 u |F|_1 for its rounding; edge_normal's own error adds less than
//    2^-7 u |F|_1 (see polygon_record.cpp).
// 2. Direction. |(J - I) . E| <= 2 u (1 + u) |F|_1; nothing in float32, where J = I.
// 3. Dot product. Three roundings for each product at most: 3 u / (1 - 3 u) |J|.|F| <= 6 u / (1 - 3
// u)
//    |F|_1. Rounded once: u |J . F| <= 2 u |F|_1.
// 4. Where the format is narrower the record's words have been rounded to float32 before:
//    2 * 2^-24 (1 + u) |F|_1.
// 5. Subnormals. With max |F_i| >= 1 (formats of few exponents) or far away from them (float32's):
//    six words and five operations are off by half a quantum q each, times 2 at most: 11 q.
//
// The error of t: hit_test_pkg has 48.5 u 2^g for V with J = I. In V's sum the first two products
// have three roundings and the third has two: with N's rounding and J's own that is
// (2 * 5 + 4) / 3 roundings on average, at most 2 * 2 * (5 + 5 + 4) = 56 u 2^g; with d and the
// division 59.2 numbers, over (1 - r), r = 56 u below 2^-5 for 11 digits: under 64 = 2^TErrorUnit.

namespace raygate {

template class BasicReferenceBurstUnit<Arithmetic>;

void VariantPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const glm::vec3 direction = math_.read(tests[i].direction),
                    normal = math_.read(tests[i].normal);
    const float d = math_.read(tests[i].d);
    // The accumulator starts from +0.
    float dot = math_.add(0.0f, math_.multiply(normal.x, direction.x));
    dot = math_.add(dot, math_.multiply(normal.y, direction.y));
    dot = math_.add(dot, math_.multiply(normal.z, direction.z));
    for (int k = 0; k < 3; ++k) {
      points[i][k] = math_.divide(math_.multiply(d, direction[k]), dot);
    }
  }
}

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Returns the format with the host's rounding direction.
Arithmetic to_nearest(Arithmetic math) {
  math.rounding = Rounding::kNearestEven;
  return math;
}

float largest(const glm::vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

glm::vec3 scaled(const glm::vec3& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

/// Returns the exponent of the power of two that scales the largest component into [1, 2).
int to_unit(const glm::vec3& v) { return largest(v) == 0.0f ? 0 : -std::ilogb(largest(v)); }

float rounded_up(const Arithmetic& math, double x) {
  const float wide = static_cast<float>(x);
  const float nearest = to_nearest(math).read(wide);
  return nearest > x ? nearest : math.from_word(math.to_word(nearest) + 1);
}

/// Returns the interval of possible values for a positive t with this error code.
Interval around(const Arithmetic& math, float t, std::uint32_t error) {
  const std::uint32_t word = math.to_word(t), margin = 64u << error;
  return {math.from_word(word - std::min(word, margin)),
          math.from_word(std::min(word + margin, math.to_word(kInfinity)))};
}

/// Returns NearestHit's point_error for a `point` computed in the format, or infinity if the
/// format's range is too small for a coordinate. `wide` is the direction before conversion.
float point_error(const Arithmetic& math, float d, const glm::vec3& direction,
                  const glm::vec3& wide, const glm::vec3& point, std::uint32_t t_error) {
  for (int k = 0; k < 3; ++k) {
    const bool in_range = math.is_normal(direction[k]) && math.is_normal(point[k]) &&
                          math.is_normal(math.multiply(d, direction[k]));
    if (wide[k] != 0.0f && !in_range) return kInfinity;
  }
  return static_cast<float>(std::ldexp(math.unit_roundoff(), 6 + static_cast<int>(t_error)));
}

/// The paper's unit in a variant's format. Software decides in binary32, so only P differs.
class SerialVariantTester : public SerialHitTester {
 public:
  SerialVariantTester(const Variant& variant, std::unique_ptr<PlaneUnit> unit)
      : SerialHitTester(std::move(unit)), variant_(variant) {}

  void run(std::span<const RayBundle> batch, HitResults& results) override {
    const std::size_t hits = results.hits.size(), doubts = results.doubts.size();
    SerialHitTester::run(batch, results);
    for (std::size_t i = hits; i < results.hits.size(); ++i) widen(batch, results.hits[i]);
    for (std::size_t i = doubts; i < results.doubts.size(); ++i) widen(batch, results.doubts[i]);
  }

 private:
  /// Scales an error in binary32 to the format: as many ulps. Errors above 1/8 become infinite, as
  /// the bound of V's error does not hold for them.
  template <class Report>
  void widen(std::span<const RayBundle> batch, Report& report) const {
    if (variant_.math == Arithmetic{} || std::isinf(report.point_error)) return;
    const RayBundle& bundle = batch[report.bundle];
    const glm::vec3 wide = bundle.lane_direction(static_cast<int>(report.lane));
    const Arithmetic math = to_nearest(variant_.math);
    const float d = math.read(bundle.records[report.tag - bundle.first_tag].d);
    const float error = std::ldexp(report.point_error, 24 - math.digits);
    const bool ranged = !std::isinf(point_error(math, d, math.read(wide), wide, report.point, 0));
    report.point_error = ranged && error <= 0.125f ? error : kInfinity;
  }

  Variant variant_;
};

}  // namespace

double variant_edge_bound(const Arithmetic& math) {
  const double u = math.unit_roundoff();
  const bool narrow = math.digits < 24;
  const double record = 2.0 + 0x1p-6, direction = narrow ? 2.0 * (1.0 + u) : 0.0;
  const double dot = math.fused ? 2.0 : 6.0 / (1.0 - 3.0 * u);
  const double twice_rounded = narrow ? 2.0 * 0x1p-24 * (1.0 + u) / u : 0.0;
  const double quantum = std::ldexp(1.0, math.min_exponent() - math.fraction_bits());
  return record + direction + dot + twice_rounded + 11.0 * quantum / u;
}

PolygonRecord variant_record(const Variant& variant, const PolygonRecord& wide) {
  const Arithmetic math = to_nearest(variant.math);
  PolygonRecord record = wide;
  const bool few_exponents = math.exponent_bits < 8;
  const int shift = few_exponents ? to_unit(wide.normal) : 0;
  record.normal = math.read(scaled(wide.normal, shift));
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
    record.edges[k] = math.read(scaled(wide.edges[k], edge_shift));
    if (!variant.doubts) {
      record.bounds[k] = 0.0f;
    } else if (too_far || std::isinf(wide.bounds[k])) {
      record.bounds[k] = kInfinity;
    } else if (math != Arithmetic{}) {
      const glm::dvec3 e = glm::abs(glm::dvec3(record.edges[k]));
      record.bounds[k] =
          rounded_up(math, variant_edge_bound(math) * math.unit_roundoff() * (e.x + e.y + e.z));
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

VariantHitTester::VariantHitTester(const Variant& variant, std::unique_ptr<BurstUnit> unit)
    : variant_(variant), unit_(std::move(unit)), twin_(variant.math) {}

/// Converts the batch to the variant's format.
void VariantHitTester::narrow(std::span<const RayBundle> batch) {
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

void VariantHitTester::run(std::span<const RayBundle> batch, HitResults& results) {
  narrow(batch);
  found_.clear();
  unit_->run(batch_, found_);
  if (!variant_.doubts) return resolve_nothing(batch, results);
  auto next = found_.reports.begin();
  const auto take_reports = [&](auto belongs_here) {
    for (; next != found_.reports.end() && belongs_here(*next); ++next) {
      report(batch[next->bundle], results, *next);
    }
  };
  for (const BurstHit& hit : found_.hits) {
    take_reports([&](const TestReport& r) {
      return r.bundle != hit.bundle ? r.bundle < hit.bundle : r.lane <= hit.lane;
    });
    const RayBundle& wide = batch[hit.bundle];
    const RayBundle& bundle = batch_[hit.bundle];
    const int lane = static_cast<int>(hit.lane);
    results.hits.push_back(
        {hit.bundle, hit.lane, wide.first_tag + hit.record, hit.point,
         point_error(variant_.math, bundle.records[hit.record].d, bundle.lane_direction(lane),
                     wide.lane_direction(lane), hit.point, hit.t_error),
         around(variant_.math, hit.t, hit.t_error)});
  }
  take_reports([](const TestReport&) { return true; });
}

/// Adds P and t to a report of the unit, by the unit's own formulas.
void VariantHitTester::report(const RayBundle& wide, HitResults& results,
                              const TestReport& report) {
  const RayBundle& bundle = batch_[report.bundle];
  const PolygonRecord& record = bundle.records[report.record];
  const glm::vec3 direction = bundle.lane_direction(static_cast<int>(report.lane));
  const std::uint32_t tag = wide.first_tag + report.record;
  const glm::vec3 point = twin_.point(record, direction);
  const HitDistance distance = twin_.distance(record, direction);
  const float error =
      point_error(variant_.math, record.d, direction,
                  wide.lane_direction(static_cast<int>(report.lane)), point, distance.error);
  if (report.kind == TestReport::Kind::kNearTie) {
    results.hits.push_back({report.bundle, report.lane, tag, point, error,
                            around(variant_.math, distance.t, distance.error)});
    return;
  }
  // If it is a hit, its P is as accurate as that of a sure hit, provided that V can be a divisor.
  const float v = variant_.math.dot(record.normal, direction);
  const bool divisible =
      variant_.math.is_normal(v) && std::signbit(v) == std::signbit(record.d) &&
      static_cast<int>(distance.error) <= std::max(variant_.math.fraction_bits() - 11, 0) &&
      !std::isinf(record.bounds[0]);  // d was not clamped
  results.doubts.push_back({report.bundle, report.lane, tag, point, divisible ? error : kInfinity});
}

/// Keeps one hit per burst: the unit's hit or a nearer one that the unit reported as a doubt.
void VariantHitTester::resolve_nothing(std::span<const RayBundle> batch, HitResults& results) {
  const auto offer = [&](std::uint32_t index, std::uint32_t lane, std::uint32_t record, float t,
                         const glm::vec3& point) {
    const std::uint32_t tag = batch[index].first_tag + record;
    // Separates equal distances in the order of the tags, far below the precision of float32.
    const double told_apart = t * (1.0 + std::ldexp(static_cast<double>(tag), -52));
    // Without bounds, the unit's P is used as it is.
    const SureHit hit{index, lane, tag, point, 0.0f, {told_apart, told_apart}};
    const bool same_burst = !results.hits.empty() && results.hits.back().bundle == index &&
                            results.hits.back().lane == lane;
    if (!same_burst) {
      results.hits.push_back(hit);
    } else if (told_apart < results.hits.back().t.low) {
      results.hits.back() = hit;
    }
  };
  auto hit = found_.hits.begin();
  const auto offer_hits = [&](auto belongs_here) {
    for (; hit != found_.hits.end() && belongs_here(*hit); ++hit) {
      offer(hit->bundle, hit->lane, hit->record, hit->t, hit->point);
    }
  };
  for (const TestReport& report : found_.reports) {
    if (report.kind != TestReport::Kind::kDoubt) continue;
    offer_hits([&](const BurstHit& h) {
      return h.bundle != report.bundle ? h.bundle < report.bundle : h.lane <= report.lane;
    });
    const RayBundle& bundle = batch_[report.bundle];
    const PolygonRecord& record = bundle.records[report.record];
    const glm::vec3 direction = bundle.lane_direction(static_cast<int>(report.lane));
    const float t = twin_.distance(record, direction).t;
    if (!(t > 0.0f) || std::isinf(t)) continue;
    offer(report.bundle, report.lane, report.record, t, twin_.point(record, direction));
  }
  offer_hits([](const BurstHit&) { return true; });
}

HitCounters VariantHitTester::counters() const { return hit_counters(unit_->counters()); }

std::unique_ptr<HitTester> make_variant_tester(const Variant& variant,
                                               std::unique_ptr<PlaneUnit> unit) {
  return std::make_unique<SerialVariantTester>(variant, std::move(unit));
}

std::unique_ptr<HitTester> make_variant_tester(const Variant& variant) {
  if (variant.unit == Variant::Unit::kSerial) {
    return make_variant_tester(variant, std::make_unique<VariantPlaneUnit>(variant.math));
  }
  return std::make_unique<VariantHitTester>(variant,
                                            std::make_unique<VariantBurstUnit>(variant.math));
}

}  // namespace raygate
