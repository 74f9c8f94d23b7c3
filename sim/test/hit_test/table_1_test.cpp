// Counts Table 1 of the paper, per test: 9 multiplications, 8 additions, 1 division in the general
// form; 6, 3, 1 in the proposed form (44.4 % fewer), whose 3 quotients by one divisor count as 1.
#include <gtest/gtest.h>

#include "sim/table_1_count.h"

namespace raygate {
namespace {

TEST(Table1, GeneralForm) {
  EXPECT_EQ(count_general_form(100), (OperationCount{.multiplications = 900,
                                                     .additions = 800,
                                                     .quotients = 100,
                                                     .divisors = 100,
                                                     .clocks = 10 * 100 + 5}));
}

TEST(Table1, ProposedForm) {
  EXPECT_EQ(count_proposed_form(100), (OperationCount{.multiplications = 600,
                                                      .additions = 300,
                                                      .quotients = 300,
                                                      .divisors = 100,
                                                      .clocks = 7 * 100 + 3}));
}

}  // namespace
}  // namespace raygate
