// The plane unit's twin, and the check of one unit against another.
#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "host/find/unit/check_plane_unit.h"
#include "host/find/unit/cpu_plane_unit.h"

namespace raygate {
namespace {

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

glm::vec3 intersect(PlaneUnit& unit, const PlaneTest& test) {
  glm::vec3 point;
  unit.intersect({&test, 1}, {&point, 1});
  return point;
}

const PlaneTest kPaper = {{3.3125f, 5.875f, 2.921875f}, {15.1875f, 0.46875f, 2.109375f}, 1.75f};

// The paper's worked example (section 4.2), correctly rounded.
TEST(CpuPlaneUnit, PaperExample) {
  CpuPlaneUnit unit;
  const glm::vec3 point = intersect(unit, kPaper);
  EXPECT_EQ(bits(point.x), 0x3DC873FDu);
  EXPECT_EQ(bits(point.y), 0x3E31C2A2u);
  EXPECT_EQ(bits(point.z), 0x3DB0D093u);
  EXPECT_EQ(unit.clocks(), 0u);
}

TEST(CpuPlaneUnit, ParallelRayGivesInfinityAndTheOneNan) {
  CpuPlaneUnit unit;
  const glm::vec3 point = intersect(unit, {{1, 0, -1}, {0, 1, 0}, 2});
  EXPECT_EQ(point.x, std::numeric_limits<float>::infinity());
  EXPECT_EQ(bits(point.y), 0x7FC00000u);
  EXPECT_EQ(point.z, -std::numeric_limits<float>::infinity());
  const float odd_nan = std::bit_cast<float>(0xFFC12345u);
  EXPECT_EQ(bits(intersect(unit, {{odd_nan, 1, 1}, {1, 1, 1}, 1}).z), 0x7FC00000u);
}

// The accumulator's +0 decides the sign of a divisor whose products are all -0.
TEST(CpuPlaneUnit, AccumulatorStartsFromPlusZero) {
  CpuPlaneUnit unit;
  EXPECT_EQ(intersect(unit, {{1, 1, 1}, {-0.0f, -0.0f, -0.0f}, 1}).x,
            std::numeric_limits<float>::infinity());
}

/// A unit with one wrong bit in the second component.
class FaultyUnit : public CpuPlaneUnit {
 public:
  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override {
    CpuPlaneUnit::intersect(tests, points);
    for (glm::vec3& p : points) p.y = std::bit_cast<float>(bits(p.y) ^ 1u);
  }
};

TEST(CheckPlaneUnit, PassesTwins) {
  CheckPlaneUnit unit(std::make_unique<CpuPlaneUnit>(), std::make_unique<CpuPlaneUnit>());
  EXPECT_EQ(bits(intersect(unit, kPaper).x), 0x3DC873FDu);
}

TEST(CheckPlaneUnit, StopsAtTheFirstBitAndSaysHowToReplayIt) {
  CheckPlaneUnit unit(std::make_unique<FaultyUnit>(), std::make_unique<CpuPlaneUnit>());
  try {
    intersect(unit, kPaper);
    FAIL() << "a difference went unnoticed";
  } catch (const PlaneUnitMismatch& mismatch) {
    EXPECT_STREQ(mismatch.what(),
                 "the plane units differ: inputs (Ix Iy Iz a b c d) 40540000 40BC0000 403B0000 "
                 "41730000 3EF00000 40070000 3FE00000, unit 3DC873FD 3E31C2A3 3DB0D093, "
                 "reference 3DC873FD 3E31C2A2 3DB0D093");
  }
}

}  // namespace
}  // namespace raygate
