#include "host/variants/variant_hit_tester.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/exact/exact.h"
#include "host/intersect/unit/test/same_results.h"
#include "host/lab/stress/cases.h"
#include "host/scene/camera.h"
#include "sim/random_bursts.h"

namespace raygate {
namespace {

using lab::Random;

TEST(VariantBurstUnit, InBinary32IsTheCpusTwin) {
  RandomBursts random(1);
  ReferenceBurstUnit cpu;
  VariantBurstUnit variant{Arithmetic{}};
  for (int i = 0; i < 20; ++i) {
    const BurstBatch batch = random.make(3000);
    BurstResults expected, got;
    cpu.run(batch.bundles, expected);
    variant.run(batch.bundles, got);
    ASSERT_NO_THROW(require_same(batch.bundles, got, expected));
  }
  EXPECT_EQ(variant.counters().depth_doubts, cpu.counters().depth_doubts);
  EXPECT_GT(variant.counters().depth_doubts, 0u);
}

/// A ray and a triangle that it meets near an edge or a vertex, at any distance and angle.
struct Case {
  Ray ray;
  Corners triangle;
};

Case hard_case(Random& random) {
  Case c;
  c.ray.origin = glm::vec3(random.point());
  const double size = random.log_uniform(0.1, 10.0), distance = random.log_uniform(1.0, 10.0);
  const glm::dvec3 center = glm::dvec3(c.ray.origin) + distance * random.unit();
  for (glm::dvec3& corner : c.triangle) corner = glm::vec3(center + size * random.point());
  const double part = random.uniform(0, 1),
               off = random.one_in(2) ? random.log_uniform(1e-8, 1.0) : 1;
  const glm::dvec3 aim = glm::mix(glm::dvec3(c.triangle[0]), glm::dvec3(c.triangle[1]), part) +
                         off * size * random.point();
  c.ray.direction = scaled_direction(aim - glm::dvec3(c.ray.origin));
  return c;
}

/// Tests one ray against one record.
HitReports test(HitTester& tester, const Case& c, const PolygonRecord& record) {
  RayBundle bundle;
  for (int k = 0; k < 3; ++k) bundle.direction[k][0] = c.ray.direction[k];
  bundle.records = &record;
  bundle.record_count = 1;
  bundle.lanes = 1;
  HitReports reports;
  tester.run({&bundle, 1}, reports);
  return reports;
}

TEST(VariantHitTester, IsNeverWrongWhereDoubtsAreResolved) {
  for (const Variant& variant : all_variants_of_arithmetic()) {
    if (!variant.doubts) continue;
    Random random(7);
    const auto tester = make_variant_tester(variant);
    int sure_hits = 0, sure_misses = 0, doubts = 0;
    for (int i = 0; i < 10000; ++i) {
      const Case c = hard_case(random);
      const HitReports reports = test(*tester, c, make_record(c.ray.origin, c.triangle));
      const bool truth = hits_triangle(c.ray, c.triangle);
      if (reports.empty()) {
        ++sure_misses;
        ASSERT_FALSE(truth) << variant.name << ", case " << i;
      } else if (!reports.front().is_sure) {
        ++doubts;
      } else {
        ++sure_hits;
        ASSERT_TRUE(truth) << variant.name << ", case " << i;
        const Interval exact = hit_distance(c.ray, c.triangle), t = reports.front().hit.t;
        EXPECT_LE(t.low, exact.high) << variant.name << ", case " << i;
        EXPECT_GE(t.high, exact.low) << variant.name << ", case " << i;
      }
    }
    EXPECT_GT(sure_hits, 200) << variant.name;
    EXPECT_GT(sure_misses, 200) << variant.name;
    EXPECT_GT(doubts, 20) << variant.name;
  }
}

TEST(VariantHitTester, IsOftenWrongWhereTheyAreIgnored) {
  Random random(8);
  const auto tester = make_variant_tester(*variant_of_format("e8p12-raw"));
  int wrong = 0;
  for (int i = 0; i < 10000; ++i) {
    const Case c = hard_case(random);
    const HitReports reports = test(*tester, c, make_record(c.ray.origin, c.triangle));
    EXPECT_TRUE(reports.empty() || reports.front().is_sure);
    wrong += reports.empty() == hits_triangle(c.ray, c.triangle);
  }
  EXPECT_GT(wrong, 20);
}

TEST(VariantHitTester, IgnoringDoubtsKeepsTheNearestOfABurst) {
  // Three parallel triangles cross the axis: a far triangle, then two at the same smaller distance.
  std::vector<PolygonRecord> records;
  for (const float z : {3.0f, 2.0f, 2.0f}) {
    const Corners triangle = {glm::vec3(-1, -1, z), glm::vec3(1, -1, z), glm::vec3(0, 1, z)};
    records.push_back(make_record(glm::vec3(0), triangle));
  }
  RayBundle bundle{};
  bundle.direction[2][0] = 1.0f;
  bundle.records = records.data();
  bundle.record_count = 3;
  bundle.first_tag = 10;
  bundle.lanes = 1;
  HitReports reports;
  make_variant_tester(*variant_of_format("e8p12-raw"))->run({&bundle, 1}, reports);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_EQ(reports[0].hit.primitive, 11u);
  EXPECT_EQ(reports[0].hit.point, glm::vec3(0, 0, 2));
}

TEST(VariantRecord, OfFewExponentsIsScaledIntoThem) {
  const Variant half = *variant_of_format("e5p11");
  const glm::vec3 far_away(3000.0f, 0.0f, 0.0f);
  const Corners triangle = {far_away, far_away + glm::vec3(0, 50, 0),
                            far_away + glm::vec3(0, 0, 50)};
  const PolygonRecord record = variant_record(half, make_record(glm::vec3(0), triangle));
  EXPECT_EQ(record.normal, glm::vec3(1.220703125f, 0.0f, 0.0f));  // 2500 / 2^11
  EXPECT_EQ(record.d, half.math.read(3000.0f * 1.220703125f));
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 edge = glm::abs(record.edges[k]);
    const float top = std::max({edge.x, edge.y, edge.z});
    EXPECT_TRUE(top >= 1.0f && top <= 2.0f);
    EXPECT_TRUE(std::isfinite(record.bounds[k]));
  }
  // Numbers out of the format's range put every edge in doubt.
  const PolygonRecord lost = variant_record(half, make_record(glm::vec3(-1e6f, 0, 0), triangle));
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isinf(lost.bounds[k]));
}

}  // namespace
}  // namespace raygate
