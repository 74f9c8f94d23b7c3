// What was kept comes back, and only for the same run.
#include "host/lab/results.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "host/base/input_error.h"
#include "host/lab/stress/runner.h"

namespace raygate::lab {
namespace {

class ResultsTest : public testing::Test {
 protected:
  ~ResultsTest() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("raygate_results_" + std::to_string(getpid()));
  const std::filesystem::path file_ = folder_ / "rows.jsonl";
};

TEST_F(ResultsTest, RowsOfARunComeBack) {
  const auto subjects = float_subjects();
  const auto outcomes =
      run({&all_suites()[1]}, subjects, {.tests = 20000}, [](const SuiteOutcome&) {});
  const std::vector<Row> rows = rows_of(outcomes[0], subjects);
  ASSERT_FALSE(rows[0]["failures"].empty());
  {
    Results results(file_, {{"seed", 1}});
    EXPECT_TRUE(results.rows().empty());
    results.add(rows);
  }
  const Results again(file_, {{"seed", 1}});
  ASSERT_EQ(again.rows().size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row row = rows[i];
    row["run"] = {{"seed", 1}};
    EXPECT_EQ(again.rows()[i], row);
  }
}

TEST_F(ResultsTest, RowsOfAnotherRunAndDamagedOnesDoNot) {
  Results(file_, {{"seed", 1}}).add(Row{{"tests", 7}});
  EXPECT_TRUE(Results(file_, Row{{"seed", 2}}).rows().empty());
  Results(file_, {{"seed", 1}}).add(Row{{"tests", 7}});
  std::ofstream(file_, std::ios::app) << "{\"run\":";
  EXPECT_EQ(Results(file_, Row{{"seed", 1}}).rows().size(), 1u);
  Results(file_).add(Row{{"tests", 7}});
  EXPECT_TRUE(Results(file_, Row{{"seed", 1}}).rows().empty());
  EXPECT_THROW(Results(file_ / "below", Row()), InputError);
}

// A run passes only where exact subjects were judged, in tests that were done, and were never
// wrong.
TEST(Verdicts, OfRows) {
  Row row = {{"suite", "a"},     {"subject", "b"},     {"exact", true},
             {"spotless", true}, {"tests", 5},         {"wrong", 0},
             {"wrong_ties", 0},  {"leaks", 0},         {"doubts", 1},
             {"double_hits", 0}, {"wrong_nearest", 0}, {"wrong_tied_nearest", 0},
             {"wrong_order", 0}, {"seconds", 1.0},     {"broken_claims", 0}};
  const auto verdict = [&](const char* key, const Row& value) {
    Row changed = row;
    changed[key] = value;
    return sum_up(std::vector<Row>{changed}, 1);
  };
  EXPECT_TRUE(verdict("tests", 5).passed);
  EXPECT_FALSE(verdict("tests", 0).passed);
  EXPECT_FALSE(verdict("spotless", false).passed);
  EXPECT_FALSE(verdict("broken_claims", 1).passed);
  EXPECT_FALSE(verdict("exact", false).judged);
  EXPECT_FALSE(sum_up({}, 1).passed);
  EXPECT_NE(verdict("wrong", 3).summary.find("3 wrong"), std::string::npos);
}

}  // namespace
}  // namespace raygate::lab
