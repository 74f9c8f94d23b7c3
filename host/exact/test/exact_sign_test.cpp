#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "host/exact/exact.h"
#include "host/exact/test/rational_oracle.h"

namespace raygate {
namespace {

using test::sign_of;

// Points of a coarse grid are moved by tiny amounts, so that many are exactly or nearly collinear.
// Coordinates are multiples of 2^-30 below 2^3, so that __int128 holds the determinant.
TEST(Turn, AgreesWithIntegersNearALine) {
  std::mt19937_64 random(2);
  const auto coordinate = [&] {
    const auto coarse = static_cast<std::int64_t>(random() % 9) - 4;
    const auto fine = static_cast<std::int64_t>(random() % 3) - 1;
    const int shift = static_cast<int>(random() % 8);
    return (coarse << 30) + fine * (std::int64_t{1} << (9 + shift));
  };
  int zeros = 0;
  for (int round = 0; round < 200000; ++round) {
    std::int64_t c[6];
    glm::vec2 p[3];
    for (int i = 0; i < 6; ++i) {
      c[i] = coordinate();
      p[i / 2][i % 2] = std::ldexp(static_cast<float>(c[i]), -30);
      c[i] = static_cast<std::int64_t>(std::ldexp(static_cast<double>(p[i / 2][i % 2]), 30));
    }
    const __int128 determinant = static_cast<__int128>(c[2] - c[0]) * (c[5] - c[1]) -
                                 static_cast<__int128>(c[3] - c[1]) * (c[4] - c[0]);
    zeros += determinant == 0;
    ASSERT_EQ(orient2d(p[0], p[1], p[2]), sign_of(determinant)) << "round " << round;
  }
  EXPECT_GT(zeros, 100) << "the cases are to be hard";
}

TEST(Turn, FromTheSmallestToTheLargestFloats) {
  const float tiny = 0x1p-149f;
  const float huge = 0x1.fffffep127f;
  EXPECT_EQ(orient2d({0, 0}, {tiny, 0}, {0, tiny}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, tiny}, {tiny, 0}), -1);
  EXPECT_EQ(orient2d({-huge, -huge}, {huge, huge}, {0, tiny}), 1);
  EXPECT_EQ(orient2d({-huge, -huge}, {huge, huge}, {tiny, 0}), -1);
  EXPECT_EQ(orient2d({-huge, -huge}, {huge, huge}, {tiny, tiny}), 0);
}

TEST(AreaSign, IsExactWhereRoundingIsNot) {
  // A square of side 2^-20 around a far point: the products agree in their first 40 bits.
  const float far = 1.0f, step = 0x1p-20f;
  std::vector<glm::dvec2> square{
      {far, far}, {far + step, far}, {far + step, far + step}, {far, far + step}};
  double area = 0.0;
  EXPECT_EQ(area_sign(square, area), 1);
  std::swap(square[1], square[3]);
  EXPECT_EQ(area_sign(square, area), -1);
  const std::vector<glm::dvec2> bow_tie{{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  EXPECT_EQ(area_sign(bow_tie, area), 0);
}

TEST(TriangleNormal, IsZeroOnlyForCollinearCorners) {
  const auto is_zero = [](const Corners& t) { return triangle_normal(t) == glm::dvec3(0.0); };
  EXPECT_TRUE(is_zero({glm::dvec3(0, 0, 0), {1, 2, 3}, {2, 4, 6}}));
  EXPECT_TRUE(is_zero({glm::dvec3(1, 1, 1), {1, 1, 1}, {5, 0, 2}}));
  EXPECT_FALSE(is_zero({glm::dvec3(0, 0, 0), {1, 2, 3}, {2, 4, std::nextafter(6.0f, 7.0f)}}));
  EXPECT_FALSE(is_zero({glm::dvec3(0, 0, 0), {1, 0, 0}, {2, 0x1p-149f, 0}}));
}

}  // namespace
}  // namespace raygate
