// The ray core behind AXI: a picture by writes to its registers, its memory an AXI slave with
// random pauses. Every pixel ends once, and has the answer that ReferenceCore has for the same ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "Vray_core_axi.h"
#include "sim/test/ray_core/axi_bench.h"

namespace raygate {
namespace {

using test::kBase;
using test::kOtherBase;
using test::kSeed;

class RayCoreAxiTest : public test::AxiBench<Vray_core_axi> {};

TEST_F(RayCoreAxiTest, TwoWritesDrawAPicture) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  constexpr std::uint32_t kWidth = 40, kHeight = 30, kX = 0x2A03, kY = 0x1505;
  const glm::vec3 eye(0.25f, 0.3f, 2.5f);
  const glm::vec3 right(0.03f, 0.001f, 0.0f), down(0.0f, -0.03f, 0.002f);
  const PixelGrid grid{glm::vec3(-0.6f, 0.5f, -1.0f) - float{kX} * right - float{kY} * down, right,
                       down};
  write(0x014, static_cast<std::uint32_t>(kBase));
  write(0x018, static_cast<std::uint32_t>(kBase >> 32));
  write(0x020, kY << 16 | kX);
  write(0x030, eye);
  write(0x040, grid.first);
  write(0x050, grid.right);
  write(0x060, grid.down);
  write(0x00C, 2);
  for (int frame = 0; frame < 2; ++frame) {
    results_.clear();
    write(0x010, 63);
    write(0x024, kHeight << 16 | kWidth);
    // The second one to memory, through a buffer that is read and rewound when it is full.
    use_buffer(frame == 0 ? 0 : 100);
    write(0x00C, RAYGATE_FLAGS_DONE | RAYGATE_FLAGS_FULL);
    write(0x004, 1 | 4);
    int rewound = 0;
    for (int n = 0; (read(RAYGATE_FLAGS) & RAYGATE_FLAGS_DONE) == 0; ++n) {
      ASSERT_LT(n, 200'000);
      if ((read(RAYGATE_FLAGS) & RAYGATE_FLAGS_FULL) == 0) continue;
      ASSERT_EQ(answered_, 100u);
      ASSERT_EQ(read(RAYGATE_STATUS) & RAYGATE_STATUS_WRITING, 0u);
      collect();
      write(RAYGATE_FLAGS, RAYGATE_FLAGS_FULL);
      ++rewound;
    }
    ASSERT_EQ(rewound > 10, frame == 1);
    collect();
    for (int n = 0; read(0x008) != 0; ++n) ASSERT_LT(n, 1'000);
    EXPECT_TRUE(beats_.empty()) << "memory may change";
    EXPECT_EQ(read(0x108), kWidth * kHeight) << "rays";
    EXPECT_GT(read(0x100), kWidth * kHeight) << "clocks";

    std::vector<int> ends(kWidth * kHeight);
    std::vector<std::vector<std::uint32_t>> doubts(ends.size());
    std::size_t doubted = 0, found = 0;
    std::vector<CoreResult> nearest(ends.size());
    for (const CoreResult& result : results_) {
      const std::uint32_t x = (result.tag & 0xFFFF) - kX, y = (result.tag >> 16) - kY;
      ASSERT_LT(x, kWidth);
      ASSERT_LT(y, kHeight);
      const std::size_t pixel = y * kWidth + x;
      ASSERT_EQ(ends[pixel], 0) << "its end is its last";
      if (result.kind == CoreResult::Kind::kDoubt) {
        doubts[pixel].push_back(result.triangle);
        ++doubted;
        continue;
      }
      ++ends[pixel];
      nearest[pixel] = result;
      found += result.found;
    }
    EXPECT_EQ(std::ranges::count(ends, 1), static_cast<long>(ends.size()));
    EXPECT_GT(found, ends.size() / 2);
    EXPECT_EQ(read(0x010) & 1, doubted != 0 ? 1u : 0u);
    ReferenceCore reference;
    int compared = 0;
    for (std::uint32_t pixel = 0; pixel < ends.size(); ++pixel) {
      const glm::vec3 direction = grid.direction(static_cast<std::uint16_t>(kX + pixel % kWidth),
                                                 static_cast<std::uint16_t>(kY + pixel / kWidth));
      const CoreRay ray{.ray = {eye, direction}};
      std::vector<CoreResult> expected;
      reference.trace(image_.lines(), {&ray, 1}, expected);
      if (expected.size() != 1 || !doubts[pixel].empty()) continue;
      ++compared;
      ASSERT_EQ(nearest[pixel].found, expected[0].found) << pixel;
      if (!expected[0].found) continue;
      ASSERT_EQ(nearest[pixel].triangle, expected[0].triangle) << pixel;
      ASSERT_EQ(nearest[pixel].t, expected[0].t) << pixel;
    }
    EXPECT_GT(compared, 600);
  }
}

/// Rays at the port, of all kinds: what their ends say is what the reference says of each alone.
TEST_F(RayCoreAxiTest, RaysAtThePortAreTraced) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  write(0x014, static_cast<std::uint32_t>(kBase));
  write(0x018, static_cast<std::uint32_t>(kBase >> 32));
  test::Random random;
  std::vector<CoreRay> rays;
  for (const Ray& ray : test::some_rays(test::bodies(), random, 1'300)) {
    CoreRay& sent = rays.emplace_back(CoreRay{.ray = ray});
    sent.tag = static_cast<std::uint32_t>(rays.size() * 0x00F1'1F05 + 0x8000'0000);
    if (random_() % 4 == 0) sent.t_max = random.uniform(0.01f, 3.0f);
    if (random_() % 4 == 0) sent.skip_id = random_() % bvh_.primitive_count();
    sent.any_hit = random_() % 8 == 0;
    sent.no_cull = random_() % 16 == 0;
  }
  std::size_t ended = 0, seen = 0;
  auto next = rays.begin();
  std::map<std::uint32_t, std::vector<CoreResult>> words;
  for (int n = 0; ended < rays.size(); ++n) {
    ASSERT_LT(n, 400'000);
    if (next != rays.end() && model_->ray_valid_i == 0 && random_() % 4 != 0)
      put_ray(*model_, *next++);
    clock();
    for (; seen < results_.size(); ++seen) {
      words[results_[seen].tag].push_back(results_[seen]);
      ended += results_[seen].kind == CoreResult::Kind::kEnd;
    }
  }
  ReferenceCore reference;
  int compared = 0, every = 0;
  for (const CoreRay& ray : rays) {
    ASSERT_FALSE(words[ray.tag].empty());
    const CoreResult& end = words[ray.tag].back();
    ASSERT_EQ(end.kind, CoreResult::Kind::kEnd);
    std::vector<CoreResult> expected;
    reference.trace(image_.lines(), {&ray, 1}, expected);
    if (ray.no_cull) {
      ++every;
      if (!ray.any_hit) {
        EXPECT_EQ(end.tests, expected.back().tests);
      }
    }
    if (ray.any_hit || expected.size() != 1 || words[ray.tag].size() != 1) continue;
    ++compared;
    ASSERT_EQ(end.found, expected[0].found);
    if (!end.found) continue;
    ASSERT_EQ(end.triangle, expected[0].triangle);
    ASSERT_EQ(end.t, expected[0].t);
    ASSERT_EQ(end.t_error, expected[0].t_error);
    ASSERT_EQ(end.point, expected[0].point);
  }
  EXPECT_GT(compared, 600);
  EXPECT_GT(every, 20);
  EXPECT_EQ(read(0x108), rays.size()) << "rays";
}

/// A camera that is started while rays of the user's are in the core would take them for its own.
TEST_F(RayCoreAxiTest, ACommandWhileRaysAreInTheCoreIsRefused) {
  write(0x014, static_cast<std::uint32_t>(kBase));
  write(0x018, static_cast<std::uint32_t>(kBase >> 32));
  write(0x024, 2u << 16 | 2u);
  test::Random random;
  unsigned refused = 0;
  std::size_t sent = 0;
  for (const Ray& ray : test::some_rays(test::bodies(), random, 40)) {
    put_ray(*model_, {.ray = ray, .tag = static_cast<std::uint32_t>(sent++)});
    if (sent % 3 == 0) refused += write(0x004, 1) == 2;
    while (model_->ray_valid_i != 0) clock();
  }
  EXPECT_GT(refused, 10u);
  for (int n = 0; (read(0x008) & 2) != 0; ++n) ASSERT_LT(n, 10'000);
  EXPECT_EQ(read(0x108), sent) << "rays, none of the camera's";
  EXPECT_EQ(write(0x004, 1), 0u);
}

/// A line that memory fails to give is told of, by its number and by the ends of the rays that
/// needed it, and is read again by those that come later.
TEST_F(RayCoreAxiTest, AnErrorOfMemoryStaysOne) {
  look();
  write(0x00C, 4);
  for (failing_line_ = 0; failing_line_ < 8; ++failing_line_) {
    const std::uint64_t line = failing_line_;
    draw(20);
    std::size_t errors = 0;
    for (const auto& [pixel, end] : ends_) {
      errors += end.error == CoreResult::Error::kMemory;
      if (end.error != CoreResult::Error::kNone) continue;
      ASSERT_EQ(end.found, reference(image_, pixel).found) << pixel;
    }
    EXPECT_EQ(read(0x010) >> 2, errors != 0 ? 3u : 0u) << "its flags";
    if (line == 0) {
      EXPECT_EQ(errors, ends_.size()) << "the root";
    }
    if (errors != 0) {
      EXPECT_EQ(read(0x028), line);
    }
    failing_line_ = ~std::uint64_t{0};
    draw(20);
    for (const auto& [pixel, end] : ends_) {
      ASSERT_EQ(end.error, CoreResult::Error::kNone);
      ASSERT_EQ(end.found, reference(image_, pixel).found) << pixel;
    }
    failing_line_ = line;
    write(0x004, 2);  // the caches are empty again
  }
}

/// Lines of the memory that was there before are lines no more.
TEST_F(RayCoreAxiTest, AChangedBaseIsAnotherMemory) {
  look();
  draw(30);
  write(0x014, static_cast<std::uint32_t>(kOtherBase));
  write(0x018, static_cast<std::uint32_t>(kOtherBase >> 32));
  draw(30);
  std::size_t found = 0;
  for (const auto& [pixel, end] : ends_) {
    const CoreResult expected = reference(other_image_, pixel);
    ASSERT_EQ(end.found, expected.found) << pixel;
    if (end.found) {
      ASSERT_EQ(end.t, expected.t) << pixel;
    }
    found += end.found;
  }
  EXPECT_GT(found, 100u);
  EXPECT_LT(found, ends_.size());
}

/// A rectangle is done when its own rays have ended, whatever rays come after them.
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

/// A picture that is given up ends within some clocks, and the next one is whole.
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

/// A node that is its own child: as many nodes as memory has lines, and the ray has an error.
TEST_F(RayCoreAxiTest, NodesAreLimitedByTheLinesOfMemory) {
  look();
  write(0x01C, 0xF000'0002u);  // two lines
  EXPECT_EQ(read(0x01C), 2u);
  draw(10);
  std::size_t cycles = 0;
  for (const auto& [pixel, end] : ends_) cycles += end.error == CoreResult::Error::kCycle;
  EXPECT_GT(cycles, 20u);
  write(0x01C, static_cast<std::uint32_t>(image_.lines().size()));
  draw(10);
  for (const auto& [pixel, end] : ends_) ASSERT_EQ(end.error, CoreResult::Error::kNone);
}

/// Memory is read whether results are taken or not: where the stream's user or the buffer's takes
/// none, the core asks for no more tests than it can keep.
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

/// A bridge that does one transaction at a time, as AXI to AHB does.
TEST_F(RayCoreAxiTest, WritesWaitForReadsAndCome) {
  look();
  is_single_ = true;
  use_buffer(10'000);
  trace(300, 50'000);
  for (int n = 0; (read(RAYGATE_STATUS) & RAYGATE_STATUS_TRACING) != 0; ++n) ASSERT_LT(n, 50'000);
  EXPECT_GT(answered_, 400u) << "300 ends, and doubts";
}

/// A full buffer that nobody empties: all lines that were asked for are accepted.
TEST_F(RayCoreAxiTest, AFullBufferStopsNoRead) {
  look();
  use_buffer(4);
  trace(300, 20'000);
  EXPECT_TRUE(beats_.empty());
  EXPECT_EQ(answered_, 4u);
}

/// A frame whose records go to memory, from the random state that a seed gives.
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

/// Results are a function of rays and memory: words that say nothing are zero.
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
