// The plane unit's reference model.
#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "host/intersect/unit/burst_unit.h"

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
