// Work on several threads ends early if an item throws, or if the caller's check throws.
#include "host/base/threads.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace raygate {
namespace {

constexpr std::size_t kItems = 100000;

/// Calls for_each_on_threads, which must throw. Returns the number of items that were begun.
template <class Work>
std::size_t begun_until_error(int threads, const Work& work) {
  std::atomic<std::size_t> begun = 0;
  EXPECT_THROW(for_each_on_threads(threads, kItems,
                                   [&](std::size_t i) {
                                     ++begun;
                                     std::this_thread::sleep_for(std::chrono::microseconds(10));
                                     work(i);
                                   }),
               std::runtime_error);
  return begun;
}

TEST(Threads, AnErrorEndsTheWorkOfAll) {
  EXPECT_LT(begun_until_error(3,
                              [](std::size_t i) {
                                if (i == 10) throw std::runtime_error("an error");
                              }),
            kItems / 10);
}

TEST(Threads, TheCallerEndsWorkAtACheckpoint) {
  int checks = 0;
  const CheckpointScope outer([] { FAIL() << "not the innermost scope"; });
  {
    const CheckpointScope scope([&] {
      if (++checks == 5) throw std::runtime_error("to end the work");
    });
    EXPECT_LT(begun_until_error(3, [](std::size_t) {}), kItems / 10);
    std::jthread([] { checkpoint(); });
  }
  EXPECT_EQ(checks, 5) << "called on another thread, or not called";
}

}  // namespace
}  // namespace raygate
