#include "host/app/progress_bar.h"

#include <gtest/gtest.h>

namespace raygate {
namespace {

TEST(ProgressLine, ShowsWhatIsDoneAndLeft) {
  EXPECT_EQ(progress_line(0.0, 5.0, 80),
            "rendering [>                                       ]   0 %");
  EXPECT_EQ(progress_line(0.25, 10.0, 80),
            "rendering [==========>                             ]  25 %, 30 s left");
  EXPECT_EQ(progress_line(0.5, 3600.0, 80),
            "rendering [====================>                   ]  50 %, 1 h 00 min left");
  EXPECT_EQ(progress_line(1.0, 10.0, 80),
            "rendering [========================================] 100 %, 0 s left");
}

TEST(ProgressLine, FitsEveryTerminal) {
  for (int columns = 1; columns < 200; ++columns) {
    for (const double fraction : {0.0, 0.01, 0.99, 1.0}) {
      EXPECT_LT(progress_line(fraction, 1e5, columns).size(), static_cast<std::size_t>(columns));
    }
  }
  EXPECT_EQ(progress_line(0.5, 4.0, 30), " 50 %, 4 s left");
}

TEST(ProgressLine, TakesFractionsOutOfRange) {
  EXPECT_EQ(progress_line(-0.5, 1.0, 80), progress_line(0.0, 1.0, 80));
  EXPECT_EQ(progress_line(1.5, 1.0, 80), progress_line(1.0, 1.0, 80));
}

}  // namespace
}  // namespace raygate
