// Tests the ray core behind AXI in cases that random traffic (axi_traffic_test) does not cover: end
// and abort of rectangles, reads while results are not taken, reproducible results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "Vray_core_axi.h"
#include "sim/test/ray_core/axi_bench.h"

namespace raygate {
namespace {

class RayCoreAxiTest : public test::AxiBench<Vray_core_axi> {};

/// A rectangle is done when its own rays have ended, even if other rays follow them.
TEST_F(RayCoreAxiTest, ARectangleIsDoneWithItsOwnRays) {
  look();
  write(0x00C, 2);
  write(0x024, 10u << 16 | 10u);
  write(0x004, 1);
  test::Random random;
  const std::vector<Ray> rays = test::some_rays(test::bodies(), random, 1'000);
  std::size_t sent = 0, ended = 0, seen = 0;
  for (int n = 0; model_->interrupt_o == 0; ++n) {
    ASSERT_LT(n, 20'000) << "other rays keep it waiting";
    if (model_->ray_valid_i == 0) {
      put_ray(*model_, {.ray = rays[sent % rays.size()], .tag = 0x8000'0000});
      ++sent;
    }
    clock();
  }
  for (; seen < results_.size(); ++seen) {
    ended += results_[seen].kind == CoreResult::Kind::kEnd && results_[seen].tag < 0x8000'0000;
  }
  EXPECT_EQ(ended, 100u);
  const std::size_t before = results_.size();
  for (int n = 0; n < 2'000; ++n) clock();
  EXPECT_GT(results_.size(), before) << "they go on";
}

/// An aborted picture ends within some clocks, and the next picture is complete.
TEST_F(RayCoreAxiTest, RaysAreGivenUp) {
  look();
  for (int round = 0; round < 5; ++round) {
    results_.clear();
    write(0x00C, 2);
    write(0x010, 15);
    write(0x024, 0xFFFF'FFFF);
    write(0x004, 1);
    for (int n = 0; n < 500 + 97 * round; ++n) clock();
    EXPECT_EQ(write(0x004, 8), 0u);
    for (int n = 0; model_->interrupt_o == 0; ++n) {
      ASSERT_LT(n, 2'000);
      clock();
    }
    std::size_t given_up = 0, traced = 0;
    for (const CoreResult& result : results_) {
      if (result.kind != CoreResult::Kind::kEnd) continue;
      given_up += result.error == CoreResult::Error::kAbort;
      traced += result.error == CoreResult::Error::kNone;
    }
    EXPECT_GT(given_up, 10u);
    EXPECT_GT(traced, 10u);
    EXPECT_EQ(read(0x010) >> 3, 1u);
    draw(20);
    for (const auto& [pixel, end] : ends_) {
      ASSERT_EQ(end.error, CoreResult::Error::kNone);
      ASSERT_EQ(end.found, reference(image_, pixel).found) << pixel;
    }
  }
}

/// Even if no results are taken from the stream, the core accepts all lines that it requested: it
/// starts a test only if it has room for the result.
TEST_F(RayCoreAxiTest, ReadsDoNotWaitForResults) {
  look();
  takes_results_ = false;
  trace(300, 20'000);
  EXPECT_TRUE(results_.empty());
  EXPECT_TRUE(beats_.empty()) << "lines that were asked for and not accepted";
  takes_results_ = true;
  trace(300, 50'000);
  const auto is_doubt = [](const CoreResult& result) {
    return result.kind == CoreResult::Kind::kDoubt;
  };
  EXPECT_GT(std::ranges::count_if(results_, is_doubt), 100);
}

/// Memory behind a bridge that handles one transaction at a time, like an AXI-to-AHB bridge.
TEST_F(RayCoreAxiTest, WritesWaitForReadsAndCome) {
  look();
  is_single_ = true;
  use_buffer(10'000);
  trace(300, 50'000);
  for (int n = 0; (read(RAYGATE_STATUS) & RAYGATE_STATUS_TRACING) != 0; ++n) ASSERT_LT(n, 50'000);
  EXPECT_GT(answered_, 400u) << "300 ends, and doubts";
}

/// With a full buffer that is never emptied, the core still accepts all lines that it requested.
TEST_F(RayCoreAxiTest, AFullBufferStopsNoRead) {
  look();
  use_buffer(4);
  trace(300, 20'000);
  EXPECT_TRUE(beats_.empty());
  EXPECT_EQ(answered_, 4u);
}

/// Results of a frame in memory, from the random power-up state of a seed.
class Frame : public RayCoreAxiTest {
 public:
  std::vector<std::uint32_t> words() {
    look();
    use_buffer(10'000);
    write(RAYGATE_SIZE, 20u << 16 | 20u);
    write(RAYGATE_COMMAND, RAYGATE_COMMAND_START);
    for (int n = 0; (read(RAYGATE_FLAGS) & RAYGATE_FLAGS_DONE) == 0; ++n) EXPECT_LT(n, 50'000);
    trace(400, 50'000);
    while ((read(RAYGATE_STATUS) & RAYGATE_STATUS_TRACING) != 0) continue;
    return written_;
  }

 private:
  void TestBody() override {}
};

/// Results depend only on rays and memory: unused words are zero.
TEST(RayCoreAxi, RecordsAreTheSameFromAnyPowerUpState) {
  const char* before = std::getenv("RAYGATE_RANDOM_RESET");
  const std::string seed = before != nullptr ? before : "";
  std::vector<std::uint32_t> frames[2];
  for (const char* state : {"1", "2"}) {
    setenv("RAYGATE_RANDOM_RESET", state, 1);
    frames[*state - '1'] = Frame().words();
  }
  before != nullptr ? setenv("RAYGATE_RANDOM_RESET", seed.c_str(), 1)
                    : unsetenv("RAYGATE_RANDOM_RESET");
  ASSERT_EQ(frames[0].size(), frames[1].size());
  EXPECT_EQ(frames[0], frames[1]);
  int misses = 0, doubts = 0;
  for (auto at = frames[0].begin(); at != frames[0].end(); at += 8) {
    const bool is_doubt = (at[0] & 1) != 0, found = (at[0] & 2) != 0;
    misses += !is_doubt && !found;
    doubts += is_doubt;
    EXPECT_TRUE(found || at[0] >> 5 == 0);
    EXPECT_TRUE(found || is_doubt || at[2] == 0);
    EXPECT_TRUE(!is_doubt || (at[0] == 1 && at[7] == 0));
    EXPECT_TRUE(found || std::all_of(at + 3, at + 7, [](std::uint32_t word) { return word == 0; }));
  }
  EXPECT_GT(misses, 50);
  EXPECT_GT(doubts, 10);
}

}  // namespace
}  // namespace raygate
