// The emulated arithmetic against the machine's, and in narrow formats against its definition.
#include "host/bench/stress/arithmetic.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "host/bench/stress/random.h"

namespace raygate::stress {
namespace {

/// Any finite float, exponents near one another more often than not.
float any_float(Random& random) {
  if (random.one_in(4)) {
    const auto bits = static_cast<std::uint32_t>(random.uniform(0, 0x1p32));
    const auto value = std::bit_cast<float>(bits);
    return std::isfinite(value) ? value : 0.0f;
  }
  return std::ldexp(static_cast<float>(random.uniform(-2, 2)), random.below(20) - 10);
}

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

TEST(Arithmetic, OfAllDigitsIsTheMachines) {
  Random random(1);
  const Arithmetic math;
  for (int i = 0; i < 500000; ++i) {
    const float a = any_float(random), b = any_float(random);
    ASSERT_EQ(bits(math.multiply(a, b)), bits(a * b)) << a << " " << b;
    ASSERT_EQ(bits(math.add(a, b)), bits(a + b)) << a << " " << b;
    if (b != 0.0f) {
      ASSERT_EQ(bits(math.divide(a, b)), bits(a / b)) << a << " " << b;
    }
  }
}

/// `result` is the float of `digits` digits nearest to `exact` (or next towards zero).
void expect_rounded(float result, const mpq_class& exact, int digits, bool truncate) {
  if (exact == 0 || !std::isnormal(result)) return;
  const double ulp = std::ldexp(1.0, std::ilogb(result) - digits + 1);
  EXPECT_EQ(std::remainder(static_cast<double>(result), ulp), 0.0);
  const mpq_class off = abs(exact) - abs(mpq_class(result));
  if (truncate) {
    EXPECT_GE(sgn(off), 0);
    EXPECT_LT(off, ulp);
  } else {
    EXPECT_LE(abs(off) * 2, ulp);
  }
}

TEST(Arithmetic, OfFewDigitsRoundsOnce) {
  Random random(2);
  for (const int digits : {12, 16, 24}) {
    for (const bool truncate : {false, true}) {
      const Arithmetic math{.digits = digits, .truncate = truncate};
      for (int i = 0; i < 20000; ++i) {
        const float a = math.read(static_cast<float>(random.uniform(-2, 2)));
        const float b =
            math.read(std::ldexp(static_cast<float>(random.uniform(1, 2)), random.below(40) - 20));
        const mpq_class x(a), y(b);
        expect_rounded(math.multiply(a, b), x * y, digits, truncate);
        expect_rounded(math.add(a, b), x + y, digits, truncate);
        expect_rounded(math.divide(a, b), x / y, digits, truncate);
      }
    }
  }
}

// The paper's worked example: 21 digits, cut off. 1.75 * 3.3125 / 59.225830078125.
TEST(Arithmetic, QuotientsOfThePaper) {
  const Arithmetic math{.quotient_digits = 21};
  EXPECT_EQ(bits(math.divide(5.796875f, 59.225830078125f)), 0x3DC873F8u);
  EXPECT_EQ(bits(math.divide(10.28125f, 59.225830078125f)), 0x3E31C2A0u);
  EXPECT_EQ(bits(math.divide(5.11328125f, 59.225830078125f)), 0x3DB0D090u);
}

TEST(Arithmetic, FlushMakesZerosOfSubnormals) {
  const Arithmetic math{.flush = true};
  EXPECT_EQ(bits(math.read(-0x1p-140f)), bits(-0.0f));
  EXPECT_EQ(math.multiply(0x1p-70f, 0x1p-70f), 0.0f);
  EXPECT_EQ(math.multiply(0x1p-60f, 0x1p-60f), 0x1p-120f);
}

}  // namespace
}  // namespace raygate::stress
