// Bins against lists.
#include "host/lab/stress/errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "host/lab/stress/random.h"

namespace raygate::lab {
namespace {

TEST(Errors, EachIsCountedInABinThatEndsJustAboveIt) {
  Random random(1);
  for (const int count : {1, 2, 99, 5000}) {
    Errors errors;
    std::vector<double> list;
    for (int i = 0; i < count; ++i) {
      list.push_back(random.one_in(5) ? 0.0 : random.log_uniform(1e-12, 1e12));
      errors.add(list.back());
    }
    std::ranges::sort(list);
    EXPECT_EQ(errors.max(), list.back());
    auto next = list.begin();
    for (const auto& [end, inside] : errors.bins()) {
      for (std::uint64_t i = 0; i < inside; ++i, ++next) {
        ASSERT_NE(next, list.end());
        EXPECT_LT(*next, end);
        EXPECT_GE(*next * (1.0 + 1.0 / 64), *next == 0.0 ? 0.0 : end * (1.0 - 1e-12));
      }
    }
    EXPECT_EQ(next, list.end());
  }
}

TEST(Errors, NothingAndInfinity) {
  Errors errors;
  EXPECT_TRUE(errors.bins().empty());
  errors.add(std::numeric_limits<double>::infinity());
  ASSERT_EQ(errors.bins().size(), 1u);
  EXPECT_EQ(errors.max(), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace raygate::lab
