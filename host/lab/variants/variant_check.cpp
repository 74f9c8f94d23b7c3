// Compares the reference model of a variant with its hardware, bit for bit.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "host/intersect/unit/hit_tester.h"
#include "host/lab/variants/rtl_variant_units.h"
#include "host/variants/variant_hit_tester.h"
#include "sim/random_bursts.h"

namespace raygate {
namespace {

/// RandomBursts in a variant's format.
class VariantBursts {
 public:
  VariantBursts(const Variant& variant, std::uint64_t seed)
      : variant_(variant), math_(variant.math), bursts_(seed), random_(seed) {
    math_.rounding = Rounding::kNearestEven;  // the host's rounding
  }

  BurstBatch make(std::uint64_t tests) {
    BurstBatch batch = bursts_.make(tests);
    PolygonRecord before = batch.records.empty() ? PolygonRecord{} : narrow(batch.records.front());
    for (RayBundle& bundle : batch.bundles) {
      for (auto& component : bundle.direction) {
        for (float& x : component) x = math_.read(x);
      }
      auto* records = batch.records.data() + (bundle.records - batch.records.data());
      for (std::uint32_t i = 0; i < bundle.record_count; ++i) {
        before = records[i] = changed(records[i], before, bundle.lane_direction(0));
      }
    }
    return batch;
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() >> 32) % n; }

  /// Returns the number of the format that is `steps` above or below `x`.
  float stepped(float x, int steps) const {
    const std::uint32_t mask = (1u << (math_.word_bits() - 1) << 1) - 1;
    return math_.from_word((math_.to_word(x) + static_cast<std::uint32_t>(steps)) & mask);
  }

  float random_number() {
    const std::uint32_t mask = (1u << (math_.word_bits() - 1) << 1) - 1;
    return math_.from_word(static_cast<std::uint32_t>(random_() >> 32) & mask);
  }

  template <class Function>
  static void for_each_word(PolygonRecord& record, Function&& function) {
    for (int k = 0; k < 3; ++k) function(record.normal[k]);
    function(record.d);
    for (glm::vec3& edge : record.edges) {
      for (int k = 0; k < 3; ++k) function(edge[k]);
    }
    for (float& bound : record.bounds) function(bound);
  }

  /// Returns the record as the host would send it. Records that are not finite, and some others,
  /// are rounded word by word.
  PolygonRecord narrow(const PolygonRecord& wide) {
    PolygonRecord record = wide;
    bool finite = true;
    for_each_word(record, [&](float& x) { finite = finite && std::isfinite(x); });
    if (finite && below(4) != 0) return variant_record(variant_, wide);
    for_each_word(record, [&](float& x) { x = math_.read(x); });
    return record;
  }

  PolygonRecord changed(const PolygonRecord& wide, const PolygonRecord& before,
                        const glm::vec3& direction) {
    PolygonRecord record = narrow(wide);
    switch (below(16)) {
      case 0:
        for_each_word(record, [&](float& x) { x = random_number(); });
        break;
      case 1:  // exactly at the bound, or one step off
        for (int k = 0; k < 3; ++k) {
          const float u = variant_.math.dot(record.edges[k], direction);
          record.bounds[k] = stepped(std::abs(u), static_cast<int>(below(3)) - 1);
        }
        break;
      case 2: {  // about the distance of the previous one: around the margin of 64 + 64 steps
        record = before;
        const int reach = 1 << below(9);
        record.d = stepped(record.d,
                           static_cast<int>(below(2 * static_cast<unsigned>(reach) + 1)) - reach);
        break;
      }
      case 3: {
        std::uint32_t word = below(16);
        for_each_word(record, [&](float& x) {
          if (word-- == 0) x = random_number();
        });
        break;
      }
      default:
        break;
    }
    return record;
  }

  const Variant& variant_;
  Arithmetic math_;
  RandomBursts bursts_;
  std::mt19937_64 random_;
};

constexpr std::uint64_t kBatch = 5000;

VariantCheck check_pipeline(const Variant& variant, std::uint64_t tests, std::uint64_t seed) {
  VariantBursts random(variant, seed);
  VariantBurstUnit twin(variant.math);
  const auto rtl = make_rtl_burst_unit(variant);
  VariantCheck check;
  if (rtl == nullptr) {
    check.difference = "no hardware of it was built";
    return check;
  }
  while (check.tests < tests && check.difference.empty()) {
    const BurstBatch batch = random.make(std::min(kBatch, tests - check.tests));
    check.tests += batch.tests;
    BurstResults expected, got;
    twin.run(batch.bundles, expected);
    rtl->run(batch.bundles, got);
    try {
      require_same(batch.bundles, got, expected);
    } catch (const std::exception& error) {
      check.difference = error.what();
    }
  }
  const BurstCounters counts = twin.counters(), simulated = rtl->counters();
  check.misses = counts.misses;
  check.hits = counts.hits;
  check.doubts = counts.doubts;
  check.near_ties = counts.near_ties;
  check.clocks = simulated.clocks;
  const bool same_events = counts.tests == simulated.tests && counts.misses == simulated.misses &&
                           counts.hits == simulated.hits && counts.doubts == simulated.doubts &&
                           counts.near_ties == simulated.near_ties;
  if (check.difference.empty() && !same_events) check.difference = "the counts of events differ";
  return check;
}

VariantCheck check_serial(const Variant& variant, std::uint64_t tests, std::uint64_t seed) {
  VariantBursts random(variant, seed);
  VariantPlaneUnit twin(variant.math);
  const auto rtl = make_rtl_plane_unit(variant);
  VariantCheck check;
  if (rtl == nullptr) {
    check.difference = "no hardware of it was built";
    return check;
  }
  const auto word = [](float x) { return std::bit_cast<std::uint32_t>(x); };
  while (check.tests < tests && check.difference.empty()) {
    const BurstBatch batch = random.make(std::min(kBatch, tests - check.tests));
    std::vector<PlaneTest> planes;
    for (const RayBundle& bundle : batch.bundles) {
      for (std::uint32_t i = 0; i < bundle.record_count * kLanes; ++i) {
        const PolygonRecord& record = bundle.records[i / kLanes];
        planes.push_back(
            {bundle.lane_direction(static_cast<int>(i % kLanes)), record.normal, record.d});
      }
    }
    std::vector<glm::vec3> expected(planes.size()), got(planes.size());
    twin.intersect(planes, expected);
    rtl->intersect(planes, got);
    check.tests += planes.size();
    for (std::size_t i = 0; i < planes.size() && check.difference.empty(); ++i) {
      for (int k = 0; k < 3; ++k) {
        if (word(expected[i][k]) == word(got[i][k])) continue;
        char text[200];
        std::snprintf(text, sizeof text,
                      "P[%d] of I = (%a, %a, %a), N = (%a, %a, %a), d = %a is %a, the twin has %a",
                      k, planes[i].direction.x, planes[i].direction.y, planes[i].direction.z,
                      planes[i].normal.x, planes[i].normal.y, planes[i].normal.z, planes[i].d,
                      got[i][k], expected[i][k]);
        check.difference = text;
        break;
      }
    }
  }
  check.clocks = rtl->clocks();
  return check;
}

}  // namespace

VariantCheck check_variant(const Variant& variant, std::uint64_t tests, std::uint64_t seed) {
  return variant.unit == Variant::Unit::kPipeline ? check_pipeline(variant, tests, seed)
                                                  : check_serial(variant, tests, seed);
}

}  // namespace raygate
