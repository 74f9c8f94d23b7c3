// Compares the exact unit's reference model with host/exact and with integers.
#include <gtest/gtest.h>

#include <cstdlib>

#include "host/lab/stress/test/exact_requests.h"

namespace raygate::lab {
namespace {

/// Returns the number of cases per suite. RAYGATE_STRESS, if set, is the total of all suites.
std::size_t cases_of_a_suite() {
  const char* wanted = std::getenv("RAYGATE_STRESS");
  return wanted == nullptr ? 2000 : std::strtoul(wanted, nullptr, 10) / all_suites().size() + 1;
}

TEST(ReferenceExact, SaysWhatExactArithmeticSays) {
  constexpr std::uint64_t kSeed = 20261124;
  std::size_t hits = 0, ties = 0;
  int most = 0;
  for (const int width : {48, 32, 24}) {
    for (const Suite& suite : all_suites()) {
      if (suite.binary64) continue;
      ExactCases cases(suite, kSeed);
      for (std::size_t done = 0; done < cases_of_a_suite();) {
        for (const auto& [request, hit, order] : cases.next()) {
          const ExactAnswer answer = decide(request, width);
          ASSERT_EQ(answer.hit, hit) << suite.name << ", seed " << kSeed << ", case " << done;
          ASSERT_EQ(answer.order, order) << suite.name << ", seed " << kSeed << ", case " << done;
          hits += hit ? 1 : 0;
          ties += hit && order == 0 && request.against != ExactRequest::Against::kNothing ? 1 : 0;
          most = width == 48 ? std::max(most, answer.clocks) : most;
          ++done;
        }
      }
    }
  }
  EXPECT_GT(hits, cases_of_a_suite());
  EXPECT_GT(ties, cases_of_a_suite() / 20);
  EXPECT_LE(most, 3686);
  RecordProperty("most_clocks", most);
}

/// Checks the clocks that exact_unit's header states for exponents that are close together.
TEST(ReferenceExact, TakesTheClocksItSays) {
  using Against = ExactRequest::Against;
  ExactRequest request{.ray = {{0.1f, 0.2f, -3.0f}, {0.01f, 0.02f, 1.0f}},
                       .triangle = {{{-1, -1, 0}, {1.5f, -1, 0.1f}, {0.1f, 2, 0.2f}}},
                       .limit = 3.0f,
                       .other = {{{-1, -1, 0}, {1.5f, -1, 0.2f}, {0.1f, 2, 0.1f}}}};
  const auto clocks = [&](bool asks_hit, Against against) {
    request.asks_hit = asks_hit;
    request.against = against;
    EXPECT_TRUE(decide(request).hit);
    return decide(request).clocks;
  };
  EXPECT_EQ(clocks(true, Against::kNothing), 72);
  EXPECT_EQ(clocks(false, Against::kLimit), 54);
  EXPECT_EQ(clocks(false, Against::kOther), 92);
  EXPECT_EQ(clocks(true, Against::kOther), 155);
}

}  // namespace
}  // namespace raygate::lab
