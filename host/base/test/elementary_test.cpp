// Compares elementary functions with MPFR, for many arguments and at the ends of their ranges.
#include "host/base/elementary.h"

#include <gtest/gtest.h>
#include <mpfr.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <vector>

namespace raygate {
namespace {

/// A number with 200 significant bits.
class Exact {
 public:
  explicit Exact(double x) {
    mpfr_init2(value_, 200);
    mpfr_set_d(value_, x, MPFR_RNDN);
  }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  ~Exact() { mpfr_clear(value_); }
  mpfr_ptr get() { return value_; }
  /// Returns the magnitude of x minus this number. Overwrites this number.
  double error_of(double x) {
    mpfr_d_sub(value_, x, value_, MPFR_RNDN);
    return std::abs(mpfr_get_d(value_, MPFR_RNDN));
  }
  [[nodiscard]] double rounded() const { return mpfr_get_d(value_, MPFR_RNDN); }

 private:
  mpfr_t value_;
};

class Elementary : public testing::Test {
 protected:
  /// Returns numbers of [low, high], some evenly spread, some close to `around`.
  std::vector<double> numbers(double low, double high, double around) {
    std::vector<double> all = {low, high, around};
    std::uniform_real_distribution<double> uniform(low, high), exponent(-60.0, 0.0);
    for (int i = 0; i < 200000; ++i) {
      all.push_back(uniform(engine_));
      const double near = around + std::copysign(std::exp2(exponent(engine_)), uniform(engine_));
      if (near >= low && near <= high) all.push_back(near);
    }
    return all;
  }

  std::mt19937_64 engine_{7};
};

TEST_F(Elementary, SinesAndCosines) {
  double worst = 0.0;
  for (const double turns : numbers(-900.0, 900.0, 0.0)) {
    const SineCosine<double> found = sine_cosine(turns);
    Exact sine(turns), cosine(turns);
    Exact pi(0.0);
    mpfr_const_pi(pi.get(), MPFR_RNDN);
    mpfr_mul_ui(pi.get(), pi.get(), 2, MPFR_RNDN);
    mpfr_mul(sine.get(), sine.get(), pi.get(), MPFR_RNDN);
    mpfr_sin_cos(sine.get(), cosine.get(), sine.get(), MPFR_RNDN);
    worst = std::max({worst, sine.error_of(found.sine), cosine.error_of(found.cosine)});
  }
  std::cout << "largest error " << worst * 0x1p52 << " 2^-52\n";
  EXPECT_LT(worst, 0x1p-52);
  // Quarters of a turn are exact.
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const SineCosine<double> found = sine_cosine(0.25 * quarter);
    EXPECT_EQ(found.sine, std::round(std::sin(quarter * std::acos(0.0))));
    EXPECT_EQ(found.cosine, std::round(std::cos(quarter * std::acos(0.0))));
  }
}

TEST_F(Elementary, AnglesOfPoints) {
  double worst = 0.0;
  const std::vector<double> all = numbers(-2.0, 2.0, 0.0);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    // Some points are near the axes or the diagonals.
    const auto x = static_cast<float>(i % 3 == 0 ? all[i] * 1e-6 : all[i]);
    const auto y = i % 5 == 0 ? std::nextafter(x, 3.0f) : static_cast<float>(all[i + 1]);
    Exact angle(double{y}), other(double{x}), pi(0.0);
    mpfr_atan2(angle.get(), angle.get(), other.get(), MPFR_RNDN);
    mpfr_const_pi(pi.get(), MPFR_RNDN);
    mpfr_div(angle.get(), angle.get(), pi.get(), MPFR_RNDN);
    mpfr_div_ui(angle.get(), angle.get(), 2, MPFR_RNDN);
    worst = std::max(worst, angle.error_of(turns_of<float>(y, x)));
  }
  std::cout << "largest error " << worst * 0x1p50 << " 2^-50\n";
  EXPECT_LT(worst, 0x1p-50);
  EXPECT_EQ(turns_of<float>(0.0f, 0.0f), 0.0);
  EXPECT_EQ(turns_of<float>(0.0f, 1.0f), 0.0);
  EXPECT_EQ(turns_of<float>(0.0f, -1.0f), 0.5);
  EXPECT_EQ(turns_of<float>(1.0f, 0.0f), 0.25);
  EXPECT_EQ(turns_of<float>(-1.0f, -1.0f), -0.375);
}

TEST_F(Elementary, Logarithms) {
  double worst = 0.0;
  std::vector<double> all = numbers(0x1p-30, 4.0, 1.0);
  for (const double x : numbers(-125.9, 125.9, 0.0)) all.push_back(std::exp2(x));
  for (const double x : all) {
    const double found = binary_logarithm(x);
    Exact exact(x);
    mpfr_log2(exact.get(), exact.get(), MPFR_RNDN);
    const double unit = std::max(0x1p-52, 0x1p-50 * std::abs(exact.rounded()));
    worst = std::max(worst, exact.error_of(found) / unit);
  }
  std::cout << "largest error " << worst << " of what is promised\n";
  EXPECT_LT(worst, 1.0);
  for (int exponent = -125; exponent <= 125; ++exponent) {
    EXPECT_EQ(binary_logarithm(std::ldexp(1.0, exponent)), exponent);
  }
}

TEST_F(Elementary, PowersOfTwo) {
  double worst = 0.0;
  for (const double x : numbers(-125.9, 127.4, 0.0)) {
    const double found = binary_power(x);
    Exact exact(x);
    mpfr_exp2(exact.get(), exact.get(), MPFR_RNDN);
    const double value = exact.rounded();
    worst = std::max(worst, exact.error_of(found) / value);
  }
  std::cout << "largest error " << worst * 0x1p52 << " 2^-52 of itself\n";
  EXPECT_LT(worst, 0x1p-50);
  for (const double x : {-126.01, -1e3, -1e9, -1e30}) EXPECT_EQ(binary_power(x), 0.0) << x;
  EXPECT_EQ(binary_power(0.0), 1.0);
  EXPECT_EQ(binary_power(-3.0), 0.125);
}

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

/// Compares codes of linear values with the standard's formula, computed in double on a fine grid.
TEST(Srgb, AgreesWithTheForwardFormula) {
  for (int i = 0; i <= 100000; ++i) {
    const float linear = static_cast<float>(i) / 100000.0f;
    const double x = linear;
    const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    // Half a code, and more: the standard's two pieces of the curve differ by 1e-5 where they meet.
    EXPECT_LE(std::abs(linear_to_srgb(linear) - 255 * encoded), 0.5 + 1e-4) << linear;
  }
}

}  // namespace
}  // namespace raygate
