// A board's small core, behind its link and SDRAM, finds the hits that CpuIntersector finds.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <deque>
#include <thread>
#include <utility>

#include "host/base/input_error.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/linked_core.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/core_cases.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/intersector.h"
#include "sim/model_loader.h"
#include "sim/rtl_core.h"

namespace {

std::atomic<bool> is_broken{false};  // a break was sent and not yet received

}  // namespace

/// Replaces the C library's function. Pseudoterminals carry no breaks; this function passes a break
/// to BoardAtAPort.
extern "C" int tcsendbreak(int /*file*/, int /*duration*/) {
  is_broken = true;
  while (is_broken) std::this_thread::yield();
  return 0;
}

namespace raygate {
namespace {

using test::bodies;
using test::Random;
using test::some_rays;

TEST(BoardCore, HitsAreTheCpuIntersectors) {
  const Bvh bvh{test::scene_of(bodies())};
  Random random;
  const std::vector<Ray> rays = some_rays(bodies(), random, 1'500);
  std::vector<float> limits;
  std::vector<std::uint32_t> ignored;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    limits.push_back(random.uniform(0.01f, 3.0f));
    ignored.push_back(
        static_cast<std::uint32_t>(random.below(static_cast<int>(bvh.primitive_count()))));
  }
  std::unique_ptr<CoreUnit> board = make_rtl_board();
  const CoreUnit& unit = *board;
  CheckIntersector check(
      bvh,
      std::make_unique<CoreIntersector>(bvh, std::make_shared<MemoryImage>(bvh), std::move(board)),
      std::make_unique<CpuIntersector>(bvh));
  std::vector<NearestHit> hits(rays.size());
  check.nearest(rays, {}, hits);
  check.nearest(
      rays, {.t_max = limits, .skip_ids = ignored, .any_hit_before = limits, .with_points = false},
      hits);
  EXPECT_GT(unit.counters().edge_doubts, 0u);
  EXPECT_GT(unit.counters().clocks, 11 * unit.counters().tests);
}

/// Different scenes, one after the other: a board keeps no line of an earlier scene.
TEST(BoardCore, ScenesFollowEachOther) {
  const Bvh one{test::scene_of(bodies())};
  const Bvh other{test::scene_of(test::box(glm::vec3(-0.7f), glm::vec3(0.6f)))};
  Random random;
  std::vector<CoreRay> rays;
  for (const Ray& ray : some_rays(bodies(), random, 300)) {
    rays.push_back({.ray = ray, .tag = static_cast<std::uint32_t>(rays.size())});
  }
  const std::unique_ptr<CoreUnit> board = make_rtl_board();
  for (const Bvh* bvh : {&one, &other, &one}) {
    const MemoryImage image(*bvh);
    std::vector<CoreResult> got, expected;
    board->trace(image.lines(), rays, got);
    ReferenceCore().trace(image.lines(), rays, expected);
    std::vector<bool> is_plain(rays.size(), true), hits(rays.size());
    for (const CoreResult& result : expected) {
      if (result.kind == CoreResult::Kind::kEnd) {
        hits[result.tag] = result.found;
      } else {
        is_plain[result.tag] = false;
      }
    }
    for (const CoreResult& result : got) {
      if (result.kind != CoreResult::Kind::kEnd) is_plain[result.tag] = false;
    }
    int compared = 0;
    for (const CoreResult& result : got) {
      if (result.kind != CoreResult::Kind::kEnd || !is_plain[result.tag]) continue;
      ASSERT_EQ(result.found, hits[result.tag]) << result.tag;
      ++compared;
    }
    EXPECT_GT(compared, 150);
  }
}

/// Link that behaves like a serial port to a busy host: the board's words arrive all at once, after
/// the board has sent the last of them. The host must then not wait for another word.
class BurstLink : public WordLink {
 public:
  bool send(std::uint32_t word) override {
    has_sent_ = true;
    return board_->send(word);
  }
  std::optional<std::uint32_t> receive() override {
    if (came_.empty()) return std::nullopt;
    const std::uint32_t word = came_.front();
    came_.pop_front();
    return word;
  }
  void wait() override {
    if (std::exchange(has_sent_, false)) return board_->wait();
    std::deque<std::uint32_t> words;
    for (int quiet = 0; quiet < 5'000; ++quiet) {
      board_->wait();
      while (const std::optional<std::uint32_t> word = board_->receive()) {
        words.push_back(*word);
        quiet = 0;
      }
    }
    if (words.empty())
      throw std::runtime_error("the host waits for a board that has nothing to do");
    came_ = std::move(words);
  }
  void restart() override {
    board_->restart();
    came_.clear();
  }

 private:
  std::unique_ptr<WordLink> board_{
      load_model<WordLink*()>({"board_core", "the simulated board", 40})()};
  std::deque<std::uint32_t> came_;
  bool has_sent_ = false;
};

TEST(BoardCore, AHostThatHasAllResultsSendsTheNextRays) {
  const Bvh bvh{test::scene_of(bodies())};
  Random random;
  const std::vector<Ray> rays = some_rays(bodies(), random, 3 * kBoardRays);
  CheckIntersector check(
      bvh,
      std::make_unique<CoreIntersector>(
          bvh, std::make_shared<MemoryImage>(bvh),
          std::make_unique<LinkedCore>(std::make_unique<BurstLink>(), kBoardRays)),
      std::make_unique<CpuIntersector>(bvh));
  std::vector<NearestHit> hits(rays.size());
  check.nearest(rays, {}, hits);
}

/// A simulated board behind a pseudoterminal instead of a serial port. The bytes are those that
/// uart_receiver takes and uart_transmitter sends.
class BoardAtAPort {
 public:
  BoardAtAPort() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) {
      throw std::runtime_error("no pseudoterminal");
    }
    board_ = std::thread([this] { run(); });
  }
  BoardAtAPort(const BoardAtAPort&) = delete;
  BoardAtAPort& operator=(const BoardAtAPort&) = delete;
  ~BoardAtAPort() {
    is_over_ = true;
    board_.join();
    close(master_);
  }

  [[nodiscard]] std::string port() const { return ptsname(master_); }

 private:
  void run() {
    const std::unique_ptr<WordLink> link(
        load_model<WordLink*()>({"board_core", "the simulated board", 40})());
    std::vector<unsigned char> in;
    int idle = 0;  // clocks since a byte came or went
    while (!is_over_) {
      unsigned char byte = 0;
      if (is_broken) {
        while (read(master_, &byte, 1) == 1) continue;
        in.clear();
        link->restart();
        is_broken = false;
      }
      // Takes the bytes that have arrived, up to a word.
      while (in.size() < 4 && read(master_, &byte, 1) == 1) in.push_back(byte);
      if (in.size() >= 4 && link->send(in[0] | in[1] << 8 | in[2] << 16 | unsigned{in[3]} << 24)) {
        in.erase(in.begin(), in.begin() + 4);
        idle = 0;
      }
      while (const std::optional<std::uint32_t> word = link->receive()) {
        for (unsigned k = 0; k < 4; ++k) {
          const auto out = static_cast<unsigned char>(*word >> 8 * k);
          while (write(master_, &out, 1) != 1) std::this_thread::yield();
        }
        idle = 0;
      }
      if (++idle < 20'000) {
        link->wait();
      } else {
        pollfd ready{.fd = master_, .events = POLLIN, .revents = 0};
        if (poll(&ready, 1, 10) > 0) idle = 0;
      }
    }
  }

  int master_;
  std::atomic<bool> is_over_{false};
  std::thread board_;
};

/// Behaves like a host that stops within a message, both between words and within a word, with rays
/// in the core. The next host must not be affected.
void leave_a_mess(const std::string& port, std::span<const Ray> rays) {
  const std::unique_ptr<WordLink> link = open_serial_link(port);
  const auto send = [&](const Ray& ray, std::size_t words) {
    const auto message = ray_message({.ray = ray, .tag = 7});
    for (const std::uint32_t word : std::span(message).first(words)) EXPECT_TRUE(link->send(word));
  };
  for (const Ray& ray : rays.first(kBoardRays - 1)) send(ray, ray_message({}).size());
  send(rays.back(), 8);
  while (!link->receive()) link->wait();
  const int file = open(port.c_str(), O_RDWR | O_NOCTTY);
  EXPECT_EQ(write(file, "x", 1), 1);
  usleep(50'000);  // until the board has taken the byte
  close(file);
}

TEST(SerialLink, HitsAreTheCpuIntersectors) {
  const Bvh bvh{test::scene_of(bodies())};
  Random random;
  const std::vector<Ray> rays = some_rays(bodies(), random, 200);
  const BoardAtAPort board;
  for (int opened = 0; opened < 2; ++opened) {
    if (opened != 0) leave_a_mess(board.port(), rays);
    CheckIntersector check(
        bvh,
        std::make_unique<CoreIntersector>(
            bvh, std::make_shared<MemoryImage>(bvh),
            std::make_unique<LinkedCore>(open_serial_link(board.port()), kBoardRays)),
        std::make_unique<CpuIntersector>(bvh));
    std::vector<NearestHit> hits(rays.size());
    check.nearest(rays, {}, hits);
  }
}

TEST(SerialLink, WhatIsNoPortIsAnInputError) {
  EXPECT_THROW((void)open_serial_link("/dev/null"), InputError);
  EXPECT_THROW((void)open_serial_link("/nowhere/ttyUSB0"), InputError);
}

}  // namespace
}  // namespace raygate
