// Tests the guarantees of EMBEDDING.md for programs that embed the library.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <new>
#include <random>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <vector>

#include "host/package/raygate.h"

namespace {

// The number of live allocations, and the number of allocations until one fails (negative: never).
std::atomic<std::int64_t> alive = 0, left = -1;

void* allocate(std::size_t size, std::size_t alignment) {
  if (left >= 0 && left-- == 0) throw std::bad_alloc();
  void* const memory =
      std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  ++alive;
  return memory;
}

void release(void* memory) noexcept {
  if (memory != nullptr) --alive;
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { release(memory); }
void operator delete(void* memory, std::size_t) noexcept { release(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { release(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { release(memory); }

namespace raygate {
namespace {

struct Case {
  std::vector<Tracer::Triangle> triangles;
  std::vector<Tracer::Ray> rays;

  explicit Case(std::size_t count) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> any(-1.0f, 1.0f);
    const auto point = [&] { return Tracer::Point{any(random), any(random), any(random)}; };
    for (std::size_t i = 0; i < count; ++i) triangles.push_back({point(), point(), point()});
    for (int i = 0; i < 500; ++i) rays.push_back({point(), point()});
  }
};

/// Returns the triangles of the nearest hits.
std::vector<std::uint32_t> nearest(const Tracer& tracer, const std::vector<Tracer::Ray>& rays) {
  std::vector<Tracer::Hit> hits(rays.size());
  tracer.nearest(rays, hits);
  std::vector<std::uint32_t> triangles;
  for (const Tracer::Hit& hit : hits) triangles.push_back(hit.triangle);
  return triangles;
}

TEST(Embedding, SeveralThreadsAskAtOnce) {
  const Case all(20000);
  const Tracer tracer(all.triangles, 2);
  const std::vector<std::uint32_t> expected = nearest(tracer, all.rays);
  std::atomic<int> wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (int k = 0; k < 20; ++k) wrong += nearest(tracer, all.rays) != expected;
        wrong += nearest(Tracer(all.triangles, 2), all.rays) != expected;
      });
    }
  }
  EXPECT_EQ(wrong, 0);
}

std::ptrdiff_t count_threads() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"), {});
}

TEST(Embedding, LeavesNoThreadBehind) {
  const auto before = count_threads();
  const Case all(20000);
  const Tracer tracer(all.triangles, 8);
  EXPECT_EQ(count_threads(), before);
}

TEST(Embedding, LeavesSignalsAndStreamsAlone) {
  struct Signals {
    sigset_t blocked{};
    std::vector<void (*)(int)> handlers;
    Signals() {
      ::pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
      for (int signal = 1; signal < 32; ++signal) {
        struct sigaction action {};
        ::sigaction(signal, nullptr, &action);
        handlers.push_back(action.sa_handler);
      }
    }
  };
  const Signals before;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const Case all(20000);
  (void)nearest(Tracer(all.triangles, 2), all.rays);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  const Signals after;
  EXPECT_EQ(after.handlers, before.handlers);
  for (int signal = 1; signal < 32; ++signal) {
    EXPECT_EQ(::sigismember(&after.blocked, signal), ::sigismember(&before.blocked, signal));
  }
}

/// Returns whether `work` returns true in a child process.
template <class Work>
bool in_child(const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work() ? 0 : 1);
  int status = -1;
  return child > 0 && ::waitpid(child, &status, 0) == child && status == 0;
}

TEST(Embedding, RefusesUnknownVectors) {
  const char* const vectors = std::getenv("RAYGATE_VECTORS");
  if (vectors != nullptr && std::string_view(vectors) == "foo") {
    const Case all(3000);
    EXPECT_THROW((void)nearest(Tracer(all.triangles), all.rays), std::runtime_error);
    return;
  }
  EXPECT_TRUE(in_child([] {  // repeats this test in a process that has not read the variable yet
    ::setenv("RAYGATE_VECTORS", "foo", 1);
    ::execl("/proc/self/exe", "embedding_test", "--gtest_filter=Embedding.RefusesUnknownVectors",
            "--gtest_brief=1", nullptr);
    return false;
  }));
}

TEST(Embedding, WorksInAChildAfterFork) {
  const Case all(20000);
  const Tracer tracer(all.triangles, 2);
  const std::vector<std::uint32_t> expected = nearest(tracer, all.rays);
  EXPECT_TRUE(in_child([&] {
    return nearest(tracer, all.rays) == expected &&
           nearest(Tracer(all.triangles, 2), all.rays) == expected;
  }));
}

/// Lets each allocation of `work` fail in turn. Expects that `work` then throws std::bad_alloc and
/// frees all its memory. Returns the number of allocations.
template <class Work>
int fail_each(const Work& work) {
  for (int count = 0;; ++count) {
    const std::int64_t before = alive;
    left = count;
    try {
      work();
      left = -1;
      EXPECT_EQ(alive, before);
      return count;
    } catch (const std::bad_alloc&) {
      left = -1;
      EXPECT_EQ(alive, before) << "after allocation " << count;
    }
  }
}

TEST(Embedding, ThrowsAndGivesBackWhereMemoryIsShort) {
  const Case all(3000);
  const Tracer tracer(all.triangles);
  const std::vector<std::uint32_t> expected = nearest(tracer, all.rays);
  std::vector<Tracer::Hit> hits(all.rays.size());
  std::vector<std::uint8_t> is_hit(all.rays.size());
  EXPECT_GT(fail_each([&] { const Tracer another(all.triangles); }), 5);
  const Case many(20000);  // enough for two threads
  EXPECT_GT(fail_each([&] { const Tracer another(many.triangles, 2); }), 5);
  EXPECT_GT(fail_each([&] { tracer.nearest(all.rays, hits); }), 3);
  EXPECT_GT(fail_each([&] { tracer.any(all.rays, is_hit); }), 3);
  EXPECT_GT(fail_each([&] { (void)tracer.all(all.rays[0]); }), 1);
  EXPECT_EQ(nearest(tracer, all.rays), expected);
}

}  // namespace
}  // namespace raygate
