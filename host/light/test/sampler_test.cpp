// Sample points are even, independent and reproducible; filters have their formulas' variance.
#include "host/light/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "host/film/film.h"

namespace raygate {
namespace {

// Of 2^k successive points, every box of 2^i x 2^j in the unit square of area 2^-k holds one.
TEST(Sampler, EveryElementaryIntervalHoldsOnePoint) {
  for (const std::uint32_t dimension : {0u, 1u, 77u}) {
    const std::uint32_t key = pixel_key(5, 10, 20);
    for (int k = 0; k <= 8; ++k) {
      const int count = 1 << k;
      for (const std::uint32_t first : {0u, 3u * count}) {
        for (int i = 0; i <= k; ++i) {
          std::set<std::pair<int, int>> boxes;
          for (int n = 0; n < count; ++n) {
            const SquarePoint<float> p = random_point<float>(first + n, key, dimension);
            ASSERT_TRUE(p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f);
            boxes.insert({int(p.x * (1 << i)), int(p.y * (1 << (k - i)))});
          }
          ASSERT_EQ(boxes.size(), std::size_t(count)) << k << " " << i;
        }
      }
    }
  }
}

// Two streams, and a pixel and its neighbour, are uncorrelated up to chance.
TEST(Sampler, StreamsAndPixelsAreIndependent) {
  constexpr int kPixels = 64;
  double streams = 0.0, neighbours = 0.0, mean = 0.0;
  for (int y = 0; y < kPixels; ++y) {
    for (int x = 0; x < kPixels; ++x) {
      const std::uint32_t here = pixel_key(1, x, y), beside = pixel_key(1, x + 1, y);
      const double a = random_point<float>(0, here, 3).x - 0.5;
      mean += a;
      streams += a * (random_point<float>(0, here, 4).x - 0.5);
      neighbours += a * (random_point<float>(0, beside, 3).x - 0.5);
    }
  }
  constexpr double kCount = kPixels * kPixels, kDeviation = 1.0 / 12.0 / 64.0;  // of mean products
  EXPECT_LT(std::abs(mean / kCount), 4.0 * std::sqrt(1.0 / 12.0) / 64.0);
  EXPECT_LT(std::abs(streams / kCount), 4.0 * kDeviation);
  EXPECT_LT(std::abs(neighbours / kCount), 4.0 * kDeviation);
}

TEST(Sampler, KeysDependOnSeedAndPixel) {
  EXPECT_NE(pixel_key(1, 2, 3), pixel_key(std::uint64_t{1} << 32, 2, 3));
  EXPECT_NE(pixel_key(1, 2, 3), pixel_key(1, 3, 2));
}

// A filter's variance by its formula is the integral of x^2 w(x) over the integral of w(x).
TEST(ReconstructionFilter, OffsetsHaveTheFiltersSpread) {
  const auto variance_of = [](auto weight, double radius) {
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < 100000; ++i) {
      const double x = ((i + 0.5) / 50000 - 1.0) * radius;
      sum += weight(x);
      squares += x * x * weight(x);
    }
    return squares / sum;
  };
  const auto window = [](double x) {
    const double a = 2.0 * std::acos(-1.0) * (x + 1.5) / 3.0;
    return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
  };
  const struct {
    ReconstructionFilter filter;
    double variance;
  } kCases[] = {{ReconstructionFilter::kBox, 1.0 / 12.0},
                {ReconstructionFilter::kBlackmanHarris, variance_of(window, 1.5)}};
  for (const auto& c : kCases) {
    constexpr int kCount = 1 << 14;
    glm::dvec2 sum(0.0), squares(0.0);
    for (int i = 0; i < kCount; ++i) {
      const SquarePoint<float> u = random_point<float>(i, 0u, 0);
      const glm::dvec2 offset = filter_offset(c.filter, {u.x, u.y});
      ASSERT_LE(std::max(std::abs(offset.x), std::abs(offset.y)), filter_radius(c.filter));
      sum += offset;
      squares += offset * offset;
    }
    EXPECT_NEAR(sum.x / kCount, 0.0, 1e-3);
    EXPECT_NEAR(squares.x / kCount, c.variance, 2e-3 * c.variance);
    EXPECT_NEAR(squares.y / kCount, c.variance, 2e-3 * c.variance);
  }
}

}  // namespace
}  // namespace raygate
