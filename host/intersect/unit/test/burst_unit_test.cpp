#include "host/intersect/unit/burst_unit.h"

#include <gtest/gtest.h>

#include <bit>

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

}  // namespace
}  // namespace raygate
