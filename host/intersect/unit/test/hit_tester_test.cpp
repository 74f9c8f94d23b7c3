// Sure hits of testers are hits, and every nearest hit is reported. Also tests the comparison of
// burst units and the reference model of the plane unit.
#include "host/intersect/unit/hit_tester.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "host/exact/test/meshes.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/unit/test/same_results.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::Random;

/// A batch of bundles, each of seven rays from one origin and a run of triangles around the origin.
struct Batch {
  std::vector<glm::vec3> origins;
  std::vector<std::vector<Corners>> triangles;
  std::vector<std::vector<PolygonRecord>> records;
  std::vector<RayBundle> bundles;

  Batch(Random& random, int count) {
    for (int i = 0; i < count; ++i) add(random, static_cast<std::uint32_t>(100 * i));
    for (int i = 0; i < count; ++i) bundles[i].records = records[i].data();
  }

  [[nodiscard]] Ray ray(std::uint32_t bundle, std::uint32_t lane) const {
    return {origins[bundle], bundles[bundle].lane_direction(static_cast<int>(lane))};
  }

 private:
  void add(Random& random, std::uint32_t tag) {
    const glm::vec3 origin = random.point();
    std::vector<Corners> run;
    for (int i = random.below(6); i >= 0; --i) {
      run.push_back({random.point(2.0f), random.point(2.0f), random.point(2.0f)});
      if (random.below(3) == 0) run.push_back({run[0][1], run[0][0], run[0][2]});  // a duplicate
      if (random.below(3) == 0) {  // a near tie in depth
        Corners close = run[0];
        for (auto& v : close) v *= 1.0f + random.uniform(-1e-7f, 1e-7f);
        run.push_back(close);
      }
    }
    RayBundle bundle;
    bundle.record_count = static_cast<std::uint32_t>(run.size());
    bundle.first_tag = tag;
    bundle.lanes = 0xFF & ~(1u << random.below(8));
    for (int lane = 0; lane < kLanes; ++lane) {
      const Corners& t = run[random.below(static_cast<int>(run.size()))];
      const float edge = random.below(3) == 0 ? 0.0f : random.uniform(0, 0.5f);
      const glm::vec3 aim = glm::mix(glm::mix(t[0], t[1], random.uniform(0, 1)), t[2], edge);
      const glm::vec3 direction = scaled_direction(glm::dvec3(aim) - glm::dvec3(origin));
      for (int k = 0; k < 3; ++k) bundle.direction[k][lane] = direction[k];
    }
    std::vector<PolygonRecord> made;
    for (const Corners& t : run) made.push_back(make_record(origin, t));
    origins.push_back(origin);
    triangles.push_back(std::move(run));
    records.push_back(std::move(made));
    bundles.push_back(bundle);
  }
};

using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;

Key key_of(const HitReport& report) { return {report.bundle, report.lane, report.hit.primitive}; }

/// Compares the reports of `tester`, which must be new, with exact arithmetic.
void expect_the_truth(HitTester& tester) {
  Random random;
  const Batch batch(random, 20000);
  HitReports reports;
  tester.run(batch.bundles, reports);

  std::set<Key> doubtful, sure;
  for (const HitReport& report : reports) {
    (report.is_sure ? sure : doubtful).insert(key_of(report));
    if (!report.is_sure) continue;
    const Corners& t = batch.triangles[report.bundle][report.hit.primitive - 100 * report.bundle];
    const Ray ray = batch.ray(report.bundle, report.lane);
    ASSERT_TRUE(hits_triangle(ray, t));
    const Interval exact = hit_distance(ray, t);
    ASSERT_LE(report.hit.t.low, exact.low);
    ASSERT_GE(report.hit.t.high, exact.high);
  }
  EXPECT_GT(doubtful.size(), 100u);
  EXPECT_GT(sure.size(), 10000u);

  // The nearest hit of every burst is among the reports.
  for (std::uint32_t b = 0; b < batch.bundles.size(); ++b) {
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      if ((batch.bundles[b].lanes >> lane & 1) == 0) continue;
      const Ray ray = batch.ray(b, lane);
      const auto& run = batch.triangles[b];
      int nearest = -1;
      for (int i = 0; i < static_cast<int>(run.size()); ++i) {
        if (!hits_triangle(ray, run[i])) continue;
        if (nearest < 0 || compare_hits(ray, run[i], run[nearest]) < 0) nearest = i;
      }
      if (nearest < 0) continue;
      const Key key = {b, lane, 100 * b + static_cast<std::uint32_t>(nearest)};
      ASSERT_TRUE(sure.contains(key) || doubtful.contains(key)) << "bundle " << b;
    }
  }
  const HitCounters counters = tester.counters();
  EXPECT_EQ(counters.tests, counters.misses + counters.hits + counters.edge_doubts);
  EXPECT_EQ(counters.edge_doubts, doubtful.size());
  EXPECT_GT(counters.depth_doubts, 0u);
}

TEST(SerialHitTester, ReportsHoldTheTruth) {
  SerialHitTester tester(std::make_unique<ReferencePlaneUnit>());
  expect_the_truth(tester);
  const HitCounters counters = tester.counters();
  EXPECT_EQ(counters.plane_tests, counters.hits + counters.edge_doubts);
}

TEST(PipelineHitTester, ReportsHoldTheTruth) {
  PipelineHitTester tester(std::make_unique<ReferenceBurstUnit>());
  expect_the_truth(tester);
}

// The unit computes P of nearest hits, the tester P of other reports: both have the same bits.
TEST(PipelineHitTester, HasThePointsOfTheSerialUnit) {
  Random random;
  const Batch batch(random, 2000);
  SerialHitTester serial(std::make_unique<ReferencePlaneUnit>());
  PipelineHitTester pipeline(std::make_unique<ReferenceBurstUnit>());
  HitReports a, b;
  serial.run(batch.bundles, a);
  pipeline.run(batch.bundles, b);
  std::map<Key, glm::vec3> points;
  for (const HitReport& report : a) points[key_of(report)] = report.hit.point;
  std::size_t compared = 0;
  for (const HitReport& report : b) {
    const auto point = points.find(key_of(report));
    if (point == points.end()) continue;
    EXPECT_EQ(std::memcmp(&point->second, &report.hit.point, sizeof(glm::vec3)), 0);
    ++compared;
  }
  EXPECT_GT(compared, 1000u);
}

TEST(SerialHitTester, ThePlaneOfTheOriginIsAMissAndAnEmptyRunNothing) {
  const PolygonRecord record =
      make_record(glm::vec3(0), {glm::vec3(-1, 0, 1), glm::vec3(1, 0, 1), glm::vec3(0, 0, 3)});
  RayBundle bundle{};
  bundle.direction[2][0] = 1.0f;
  bundle.lanes = 1;
  bundle.records = &record;
  bundle.record_count = 1;
  RayBundle empty = bundle;
  empty.record_count = 0;
  const RayBundle batch[] = {bundle, empty};
  SerialHitTester tester(std::make_unique<ReferencePlaneUnit>());
  HitReports reports;
  tester.run(batch, reports);
  EXPECT_TRUE(reports.empty());
  EXPECT_EQ(tester.counters().misses, 1u);
}

/// A unit that returns the same result for every batch.
class WildUnit : public BurstUnit {
 public:
  explicit WildUnit(const BurstResult& result) : result_(result) {}
  void finish(BurstResults& results) override { results = {result_}; }
  [[nodiscard]] HitCounters counters() const override { return {}; }

 private:
  BurstResult result_;
};

TEST(PipelineHitTester, RefusesResultsAboutWhatItDidNotGive) {
  Random random;
  const Batch batch(random, 3);
  const std::uint32_t records = batch.bundles[1].record_count;
  const auto outcome = [&](const BurstResult& result) -> std::string {
    PipelineHitTester tester(std::make_unique<WildUnit>(result));
    HitReports reports;
    try {
      tester.run(batch.bundles, reports);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_EQ(outcome({1, 7, records - 1}), "taken");
  for (const auto& [bundle, lane, record] :
       {Key{3, 0, 0}, Key{1u << 31, 0, 0}, Key{1, 8, 0}, Key{1, 0, records}, Key{1, 0, ~0u}}) {
    EXPECT_NE(outcome({bundle, lane, record}), "taken");
    EXPECT_NE(outcome({bundle, lane, record, BurstResult::Kind::kDoubt}), "taken");
  }
  EXPECT_EQ(outcome({1, 8, 0}),
            "hit-test unit: found record 0 of lane 8 of bundle 1, expected one that it was given");
}

// P is within its error bound for rays from perpendicular to as flat as the unit allows, with the
// additional bound for coordinates that underflow.
class PointError : public testing::Test {
 protected:
  void check(const Ray& ray, const Corners& triangle) {
    if (!hits_triangle(ray, triangle)) return;
    NearestHit hit;
    set_point(make_record(ray.origin, triangle), ray.direction, hit);
    const float error = hit.point_error;
    if (std::isinf(error)) {
      ++none_;
      return;
    }
    ++hits_;
    flat_ += error > 0x1p-12f;
    const Interval t = hit_distance(ray, triangle);  // relative error at most 2^-33
    const glm::dvec3 exact = 0.5 * (t.low + t.high) * glm::dvec3(ray.direction);
    const double of_itself = double{error} + 0x1p-33, besides = 0x1p-46 * largest(exact);
    for (int k = 0; k < 3; ++k) {
      const double off = std::abs(double{hit.point[k]} - exact[k]), size = std::abs(exact[k]);
      ASSERT_LE(off, of_itself * size + besides);
      underflows_ += off > of_itself * size;
      worst_ = std::max(worst_, size > 0x1p-20 * largest(exact) ? off / (error * size) : 0.0);
    }
  }

  Random random_;
  int hits_ = 0, flat_ = 0, none_ = 0, underflows_ = 0;
  double worst_ = 0.0;
};

TEST_F(PointError, HoldsFromStraightOnToFlat) {
  for (int i = 0; i < 200'000; ++i) {
    const float scale = std::ldexp(1.0f, random_.below(41) - 20);
    FloatCorners t = {random_.point(scale), random_.point(scale), random_.point(scale)};
    const glm::vec3 origin = random_.point(2.0f * scale);
    if (random_.below(2) == 0) {  // nearly in the plane of the origin
      const float share = std::ldexp(1.0f, -random_.below(16));
      t[2] = glm::mix(glm::mix(t[0], t[1], 0.4f) + 0.5f * (t[0] - origin), t[2], share);
    }
    const glm::dvec3 aim = (glm::dvec3(t[0]) + glm::dvec3(t[1]) + glm::dvec3(t[2])) / 3.0;
    check({origin, scaled_direction(aim - glm::dvec3(origin))}, widened(t));
  }
  EXPECT_EQ(underflows_, 0);
  EXPECT_GT(flat_, 10'000);
  EXPECT_GT(none_, 100);
  EXPECT_GT(worst_, 0.02) << "the bound is a bound, not a guess";
}

TEST_F(PointError, HoldsWhereCoordinatesUnderflow) {
  check({glm::vec3(0.0f), glm::vec3(1.9f, 0x1p-149f, 0)},
        {glm::vec3(1, -1, -1), glm::vec3(1, 3, -1), glm::vec3(1, -1, 3)});
  EXPECT_EQ(underflows_, 1);
  for (int i = 0; i < 100'000; ++i) {
    const float size = std::ldexp(1.0f, random_.below(200) - 100);
    Ray ray{.direction = {random_.uniform(1, 2), 0, 0}};
    for (int k = 1; k < 3; ++k) {
      ray.direction[k] = std::ldexp(random_.uniform(-1, 1), -random_.below(150));
    }
    std::swap(ray.direction.x, ray.direction[random_.below(3)]);
    check(ray, {random_.point(size), random_.point(size), random_.point(size)});
  }
  EXPECT_GT(hits_, 5000);
  EXPECT_GT(underflows_, 100);
}

class SameResultsTest : public testing::Test {
 protected:
  SameResultsTest() {
    const glm::vec3 origin(0.0f);
    records_[0] =
        make_record(origin, {glm::vec3(-1, -1, 2), glm::vec3(1, -1, 2), glm::vec3(0, 1, 2)});
    records_[1] =
        make_record(origin, {glm::vec3(0, -1, 1), glm::vec3(0, 1, 1), glm::vec3(3, 0, 1)});
    RayBundle& bundle = batch_[0];
    bundle.direction[2][5] = 1.0f;  // through the first triangle, and an edge of the second
    bundle.lanes = 1u << 5;
    bundle.records = records_;
    bundle.record_count = 2;
    ReferenceBurstUnit().run(batch_, results_);
  }

  PolygonRecord records_[2];
  RayBundle batch_[1]{};
  BurstResults results_;
};

TEST_F(SameResultsTest, OneBitThatDiffersIsThrownWithTheInputs) {
  BurstResults faulty = results_;
  faulty[1].point.y = std::bit_cast<float>(1u);
  try {
    require_same(batch_, faulty, results_);
    FAIL() << "the difference went unseen";
  } catch (const EngineMismatch& mismatch) {
    const std::string what = mismatch.what();
    EXPECT_NE(what.find("direction 00000000 00000000 3F800000"), std::string::npos) << what;
    EXPECT_NE(what.find("P 40000000 00000000 00000001 40000000"), std::string::npos) << what;
    EXPECT_NE(what.find("record 1"), std::string::npos) << what;
  }
}

TEST_F(SameResultsTest, AReportThatOnlyOneUnitMakesIsThrown) {
  ASSERT_EQ(results_.size(), 2u);
  EXPECT_EQ(results_[0], (BurstResult{0, 5, 1, BurstResult::Kind::kDoubt}));
  EXPECT_EQ(results_[1], (BurstResult{0, 5, 0, BurstResult::Kind::kHit, 2.0f, 0, {0, 0, 2}}));
  EXPECT_NO_THROW(require_same(batch_, results_, results_));
  BurstResults fewer = results_;
  fewer.erase(fewer.begin());
  EXPECT_THROW(require_same(batch_, fewer, results_), EngineMismatch);
  EXPECT_THROW(require_same(batch_, results_, fewer), EngineMismatch);
}

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

glm::vec3 intersect(PlaneUnit& unit, const PlaneTest& test) {
  glm::vec3 point;
  unit.intersect({&test, 1}, {&point, 1});
  return point;
}

const PlaneTest kPaper = {{3.3125f, 5.875f, 2.921875f}, {15.1875f, 0.46875f, 2.109375f}, 1.75f};

// The paper's worked example (section 4.2), correctly rounded.
TEST(ReferencePlaneUnit, PaperExample) {
  ReferencePlaneUnit unit;
  const glm::vec3 point = intersect(unit, kPaper);
  EXPECT_EQ(bits(point.x), 0x3DC873FDu);
  EXPECT_EQ(bits(point.y), 0x3E31C2A2u);
  EXPECT_EQ(bits(point.z), 0x3DB0D093u);
  EXPECT_EQ(unit.clocks(), 0u);
}

TEST(ReferencePlaneUnit, ParallelRayGivesInfinityAndTheOneNan) {
  ReferencePlaneUnit unit;
  const glm::vec3 point = intersect(unit, {{1, 0, -1}, {0, 1, 0}, 2});
  EXPECT_EQ(point.x, std::numeric_limits<float>::infinity());
  EXPECT_EQ(bits(point.y), 0x7FC00000u);
  EXPECT_EQ(point.z, -std::numeric_limits<float>::infinity());
  const float odd_nan = std::bit_cast<float>(0xFFC12345u);
  EXPECT_EQ(bits(intersect(unit, {{odd_nan, 1, 1}, {1, 1, 1}, 1}).z), 0x7FC00000u);
}

// The accumulator's +0 decides the sign of a divisor whose products are all -0.
TEST(ReferencePlaneUnit, AccumulatorStartsFromPlusZero) {
  ReferencePlaneUnit unit;
  EXPECT_EQ(intersect(unit, {{1, 1, 1}, {-0.0f, -0.0f, -0.0f}, 1}).x,
            std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace raygate
