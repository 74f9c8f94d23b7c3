#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include "host/exact/expansion.h"
#include "host/exact/test/rational_oracle.h"

namespace raygate {
namespace {

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
