#include "host/base/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace raygate {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(Srgb, KnownPoints) {
  EXPECT_EQ(linear_to_srgb(0.0f), 0);
  EXPECT_EQ(linear_to_srgb(1.0f), 255);
  EXPECT_EQ(linear_to_srgb(0.5f), 188);       // 187.516
  EXPECT_EQ(linear_to_srgb(0.18f), 118);      // 117.650: photographic middle grey
  EXPECT_EQ(linear_to_srgb(0.2140f), 127);    // 127.474
  EXPECT_EQ(linear_to_srgb(0.2159f), 128);    // 128.011
  EXPECT_EQ(linear_to_srgb(0.0031308f), 10);  // 10.315, the end of the straight part
  EXPECT_EQ(linear_to_srgb(0.001f), 3);       // 12.92 * 0.255 = 3.295
}

TEST(Srgb, ClampsWhatNoDisplayCanShow) {
  EXPECT_EQ(linear_to_srgb(-1.0f), 0);
  EXPECT_EQ(linear_to_srgb(-kInfinity), 0);
  EXPECT_EQ(linear_to_srgb(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(linear_to_srgb(1.5f), 255);
  EXPECT_EQ(linear_to_srgb(kInfinity), 255);
  EXPECT_EQ(linear_to_srgb(std::numeric_limits<float>::denorm_min()), 0);
}

TEST(Srgb, IsTheInverseOfTheDecodingOnAllCodes) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(linear_to_srgb(static_cast<float>(srgb_to_linear(code))), code);
  }
}

TEST(Srgb, ChangesCodeHalfwayBetweenTwo) {
  for (int code = 0; code < 255; ++code) {
    const double halfway = srgb_to_linear(code + 0.5);
    auto above = static_cast<float>(halfway);
    if (above < halfway) above = std::nextafter(above, kInfinity);
    EXPECT_EQ(linear_to_srgb(above), code + 1);
    EXPECT_EQ(linear_to_srgb(std::nextafter(above, -kInfinity)), code);
  }
}

/// The formula of the standard in its usual direction, in double, over a fine grid.
TEST(Srgb, AgreesWithTheForwardFormula) {
  for (int i = 0; i <= 100000; ++i) {
    const float linear = static_cast<float>(i) / 100000.0f;
    const double x = linear;
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    // Within half a code; the two published halves of the curve meet to 1e-5 of a code only.
    EXPECT_LE(std::abs(linear_to_srgb(linear) - 255 * encoded), 0.5 + 1e-4) << linear;
  }
}

}  // namespace
}  // namespace raygate
