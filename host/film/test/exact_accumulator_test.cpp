// Sums of ExactAccumulator do not depend on the order of additions.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "host/film/film.h"

namespace raygate {
namespace {

std::vector<double> numbers(std::uint32_t seed, int count) {
  std::mt19937 random(seed);
  std::vector<double> all;
  for (int i = 0; i < count; ++i) {
    const double fraction = 1.0 + random() * 0x1p-32;
    const auto exponent = static_cast<int>(random() % 100) - 40;
    all.push_back(std::ldexp(random() % 4 == 0 ? -fraction : fraction, exponent));
  }
  return all;
}

ExactAccumulator sum_of(const std::vector<double>& all) {
  ExactAccumulator sum;
  for (const double number : all) sum.add(number);
  return sum;
}

TEST(ExactAccumulator, DoesNotDependOnTheOrderOrOnWhereItBreaksOff) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    std::vector<double> all = numbers(seed, 60);
    const ExactAccumulator whole = sum_of(all);
    std::mt19937 random(seed);
    std::ranges::shuffle(all, random);
    EXPECT_EQ(sum_of(all), whole);
    ExactAccumulator merged = sum_of({all.begin(), all.begin() + 23});
    merged += sum_of({all.begin() + 23, all.end()});
    EXPECT_EQ(merged, whole);
  }
}

TEST(ExactAccumulator, IsExactWhereADoubleIs) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {  // multiples of 2^-20 below 2^20: a double holds their sums
    double expected = 0.0;
    ExactAccumulator sum;
    for (int k = 0; k < 50; ++k) {
      const double sign = random() % 2 == 0 ? 1.0 : -1.0;
      const double number = std::ldexp(sign * static_cast<double>(random()), -12 - 8);
      expected += number;
      sum.add(number);
    }
    ASSERT_EQ(sum.value(), expected);
  }
}

TEST(ExactAccumulator, CarriesThroughAllWords) {
  ExactAccumulator ones;  // all bits below 1 set
  for (int i = 1; i <= 96; ++i) ones.add(std::ldexp(1.0, -i));
  ExactAccumulator one = ones;
  one.add(0x1p-96);
  EXPECT_EQ(one.value(), 1.0);
  ExactAccumulator least;
  least.add(0x1p-96);
  ones += least;
  EXPECT_EQ(ones, one);
  one.add(-1.0);
  EXPECT_EQ(one, ExactAccumulator());
  one.add(-0x1p-96);
  EXPECT_EQ(one.value(), -0x1p-96);
  one += least;
  EXPECT_EQ(one, ExactAccumulator());
}

TEST(ExactAccumulator, OddNumbers) {
  ExactAccumulator sum;
  sum.add(std::numeric_limits<double>::quiet_NaN());
  sum.add(0.0);
  sum.add(std::numeric_limits<double>::denorm_min());
  sum.add(0x1.fp-97);
  EXPECT_EQ(sum, ExactAccumulator());
  sum.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(sum.value(), 0x1p63);
  for (int i = 0; i < 3; ++i) sum.add(-std::numeric_limits<double>::infinity());
  EXPECT_EQ(sum.value(), -0x1p64);
}

}  // namespace
}  // namespace raygate
