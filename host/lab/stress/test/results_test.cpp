// Rows as they are written and printed, and the verdict on them.
#include "host/lab/results.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "host/base/input_error.h"
#include "host/lab/stress/runner.h"
#include "host/lab/stress/watertight.h"

namespace raygate::lab {
namespace {

class ResultsTest : public testing::Test {
 protected:
  ~ResultsTest() override { std::filesystem::remove_all(folder_); }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("raygate_results_" + std::to_string(getpid()));
  const std::filesystem::path file_ = folder_ / "rows.jsonl";
};

TEST_F(ResultsTest, RowsComeBack) {
  const std::vector<Row> rows = run({&all_suites()[1]}, float_subjects(), {.tests = 20000});
  ASSERT_FALSE(rows[0]["failures"].empty());
  Results results;
  for (const Row& row : rows) results.keep(row);
  results.write(file_);
  std::ifstream in(file_);
  std::string line;
  for (const Row& row : rows) {
    ASSERT_TRUE(std::getline(in, line));
    EXPECT_EQ(Row::parse(line), row);
  }
  EXPECT_FALSE(std::getline(in, line));
}

TEST_F(ResultsTest, AFileIsReplacedAndItsFolderMade) {
  Results results;
  results.keep({{"tests", 7}});
  results.write(file_);
  Results().write(file_);
  EXPECT_EQ(std::filesystem::file_size(file_), 0u);
  EXPECT_THROW(results.write(file_ / "below"), InputError);
}

TEST_F(ResultsTest, ATableHasOneHeadForRowsOfTheSameColumns) {
  testing::internal::CaptureStdout();
  Results results;
  results.add({{"table", "t"}, {"scene", "a"}, {"rays", 12345u}, {"nested", Row::array()}});
  results.add({{"table", "t"}, {"scene", "b"}, {"rays", nullptr}});
  EXPECT_EQ(testing::internal::GetCapturedStdout(),
            "scene               rays       \n"
            "a                      12,345  \n"
            "b                           -  \n");
  EXPECT_EQ(results.rows().size(), 2u);
}

// A run passes only where exact subjects were judged, in tests that were done, and were never
// wrong.
TEST(Verdicts, OfRows) {
  Row row = {{"suite", "a"},
             {"subject", "b"},
             {"exact", true},
             {"spotless", true},
             {"tests", 5},
             {"wrong", 0},
             {"wrong_ties", 0},
             {"escapes", 0},
             {"doubts", 1},
             {"simulated", false},
             {"double_hits", 0},
             {"wrong_nearest", 0},
             {"wrong_tied_nearest", 0},
             {"wrong_order", 0},
             {"seconds", 1.0},
             {"broken_claims", 0}};
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

// The engines pass the public tests; float32 tests of each triangle alone do not.
TEST(Watertight, EnginesAre) {
  bool others_are = true;
  for (const Row& row : watertight_rows({.triangles = 128, .seeds = 1})) {
    if (row["exact"]) {
      EXPECT_TRUE(is_watertight(row)) << row.dump();
    } else {
      others_are = others_are && is_watertight(row);
    }
  }
  EXPECT_FALSE(others_are);
}

}  // namespace
}  // namespace raygate::lab
