// What ranks are told without MPI, and failures that reach rank 0.
#include "host/ranks/ranks.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <deque>
#include <mutex>
#include <vector>

#include "host/base/input_error.h"

namespace raygate {
namespace {

/// Threads in the place of processes.
class Post {
 public:
  explicit Post(int count) : boxes_(static_cast<std::size_t>(count)) {}
  void put(int to, Message message) {
    const std::scoped_lock lock(mutex_);
    boxes_[static_cast<std::size_t>(to)].push_back(std::move(message));
  }
  std::optional<Message> take(int of) {
    const std::scoped_lock lock(mutex_);
    auto& box = boxes_[static_cast<std::size_t>(of)];
    if (box.empty()) return std::nullopt;
    Message message = std::move(box.front());
    box.pop_front();
    return message;
  }
  [[nodiscard]] int count() const { return static_cast<int>(boxes_.size()); }

 private:
  std::mutex mutex_;
  std::vector<std::deque<Message>> boxes_;
};

class ThreadRanks : public Ranks {
 public:
  ThreadRanks(Post& post, int index) : post_(post), index_(index) {}
  [[nodiscard]] int index() const override { return index_; }
  [[nodiscard]] int count() const override { return post_.count(); }
  void send(int to, About about, std::string bytes) override {
    post_.put(to, {index_, about, std::move(bytes)});
  }
  [[nodiscard]] std::optional<Message> receive() override {
    auto message = post_.take(index_);
    if (message && message->about == About::kFailure) throw RankFailure(*message);
    return message;
  }

 private:
  Post& post_;
  int index_;
};

TEST(RankGuard, TroubleOfOneReachesRank0) {
  Post post(2);
  ThreadRanks first(post, 0), second(post, 1);
  run_rank(
      second, [] { throw InputError("no memory"); },
      [](const std::exception_ptr&) {
        return Ending{7, "no room"};
      });
  try {
    (void)first.receive();
    ADD_FAILURE();
  } catch (const RankFailure& trouble) {
    EXPECT_EQ(trouble.status(), 7);
    EXPECT_STREQ(trouble.what(), "rank 1: no room");
  }
}

TEST(RankGuard, TheEndOfARunIsNoTrouble) {
  Post post(2);
  ThreadRanks ranks(post, 1);
  run_rank(
      ranks, [] { throw RunIsOver(); },
      [](const std::exception_ptr&) {
        ADD_FAILURE();
        return Ending{};
      });
  EXPECT_FALSE(post.take(0));
}

TEST(Ranks, OneProcessIsAlone) {
  const auto ranks = join_ranks();
  EXPECT_EQ(ranks->index(), 0);
  EXPECT_EQ(ranks->count(), 1);
  EXPECT_GE(ranks->processors(), 1u);
  EXPECT_FALSE(ranks->receive());
}

TEST(Ranks, SeveralWithoutMpiAreRefused) {
  ::setenv("OMPI_COMM_WORLD_SIZE", "1", 1);
  EXPECT_EQ(join_ranks()->count(), 1);
  ::setenv("OMPI_COMM_WORLD_SIZE", "3", 1);
  try {
    (void)join_ranks();
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "found 3 ranks, expected one: this program was built without MPI; "
                 "`make verilate MPI=1` builds it with it");
  }
  ::setenv("OMPI_COMM_WORLD_RANK", "2", 1);
  EXPECT_EXIT((void)join_ranks(), testing::ExitedWithCode(2), "^$") << "one line is enough";
  ::unsetenv("OMPI_COMM_WORLD_RANK");
  ::unsetenv("OMPI_COMM_WORLD_SIZE");
}

TEST(Ranks, ShortMessagesAreRefused) {
  EXPECT_EQ(value_of<int>(bytes_of(7) + "and more"), 7);
  const auto refusal = [](const auto& read) -> std::string {
    try {
      read();
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing refused";
  };
  const std::string line =
      "message of another rank: found 3 bytes, expected at least 4; is it the same program "
      "everywhere?";
  EXPECT_EQ(refusal([] { (void)value_of<int>("abc"); }), line);
  EXPECT_EQ(refusal([] { throw RankFailure({1, About::kFailure, "abc"}); }), line);
}

}  // namespace
}  // namespace raygate
