// The measures against their definitions.
#include "host/lab/pictures/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace raygate::lab {
namespace {

TEST(Compare, MeasuresAreAsDefined) {
  Film a = make_film(2, 1, {0, 0, 2, 1}, {}), b = a;
  a.color = {{1.0f, 0.0f, 0.25f, 1.0f}, {0.5f, 3.0f, 0.25f, 1.0f}};
  b.color = {{1.5f, 0.0f, 0.25f, 1.0f}, {0.5f, 2.0f, 0.25f, 1.0f}};
  const Comparison c = compare(a, b);
  EXPECT_EQ(c.differing, 2u);
  EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(1.25 / 6.0));
  EXPECT_DOUBLE_EQ(c.psnr, 10.0 * std::log10(6.0 / 1.25));
  EXPECT_FALSE(c.ssim) << "no window of 11 x 11 fits";
  const Comparison same = compare(a, a);
  EXPECT_EQ(same.differing, 0u);
  EXPECT_EQ(same.rmse, 0.0);
  EXPECT_EQ(same.psnr, std::numeric_limits<double>::infinity());
}

/// The definition, window by window, without the separated sums.
double ssim_by_definition(const std::vector<double>& a, const std::vector<double>& b, int width) {
  const int height = static_cast<int>(a.size()) / width;
  double total = 0.0;
  int windows = 0;
  for (int y = 0; y + 11 <= height; ++y) {
    for (int x = 0; x + 11 <= width; ++x, ++windows) {
      double weight = 0.0, ma = 0.0, mb = 0.0, va = 0.0, vb = 0.0, cov = 0.0;
      const auto each = [&](auto visit) {
        for (int v = 0; v < 11; ++v) {
          for (int u = 0; u < 11; ++u) {
            const double w = std::exp(-((u - 5) * (u - 5) + (v - 5) * (v - 5)) / 4.5);
            const auto i = static_cast<std::size_t>((y + v) * width + x + u);
            visit(w, a[i], b[i]);
          }
        }
      };
      each([&](double w, double p, double q) { weight += w, ma += w * p, mb += w * q; });
      ma /= weight, mb /= weight;
      each([&](double w, double p, double q) {
        va += w * (p - ma) * (p - ma) / weight;
        vb += w * (q - mb) * (q - mb) / weight;
        cov += w * (p - ma) * (q - mb) / weight;
      });
      total +=
          (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
    }
  }
  return total / windows;
}

TEST(Compare, StructuralSimilarityIsAsDefined) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  constexpr int kWidth = 23, kHeight = 17;
  std::vector<double> a, b, c;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    a.push_back(0.5 + 0.4 * std::sin(0.1 * i));
    b.push_back(a.back() + 0.1 * (any(random) - 0.5));
    c.push_back(any(random));
  }
  for (const auto& other : {b, c}) {
    const auto value = ssim(a, other, kWidth);
    ASSERT_TRUE(value);
    EXPECT_NEAR(*value, ssim_by_definition(a, other, kWidth), 1e-10);
    EXPECT_LT(*value, 1.0);
  }
  EXPECT_DOUBLE_EQ(*ssim(a, a, kWidth), 1.0);
  EXPECT_GT(*ssim(a, b, kWidth), *ssim(a, c, kWidth));
  EXPECT_FALSE(ssim(std::vector<double>(10 * 30), std::vector<double>(10 * 30), 10));
}

}  // namespace
}  // namespace raygate::lab
