// Quantiles against sorted lists.
#include "host/lab/stress/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "host/lab/stress/random.h"

namespace raygate::stress {
namespace {

TEST(Errors, QuantilesAreThoseOfTheListRoundedUp) {
  Random random(1);
  for (const int count : {1, 2, 99, 100, 101, 5000}) {
    Errors errors;
    std::vector<double> list;
    for (int i = 0; i < count; ++i) {
      list.push_back(random.one_in(5) ? 0.0 : random.log_uniform(1e-12, 1e12));
      errors.add(list.back());
    }
    std::ranges::sort(list);
    const Errors::Summary summary = errors.summary();
    EXPECT_EQ(summary.count, list.size());
    EXPECT_EQ(summary.max, list.back());
    for (const auto& [got, rank] : {std::pair(summary.median, (count - 1) / 2),
                                    std::pair(summary.p99, count - 1 - (count - 1) / 100)}) {
      EXPECT_GE(got, list[rank]) << count;
      EXPECT_LE(got, list[rank] * (1.0 + 1.0 / 64)) << count;
    }
  }
}

TEST(Errors, AddUpWhateverTheOrder) {
  Random random(2);
  Errors all, parts[3];
  for (int i = 0; i < 3000; ++i) {
    const double error = random.log_uniform(1e-30, 1e30);
    all.add(error);
    parts[random.below(3)].add(error);
  }
  Errors sum;
  for (const int k : {2, 0, 1}) sum.add(Errors(parts[k].bins(), parts[k].max()));
  EXPECT_EQ(sum.bins(), all.bins());
  EXPECT_EQ(sum.max(), all.max());
}

TEST(Errors, NothingAndInfinity) {
  Errors errors;
  EXPECT_EQ(errors.summary().count, 0u);
  errors.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(errors.summary().median, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace raygate::stress
