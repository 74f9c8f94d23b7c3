#include "host/app/console.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <utility>

namespace raygate {
namespace {

// A file may ask for a list longer than any memory.
TEST(RunGuarded, AListThatIsTooLong) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_guarded([]() -> int { throw std::length_error("vector"); }), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "error: out of memory\n");
}

TEST(Format, Counts) {
  EXPECT_EQ(format_count(0), "0");
  EXPECT_EQ(format_count(999), "999");
  EXPECT_EQ(format_count(1000), "1,000");
  EXPECT_EQ(format_count(123456), "123,456");
  EXPECT_EQ(format_count(18446744073709551615u), "18,446,744,073,709,551,615");
  EXPECT_EQ(format_count(0, "hit"), "0 hits");
  EXPECT_EQ(format_count(1, "hit"), "1 hit");
  EXPECT_EQ(format_count(2000, "hit"), "2,000 hits");
}

TEST(Format, Durations) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  const std::pair<double, const char*> durations[] = {{0.0, "0.00 ms"},
                                                      {0.0001234, "0.12 ms"},
                                                      {0.0123, "12.3 ms"},
                                                      {0.9994, "999 ms"},
                                                      {0.9996, "1.00 s"},
                                                      {9.994, "9.99 s"},
                                                      {9.996, "10.0 s"},
                                                      {59.94, "59.9 s"},
                                                      {59.96, "1 min 00 s"},
                                                      {245.0, "4 min 05 s"},
                                                      {3599.4, "59 min 59 s"},
                                                      {3599.6, "1 h 00 min"},
                                                      {7620.0, "2 h 07 min"},
                                                      {-1.0, "?"},
                                                      {kNan, "?"},
                                                      {kInfinity, "?"}};
  for (const auto& [seconds, text] : durations) EXPECT_EQ(format_duration(seconds), text);
}

TEST(Format, Fixed) {
  EXPECT_EQ(format_fixed(7.0, 2), "7.00");
  EXPECT_EQ(format_fixed(std::numeric_limits<double>::max(), 0).size(), 309u);
}

TEST(Progress, SaysWhatIsDoneAndLeft) {
  EXPECT_EQ(progress_text(0.0, 5.0), "rendering: 0 %");
  EXPECT_EQ(progress_text(0.25, 10.0), "rendering: 25 %, 30.0 s left");
  EXPECT_EQ(progress_text(0.5, 3600.0), "rendering: 50 %, 1 h 00 min left");
  EXPECT_EQ(progress_text(1.5, 10.0), "rendering: 100 %, ? left");
}

}  // namespace
}  // namespace raygate
