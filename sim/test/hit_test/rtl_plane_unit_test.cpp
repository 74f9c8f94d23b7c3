// Tests the paper's simulated unit behind the renderer's interface.
#include <gtest/gtest.h>

#include <vector>

#include "sim/rtl_units.h"
#include "sim/test/hit_test/float_stream.h"

namespace raygate {
namespace {

PlaneTest random_test(FloatStream& floats) {
  floats.next_test();
  const auto vector = [&] {
    const float x = floats(), y = floats(), z = floats();
    return glm::vec3(x, y, z);
  };
  const glm::vec3 direction = vector(), normal = vector();
  return {.direction = direction, .normal = normal, .d = floats()};
}

glm::vec3 expected(const PlaneTest& test) {
  float dot = 0.0f;
  for (int k = 0; k < 3; ++k) dot += test.normal[k] * test.direction[k];
  glm::vec3 point;
  for (int k = 0; k < 3; ++k) point[k] = from_bits(bits(test.d * test.direction[k] / dot));
  return point;
}

class RtlPlaneUnitTest : public testing::TestWithParam<Arith> {};

TEST_P(RtlPlaneUnitTest, BatchesOfAllSizesEqualFloatArithmetic) {
  constexpr std::uint32_t kSeed = 20260103;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  FloatStream floats(kSeed);
  RtlPlaneUnit unit(GetParam());
  std::uint64_t clocks = 0;
  for (std::size_t size : {0, 1, 2, 3, 20, 0, 1, 5000}) {
    std::vector<PlaneTest> tests(size);
    for (auto& test : tests) test = random_test(floats);
    std::vector<glm::vec3> points(size);
    unit.intersect(tests, points);
    for (std::size_t i = 0; i < size; ++i) {
      for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(points[i][k]), bits(expected(tests[i])[k]))
            << "test " << i << " of " << size << ", component " << k;
      }
    }
    clocks += size == 0 ? 0 : 7 * size + 3;
    EXPECT_EQ(unit.clocks(), clocks);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, RtlPlaneUnitTest,
                         testing::Values(Arith::kStructural, Arith::kBehavioural));

}  // namespace
}  // namespace raygate
