// Counts Table 1 of the paper: the general form has 9 multiplications, 8 additions and 1 division,
// the proposed form 6, 3 and 1 (44.4 % fewer). The proposed form's three quotients share a divisor.
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
