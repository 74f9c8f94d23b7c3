// What was saved comes back, and only for the same run.
#include "host/lab/stress/saved_outcomes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "host/lab/stress/tally_json.h"

namespace raygate::stress {
namespace {

class SavedOutcomesTest : public testing::Test {
 protected:
  ~SavedOutcomesTest() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("raygate_saved_" + std::to_string(getpid()));
  const std::vector<VariantKind> variants_ = unit_variants();
  const RunOptions options_{.tests = 20000};
};

TEST_F(SavedOutcomesTest, ComeBackBitForBit) {
  const auto outcomes = run({&all_suites()[0]}, variants_, options_, [](const SuiteOutcome&) {});
  const SavedOutcomes saved(folder_, options_, variants_);
  EXPECT_FALSE(saved.load(all_suites()[0]));
  saved.save(outcomes[0]);
  const auto again = saved.load(all_suites()[0]);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->tallies.size(), variants_.size());
  bool any_failure = false;
  for (std::size_t v = 0; v < variants_.size(); ++v) {
    EXPECT_EQ(whole(again->tallies[v]), whole(outcomes[0].tallies[v]));
    any_failure = any_failure || !again->tallies[v].failures.empty();
  }
  EXPECT_TRUE(any_failure);
  EXPECT_EQ(again->seconds, outcomes[0].seconds);
}

TEST_F(SavedOutcomesTest, AreNotTakenForThoseOfAnotherRun) {
  const auto outcomes = run({&all_suites()[0]}, variants_, options_, [](const SuiteOutcome&) {});
  SavedOutcomes(folder_, options_, variants_).save(outcomes[0]);
  EXPECT_FALSE(SavedOutcomes(folder_, {.tests = 20001}, variants_).load(all_suites()[0]));
  EXPECT_FALSE(
      SavedOutcomes(folder_, {.tests = 20000, .seed = 2}, variants_).load(all_suites()[0]));
  EXPECT_FALSE(SavedOutcomes(folder_, options_, float_variants()).load(all_suites()[0]));
  std::ofstream(folder_ / "suite-random.json") << "{\"run\":";
  EXPECT_FALSE(SavedOutcomes(folder_, options_, variants_).load(all_suites()[0]));
}

}  // namespace
}  // namespace raygate::stress
