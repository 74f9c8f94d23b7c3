// The comparison of burst units, and the reference model of the plane unit.
#include "host/intersect/unit/burst_unit.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {
namespace {

class SameResultsTest : public testing::Test {
 protected:
  SameResultsTest() {
    const glm::vec3 origin(0.0f);
    records_[0] =
        make_record(origin, {glm::vec3(-1, -1, 2), glm::vec3(1, -1, 2), glm::vec3(0, 1, 2)});
    records_[1] =
        make_record(origin, {glm::vec3(0, -1, 1), glm::vec3(0, 1, 1), glm::vec3(3, 0, 1)});
    RayBundle& bundle = batch_[0];
    bundle.direction[2][5] = 1.0f;  // through the first one, and the edge of the second
    bundle.lanes = 1u << 5;
    bundle.records = records_;
    bundle.record_count = 2;
    ReferenceBurstUnit().run(batch_, results_);
  }

  PolygonRecord records_[2];
  RayBundle batch_[1]{};
  BurstResults results_;
};

TEST_F(SameResultsTest, SameOnesPass) {
  ASSERT_EQ(results_.hits.size(), 1u);
  EXPECT_EQ(results_.hits[0].record, 0u);
  EXPECT_EQ(results_.hits[0].t, 2.0f);
  EXPECT_EQ(results_.hits[0].point, glm::vec3(0, 0, 2));
  ASSERT_EQ(results_.reports.size(), 1u);
  EXPECT_EQ(results_.reports[0], (TestReport{0, 5, 1, TestReport::Kind::kDoubt}));
  EXPECT_NO_THROW(require_same(batch_, results_, results_));
}

TEST_F(SameResultsTest, OneBitThatDiffersIsThrownWithTheInputs) {
  BurstResults faulty = results_;
  faulty.hits[0].point.y = std::bit_cast<float>(1u);
  try {
    require_same(batch_, faulty, results_);
    FAIL() << "the difference went unseen";
  } catch (const BurstUnitMismatch& mismatch) {
    const std::string what = mismatch.what();
    EXPECT_NE(what.find("direction 00000000 00000000 3F800000"), std::string::npos) << what;
    EXPECT_NE(what.find("P 40000000 00000000 00000001 40000000"), std::string::npos) << what;
    EXPECT_NE(what.find("record 1"), std::string::npos) << what;
  }
}

TEST_F(SameResultsTest, AReportThatOnlyOneUnitMakesIsThrown) {
  BurstResults fewer = results_;
  fewer.reports.pop_back();
  EXPECT_THROW(require_same(batch_, fewer, results_), BurstUnitMismatch);
  EXPECT_THROW(require_same(batch_, results_, fewer), BurstUnitMismatch);
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
