// Compares the emulated arithmetic with the machine's and, in narrow formats, with its definition.
#include "host/variants/arithmetic.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "host/lab/stress/cases.h"
#include "sim/fp/float_cores.h"
#include "sim/fp/vectors.h"

namespace raygate {
namespace {

using lab::Random;

/// Returns a finite float. The exponents of most floats are near each other.
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

/// Expects that `result` is `exact` rounded to `digits` digits: to nearest or towards zero.
void expect_rounded(float result, const mpq_class& exact, int digits, Rounding rounding) {
  if (exact == 0 || !std::isnormal(result)) return;
  const double ulp = std::ldexp(1.0, std::ilogb(result) - digits + 1);
  EXPECT_EQ(std::remainder(static_cast<double>(result), ulp), 0.0);
  const mpq_class off = abs(exact) - abs(mpq_class(result));
  if (rounding == Rounding::kTowardZero) {
    EXPECT_GE(sgn(off), 0);
    EXPECT_LT(off, ulp);
  } else {
    EXPECT_LE(abs(off) * 2, ulp);
  }
}

TEST(Arithmetic, OfFewDigitsRoundsOnce) {
  Random random(2);
  for (const int digits : {12, 16, 24}) {
    for (const Rounding rounding : {Rounding::kNearestEven, Rounding::kTowardZero}) {
      const Arithmetic math{.digits = digits, .rounding = rounding};
      for (int i = 0; i < 20000; ++i) {
        const float a = math.read(static_cast<float>(random.uniform(-2, 2)));
        const float b =
            math.read(std::ldexp(static_cast<float>(random.uniform(1, 2)), random.below(40) - 20));
        const mpq_class x(a), y(b);
        expect_rounded(math.multiply(a, b), x * y, digits, rounding);
        expect_rounded(math.add(a, b), x + y, digits, rounding);
        expect_rounded(math.divide(a, b), x / y, digits, rounding);
      }
    }
  }
}

// The paper's worked example computes 1.75 * 3.3125 / 59.225830078125 etc., truncated to 21 digits.
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

TEST(Arithmetic, RoundedOnceIsTheNearestToTheExactDotProduct) {
  Random random(3);
  for (const int digits : {12, 24}) {
    const Arithmetic math{.digits = digits, .fused = true};
    for (int i = 0; i < 20000; ++i) {
      glm::vec3 a, b;
      for (int k = 0; k < 3; ++k) {
        a[k] = math.read(any_float(random) * 0x1p-60f);
        b[k] = math.read(static_cast<float>(random.uniform(-2, 2)));
      }
      if (random.one_in(2)) {  // the first two products cancel, exactly or nearly
        a.y = -a.x;
        b.y = random.one_in(2) ? b.x : math.read(std::nextafter(b.x, 4.0f));
        a.z = std::ldexp(a.z, -20);
      }
      const mpq_class exact = mpq_class(a.x) * mpq_class(b.x) + mpq_class(a.y) * mpq_class(b.y) +
                              mpq_class(a.z) * mpq_class(b.z);
      expect_rounded(math.dot(a, b), exact, digits, Rounding::kNearestEven);
      if (exact == 0) {
        EXPECT_EQ(math.dot(a, b), 0.0f);
      }
    }
  }
}

/// Compares every bit of every result with the Verilated cores of hw/fp.
TEST(Arithmetic, IsTheHardwares) {
  int compared = 0;
  for (const FloatFormat format : {kBinary32, kBinary16, kBfloat16, kFloat8}) {
    const auto cores = rtl_float_cores(format);
    for (int mode = 0; mode < 5; ++mode) {
      const Arithmetic math{.digits = format.frac_bits + 1,
                            .exponent_bits = format.exp_bits,
                            .rounding = static_cast<Rounding>(mode)};
      for (const FloatOp op : {FloatOp::kAdd, FloatOp::kMul, FloatOp::kDiv}) {
        PairSource pairs(format, op, static_cast<std::uint64_t>(mode));
        for (int i = 0; i < 18000; ++i, ++compared) {
          const OperandPair pair = pairs.next();
          const float a = math.from_word(pair.a), b = math.from_word(pair.b);
          const float result = op == FloatOp::kAdd   ? math.add(a, b)
                               : op == FloatOp::kMul ? math.multiply(a, b)
                                                     : math.divide(a, b);
          const auto mode_name = static_cast<RoundingMode>(mode);
          ASSERT_EQ(math.to_word(result),
                    cores->run(op, pair.a, pair.b, mode_name, Tininess::kAfterRounding).bits)
              << format.exp_bits << " " << format.frac_bits << " mode " << mode << " op "
              << static_cast<int>(op) << std::hex << " " << pair.a << " " << pair.b;
        }
      }
    }
  }
  EXPECT_GT(compared, 1000000);
}

}  // namespace
}  // namespace raygate
