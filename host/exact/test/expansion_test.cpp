// Compares expansions with rational arithmetic, and exact sums with integers.
#include "host/exact/expansion.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include "host/exact/test/rational_oracle.h"

namespace raygate {
namespace {

template <int N>
mpq_class exact(const Expansion<N>& e) {
  mpq_class sum = 0;
  for (int i = 0; i < e.size; ++i) sum += e.parts[i];
  return sum;
}

/// Generates floats up to 2^127. In half of the cases, the exponent is near the previous float's.
class Floats {
 public:
  float operator()() {
    for (;;) {
      auto bits = static_cast<std::uint32_t>(random_());
      if (random_() % 2 == 0) {
        const std::uint32_t exponent = (last_ >> 23 & 0xFF) + static_cast<unsigned>(random_() % 5);
        bits = (bits & 0x807FFFFF) | (exponent & 0xFF) << 23;
      }
      if (random_() % 4 == 0) bits &= 0xFFF00000;
      const auto value = std::bit_cast<float>(bits);
      if (!(std::abs(value) <= 0x1p127f)) continue;
      last_ = bits;
      return value;
    }
  }

 private:
  std::mt19937_64 random_{1};
  std::uint32_t last_ = 0;
};

template <int N>
void expect_well_formed(const Expansion<N>& e) {
  for (int i = 0; i < e.size; ++i) {
    ASSERT_NE(e.parts[i], 0.0);
    if (i > 0) {
      ASSERT_LT(std::abs(e.parts[i - 1]), std::abs(e.parts[i]));
    }
  }
}

TEST(Expansion, AgreesWithRationals) {
  Floats next;
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const float a = next(), b = next(), c = next(), d = next();
    const auto u = exact_difference(a, b), v = exact_difference(i % 3 == 0 ? a : c, d);
    const mpq_class x = mpq_class(a) - mpq_class(b);
    const mpq_class y = mpq_class(i % 3 == 0 ? a : c) - mpq_class(d);
    ASSERT_EQ(exact(u), x);
    ASSERT_EQ(exact(u + v), x + y);
    const auto gap = u * v - v * u;
    const auto product = u * v + u * static_cast<double>(c);
    const mpq_class expected = x * y + x * mpq_class(c);
    ASSERT_EQ(exact(product), expected);
    ASSERT_EQ(product.sign(), sgn(expected));
    ASSERT_EQ(gap.sign(), 0);
    expect_well_formed(product);
    const double near = product.approximate();
    ASSERT_LE(abs(mpq_class(near) - expected), abs(expected) * 0x1p-52);
    zeros += expected == 0 ? 1 : 0;
  }
  EXPECT_GT(zeros, 10);
}

using test::sign_of;

TEST(ExactSum, KeepsWhatADoubleLoses) {
  ExactSum sum;
  EXPECT_EQ(sum.sign(), 0);
  sum.add(0x1p100);
  sum.add(0x1p-100);
  sum.add(-0x1p100);
  EXPECT_EQ(sum.sign(), 1);
  sum.add(-0x1p-99);
  EXPECT_EQ(sum.sign(), -1);
  sum.add(0x1p-100);
  EXPECT_EQ(sum.sign(), 0);
}

TEST(ExactSum, AgreesWithIntegers) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 20000; ++round) {
    ExactSum sum;
    __int128 expected = 0;
    for (int term = 0; term < 12; ++term) {
      const auto mantissa = static_cast<std::int64_t>(random() % 2001) - 1000;
      const int exponent = static_cast<int>(random() % 100);
      sum.add(std::ldexp(static_cast<double>(mantissa), exponent));
      expected += static_cast<__int128>(mantissa) << exponent;
      ASSERT_EQ(sum.sign(), sign_of(expected)) << "round " << round;
    }
  }
}

}  // namespace
}  // namespace raygate
