// Every suite against every subject, a little: what `make stress` does for longer.
#include <gtest/gtest.h>

#include "host/lab/stress/runner.h"

namespace raygate::lab {
namespace {

class Seeded : public testing::TestWithParam<std::size_t> {};

TEST_P(Seeded, ExactSubjectsAreSpotless) {
  const auto subjects = all_subjects();
  const Verdicts verdicts = sum_up(run({&all_suites()[GetParam()]}, subjects, {.tests = 20000}), 1);
  EXPECT_TRUE(verdicts.passed) << all_suites()[GetParam()].name << ": " << verdicts.summary;
}

INSTANTIATE_TEST_SUITE_P(Suites, Seeded, testing::Range(std::size_t{0}, all_suites().size()));

}  // namespace
}  // namespace raygate::lab
