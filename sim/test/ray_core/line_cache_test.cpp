// line_cache before a memory that answers in any order, with random pauses: each request gets its
// line, once; a line that is on its way is asked for once more only where it will not be kept.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

#include "Vline_cache.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr unsigned kLines = 8;

std::uint32_t content(std::uint32_t line) { return (line + 1) * 2654435761u; }

class LineCacheTest : public testing::Test {
 protected:
  struct Miss {
    unsigned waiter;
    bool alone;
    std::uint32_t line;
  };

  LineCacheTest() {
    model_->invalidate_i = model_->valid_i = model_->miss_ready_i = model_->fill_i = 0;
    model_->ready_i = 0;
    model_.reset();
  }

  /// A clock: a request of `of_8` chances, among `range` lines.
  void clock(unsigned of_8, unsigned range) {
    if (model_->valid_i == 0 && random_() % 8 < of_8) {
      model_->valid_i = 1;
      model_->ray_i = random_() % 16;
      model_->line_number_i = random_() % range;
    }
    model_->miss_ready_i = random_() % 4 != 0;
    model_->ready_i = random_() % 8 != 0;
    if (!filling_ && !asked_.empty() && random_() % 4 == 0) {
      const std::size_t which = random_() % asked_.size();
      fill_ = asked_[which];
      asked_.erase(asked_.begin() + static_cast<std::ptrdiff_t>(which));
      filling_ = true;
    }
    model_->fill_i = filling_ && model_->ready_i != 0;
    model_->fill_waiter_i = fill_.waiter;
    model_->fill_alone_i = fill_.alone;
    model_->fill_index_i = fill_.line % kLines;
    model_->fill_line_i = content(fill_.line);
    model_.eval();
    const bool taken = (model_->valid_i & model_->ready_o) != 0;
    if ((model_->miss_valid_o & model_->miss_ready_i) != 0) {
      ASSERT_TRUE(taken);
      ASSERT_EQ(model_->miss_number_o, model_->line_number_i);
      const Miss miss{model_->miss_waiter_o, model_->miss_alone_o != 0, model_->miss_number_o};
      if (!miss.alone) {
        for (const Miss& other : asked_) ASSERT_TRUE(other.alone || other.line != miss.line);
      }
      alone_ += miss.alone;
      asked_.push_back(miss);
      ++misses_;
    }
    if (taken) {
      ++waiting_[{model_->ray_i, content(model_->line_number_i)}];
      ++requests_;
    }
    if (model_->valid_o != 0) {
      ASSERT_EQ(model_->ready_i, 1);
      const auto request = waiting_.find({model_->ray_o, model_->line_o});
      ASSERT_NE(request, waiting_.end()) << "a line that the ray asked for";
      if (--request->second == 0) waiting_.erase(request);
      ++answers_;
    }
    if (filling_ && model_->fill_done_o != 0) filling_ = false;
    model_.clock();
    if (taken) model_->valid_i = 0;
  }

  void drain() {
    for (int i = 0; i < 2'000; ++i) clock(0, 1);
    ASSERT_EQ(model_->valid_i, 0);
    ASSERT_TRUE(waiting_.empty());
    ASSERT_TRUE(asked_.empty());
    ASSERT_EQ(requests_, answers_);
  }

  Model<Vline_cache> model_;
  std::mt19937 random_{kSeed};
  std::vector<Miss> asked_;
  Miss fill_{};
  bool filling_ = false;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> waiting_;  // requests by ray and content
  unsigned requests_ = 0, answers_ = 0, misses_ = 0, alone_ = 0;
};

TEST_F(LineCacheTest, EveryRequestGetsItsLineOnce) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  for (int part = 0; part < 60; ++part) {
    const unsigned of_8 = 1 + random_() % 8, range = 1u << (1 + random_() % 6);
    for (int i = 0; i < 2'000; ++i) clock(of_8, range);
    if (part % 8 == 0) drain();
  }
  drain();
  EXPECT_GT(requests_, 20'000u);
  EXPECT_GT(alone_, 500u);
  EXPECT_LT(misses_, requests_ * 3 / 4);
}

TEST_F(LineCacheTest, LinesOnTheirWayAreReadOnce) {
  for (int part = 0; part < 200; ++part) {
    model_->invalidate_i = 1;
    model_.clock();
    model_->invalidate_i = 0;
    const unsigned before = misses_, answered = answers_;
    while (answers_ - answered < 50) clock(8, 1);
    drain();
    ASSERT_EQ(misses_ - before, 1u);
  }
}

TEST_F(LineCacheTest, HitsNeedNoMemory) {
  for (int i = 0; i < 2'000; ++i) clock(8, kLines);
  drain();
  EXPECT_EQ(misses_, kLines);
  EXPECT_EQ(alone_, 0u);
}

}  // namespace
}  // namespace raygate
