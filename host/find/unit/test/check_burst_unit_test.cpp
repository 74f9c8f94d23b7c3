#include "host/find/unit/check_burst_unit.h"

#include <gtest/gtest.h>

#include <bit>

#include "host/find/unit/cpu_burst_unit.h"

namespace raygate {
namespace {

/// The twin with a fault: one bit of the nearest hit's P, or one report too few.
class FaultyUnit : public CpuBurstUnit {
 public:
  explicit FaultyUnit(bool drop_report) : drop_report_(drop_report) {}

  void run(std::span<const RayBundle> batch, BurstResults& results) override {
    CpuBurstUnit::run(batch, results);
    if (drop_report_) {
      results.reports.pop_back();
    } else {
      float& y = results.hits.back().point.y;
      y = std::bit_cast<float>(std::bit_cast<std::uint32_t>(y) ^ 1);
    }
  }

 private:
  bool drop_report_;
};

class CheckBurstUnitTest : public testing::Test {
 protected:
  CheckBurstUnitTest() {
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
  }

  PolygonRecord records_[2];
  RayBundle batch_[1]{};
};

TEST_F(CheckBurstUnitTest, GivesTheResultsOfUnitsThatAgree) {
  CheckBurstUnit check(std::make_unique<CpuBurstUnit>(), std::make_unique<CpuBurstUnit>());
  BurstResults results;
  check.run(batch_, results);
  ASSERT_EQ(results.hits.size(), 1u);
  EXPECT_EQ(results.hits[0].record, 0u);
  EXPECT_EQ(results.hits[0].t, 2.0f);
  EXPECT_EQ(results.hits[0].point, glm::vec3(0, 0, 2));
  ASSERT_EQ(results.reports.size(), 1u);
  EXPECT_EQ(results.reports[0], (TestReport{0, 5, 1, TestReport::Kind::kDoubt}));
  EXPECT_EQ(check.counters().tests, 2u);
}

TEST_F(CheckBurstUnitTest, ThrowsOneBitThatDiffersWithTheInputs) {
  CheckBurstUnit check(std::make_unique<FaultyUnit>(false), std::make_unique<CpuBurstUnit>());
  BurstResults results;
  try {
    check.run(batch_, results);
    FAIL() << "the difference went unseen";
  } catch (const BurstUnitMismatch& mismatch) {
    const std::string what = mismatch.what();
    EXPECT_NE(what.find("direction 00000000 00000000 3F800000"), std::string::npos) << what;
    EXPECT_NE(what.find("P 40000000 00000000 00000001 40000000"), std::string::npos) << what;
    EXPECT_NE(what.find("record 1"), std::string::npos) << what;
  }
  EXPECT_TRUE(results.hits.empty());
}

TEST_F(CheckBurstUnitTest, ThrowsAReportThatOnlyOneUnitMakes) {
  CheckBurstUnit fewer(std::make_unique<FaultyUnit>(true), std::make_unique<CpuBurstUnit>());
  CheckBurstUnit more(std::make_unique<CpuBurstUnit>(), std::make_unique<FaultyUnit>(true));
  BurstResults results;
  EXPECT_THROW(fewer.run(batch_, results), BurstUnitMismatch);
  EXPECT_THROW(more.run(batch_, results), BurstUnitMismatch);
}

}  // namespace
}  // namespace raygate
