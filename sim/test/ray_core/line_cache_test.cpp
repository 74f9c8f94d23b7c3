// Tests line_cache with a memory that answers in any order, with random pauses. Each demand request
// gets its line or an error, once. Errors are not cached. A line in flight is not requested again.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <vector>

#include "Vline_cache.h"
#include "sim/model.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr unsigned kLines = 16, kSets = 2;

std::uint32_t content(std::uint32_t line) { return (line + 1) * 2654435761u; }

class LineCacheTest : public testing::Test {
 protected:
  struct Miss {
    unsigned place;
    std::uint32_t line;
    bool fails = false;
  };

  LineCacheTest() {
    model_->invalidate_i = model_->valid_i = model_->miss_ready_i = model_->fill_i = 0;
    model_->demand_i = 1;
    model_->ready_i = 0;
    model_.reset();
  }

  /// Returns the n-th line number. The first kLines are 0 to kLines - 1. Each further kLines are
  /// these with one higher bit set, at a position that depends on n / kLines and on `part_`.
  [[nodiscard]] std::uint32_t line(unsigned n) const {
    const unsigned high = n / kLines;
    return n % kLines + (high == 0 ? 0 : kLines << (high + part_) % 24);
  }

  /// Simulates a clock. If no request is offered, offers one with probability of_8 / 8, for one of
  /// the first `range` lines: a demand or, unless all_wanted, a prefetch (which may be withdrawn).
  void clock(unsigned of_8, unsigned range, bool all_wanted = true) {
    if (model_->demand_i == 0 && random_() % 4 == 0) model_->valid_i = 0;
    if (model_->valid_i == 0 && random_() % 8 < of_8) {
      model_->valid_i = 1;
      model_->demand_i = all_wanted || random_() % 2 != 0;
      model_->ray_i = random_() % 16;
      model_->line_number_i = line(random_() % range);
    }
    model_->miss_ready_i = random_() % 4 != 0;
    model_->ready_i = random_() % 8 != 0;
    if (!filling_ && !asked_.empty() && random_() % 8 == 0) {
      const std::size_t which = random_() % asked_.size();
      fill_ = asked_[which];
      asked_.erase(asked_.begin() + static_cast<std::ptrdiff_t>(which));
      filling_ = true;
    }
    model_->fill_i = filling_;
    model_->fill_entry_i = fill_.place;
    model_->fill_line_i = fill_.fails ? ~content(fill_.line) : content(fill_.line);
    model_->fill_error_i = fill_.fails;
    model_.eval();
    const bool taken = (model_->valid_i & model_->ready_o) != 0;
    if (filling_ && model_->fill_i != 0) {
      unsigned targets = 0;
      for (const auto& [request, count] : waiting_) {
        if (request.second == content(fill_.line)) targets += static_cast<unsigned>(count);
      }
      most_targets_ = std::max(most_targets_, targets);
    }
    if ((model_->miss_valid_o & model_->miss_ready_i) != 0) {
      ASSERT_TRUE(model_->miss_number_o == taken_[0] || model_->miss_number_o == taken_[1])
          << "taken before";
      const Miss miss{model_->miss_entry_o, model_->miss_number_o, random_() % 256 < fails_of_256_};
      ASSERT_EQ(miss.place % kSets, miss.line % kSets) << "a place of its set";
      for (const Miss& other : asked_) {
        ASSERT_NE(other.line, miss.line);
        ASSERT_NE(other.place, miss.place);
      }
      asked_.push_back(miss);
      ++misses_;
    }
    if (taken) taken_ = {taken_[1], model_->line_number_i};
    if (taken && model_->demand_i != 0) {
      ++waiting_[{model_->ray_i, content(model_->line_number_i)}];
      ++requests_;
    }
    if (model_->valid_o != 0) {
      ASSERT_EQ(model_->ready_i, 1);
      const std::uint32_t good = model_->error_o != 0 ? ~model_->line_o : model_->line_o;
      const auto request = waiting_.find({model_->ray_o, good});
      ASSERT_NE(request, waiting_.end()) << "a line that the ray asked for, or its error";
      errors_ += model_->error_o;
      if (--request->second == 0) waiting_.erase(request);
      ++answers_;
    }
    if (filling_ && model_->fill_ready_o != 0) filling_ = false;
    model_.clock();
    if (taken) model_->valid_i = 0;
  }

  /// Resets the cache: waiting requests and lines in flight are lost.
  void reset() {
    model_->valid_i = model_->fill_i = 0;
    filling_ = false;
    asked_.clear();
    waiting_.clear();
    answers_ = requests_;
    model_.reset();
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
  std::array<std::uint32_t, 2> taken_{};                            // the last two requests taken
  unsigned fails_of_256_ = 0, errors_ = 0, part_ = 0, requests_ = 0, answers_ = 0, misses_ = 0,
           most_targets_ = 0;
};

TEST_F(LineCacheTest, EveryRequestGetsItsLineOnce) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  for (; part_ < 60; ++part_) {
    const unsigned of_8 = 1 + random_() % 8, range = 1u << (1 + random_() % 6);
    for (int i = 0; i < 2'000; ++i) clock(of_8, range, part_ % 2 == 0);
    if (part_ % 8 == 0) drain();
    if (part_ % 8 == 4) reset();
  }
  drain();
  EXPECT_GT(requests_, 20'000u);
  EXPECT_GE(most_targets_, 5u) << "of one line";
  EXPECT_LT(misses_, requests_ * 3 / 4);
}

/// A line with an error is read again. A line without an error is not.
TEST_F(LineCacheTest, ErrorsAreNotKept) {
  fails_of_256_ = 64;
  for (; part_ < 20; ++part_) {
    for (int i = 0; i < 1'000; ++i) clock(6, 64, part_ % 2 == 0);
  }
  drain();
  EXPECT_GT(errors_, 20u);
  EXPECT_LT(errors_, requests_ / 2);
  fails_of_256_ = 256;
  const unsigned before = misses_;
  model_->invalidate_i = 1;
  model_.clock();
  model_->invalidate_i = 0;
  for (int round = 1; round <= 20; ++round) {
    model_->valid_i = model_->demand_i = 1;
    model_->line_number_i = 5;
    const unsigned answered = answers_;
    while (answers_ == answered) clock(0, 1);
    ASSERT_EQ(misses_ - before, round);
  }
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

/// A demand for a prefetched line, in flight or cached, does not request the line again.
TEST_F(LineCacheTest, LinesThatWereNotWantedAreRead) {
  for (int part = 0; part < 200; ++part) {
    drain();
    model_->invalidate_i = 1;
    model_.clock();
    model_->invalidate_i = 0;
    model_->valid_i = 1;
    model_->demand_i = 0;
    model_->line_number_i = 5;
    const unsigned before = misses_, answered = answers_;
    while (misses_ == before) {
      clock(0, 1);
      if (misses_ == before) model_->valid_i = 1;
    }
    if (part % 2 == 0) drain();
    model_->valid_i = model_->demand_i = 1;
    while (answers_ == answered) clock(0, 1);
    ASSERT_EQ(misses_ - before, 1u);
  }
}

TEST_F(LineCacheTest, HitsNeedNoMemory) {
  for (unsigned line = 0; line < kLines; ++line) {
    model_->valid_i = 1;
    model_->line_number_i = line;
    while (model_->valid_i != 0) clock(0, 1);
  }
  drain();
  EXPECT_EQ(misses_, kLines);
  for (int i = 0; i < 2'000; ++i) clock(8, kLines);
  drain();
  EXPECT_EQ(misses_, kLines);
  model_->valid_i = model_->demand_i = model_->ready_i = 1;
  int clocks = 0;
  for (; model_->valid_o == 0 && clocks < 100; ++clocks, model_->valid_i = 0) model_.clock();
  EXPECT_EQ(clocks, 5) << "the latency in the module's header";
}

}  // namespace
}  // namespace raygate
