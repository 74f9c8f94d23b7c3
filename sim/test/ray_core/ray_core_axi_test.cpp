// The ray core behind AXI: a picture by writes to its registers, its memory an AXI slave with
// random pauses. Every pixel ends once, and has the answer that ReferenceCore has for the same ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <deque>
#include <map>
#include <random>
#include <vector>

#include "Vray_core_axi.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/pixel_grid.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/core_cases.h"
#include "sim/core_port.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr std::uint64_t kBase = 0x9234'5678'8000'0000;

class RayCoreAxiTest : public testing::Test {
 protected:
  RayCoreAxiTest() {
    model_->reg_awvalid_i = model_->reg_wvalid_i = model_->reg_arvalid_i = 0;
    model_->reg_bready_i = model_->reg_rready_i = 1;
    model_->reg_wstrb_i = 15;
    model_->mem_arready_i = model_->mem_rvalid_i = 0;
    model_->mem_rresp_i = 0;
    model_->ray_valid_i = model_->result_ready_i = 0;
    model_.reset();
  }

  /// A clock of the whole: memory and results too.
  void clock() {
    model_->mem_arready_i = random_() % 4 != 0;
    model_->result_ready_i = random_() % 4 != 0;
    if (model_->mem_rvalid_i == 0 && !beats_.empty() && random_() % 4 != 0) {
      model_->mem_rid_i = beats_.front().id;
      model_->mem_rdata_i = beats_.front().data;
      model_->mem_rlast_i = beats_.front().last;
      model_->mem_rvalid_i = 1;
      beats_.pop_front();
    }
    model_.eval();
    if ((model_->mem_arvalid_o & model_->mem_arready_i) != 0) {
      const std::uint64_t line = (model_->mem_araddr_o - kBase) / 64;
      ASSERT_LT(line, image_.lines().size());
      ASSERT_EQ(model_->mem_arlen_o, 7);
      for (unsigned beat = 0; beat < 8; ++beat) {
        const auto& words = image_.lines()[line].words;
        beats_.push_back({model_->mem_arid_o,
                          std::uint64_t{words[2 * beat + 1]} << 32 | words[2 * beat], beat == 7});
      }
    }
    const bool beat_taken = (model_->mem_rvalid_i & model_->mem_rready_o) != 0;
    const bool ray_taken = (model_->ray_valid_i & model_->ray_ready_o) != 0;
    if ((model_->result_valid_o & model_->result_ready_i) != 0)
      results_.push_back(result_at(*model_));
    model_.clock();
    if (beat_taken) model_->mem_rvalid_i = 0;
    if (ray_taken) model_->ray_valid_i = 0;
  }

  /// The answer: 0, or 2 for what is refused.
  unsigned write(std::uint32_t address, std::uint32_t data) {
    model_->reg_awaddr_i = address;
    model_->reg_wdata_i = data;
    model_->reg_awvalid_i = model_->reg_wvalid_i = 1;
    EXPECT_EQ(model_->reg_awready_o & model_->reg_wready_o, 1);
    clock();
    model_->reg_awvalid_i = model_->reg_wvalid_i = 0;
    clock();
    EXPECT_EQ(model_->reg_bvalid_o, 1);
    return model_->reg_bresp_o;
  }
  void write(std::uint32_t address, const glm::vec3& vector) {
    for (int k = 0; k < 3; ++k) {
      write(address + 4 * static_cast<unsigned>(k), std::bit_cast<std::uint32_t>(vector[k]));
    }
  }

  std::uint32_t read(std::uint32_t address) {
    model_->reg_araddr_i = address;
    model_->reg_arvalid_i = 1;
    clock();
    model_->reg_arvalid_i = 0;
    const std::uint32_t data = model_->reg_rdata_o;
    EXPECT_EQ(model_->reg_rvalid_o, 1);
    clock();
    return data;
  }

  struct Beat {
    std::uint32_t id;
    std::uint64_t data;
    bool last;
  };

  Bvh bvh_{test::scene_of(test::bodies())};
  MemoryImage image_{bvh_};
  std::mt19937 random_{kSeed};
  Model<Vray_core_axi> model_;
  std::deque<Beat> beats_;
  std::vector<CoreResult> results_;
};

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
    write(0x010, 7);
    write(0x024, kHeight << 16 | kWidth);
    write(0x004, 1 | 4);
    for (int n = 0; model_->interrupt_o == 0; ++n) {
      ASSERT_LT(n, 200'000);
      clock();
    }
    EXPECT_TRUE(beats_.empty()) << "memory may change";
    EXPECT_EQ(read(0x008), 0u);
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
      ASSERT_NE(result.kind, CoreResult::Kind::kRest);
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
  const MemoryLine& root = image_.lines()[MemoryImage::kRoot];
  std::vector<std::uint32_t> starts{MemoryImage::kRoot};
  std::uint32_t line = NodeLine(root).base;
  for (const NodeLine::Child& child : NodeLine(root).child) {
    if (child.kind == NodeLine::kInner) starts.push_back(line);
    line += child.size();
  }
  ASSERT_GT(starts.size(), 1u);
  test::Random random;
  std::vector<CoreRay> rays;
  for (const Ray& ray : test::some_rays(test::bodies(), random, 1'000)) {
    CoreRay& sent = rays.emplace_back(CoreRay{.ray = ray});
    sent.tag = static_cast<std::uint32_t>(rays.size() * 0x00F1'1F05 + 0x8000'0000);
    if (random_() % 4 == 0) sent.t_max = random.uniform(0.01f, 3.0f);
    if (random_() % 4 == 0) sent.skip_id = random_() % bvh_.primitive_count();
    sent.start = starts[random_() % starts.size()];
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

/// Memory that fails is told of.
TEST_F(RayCoreAxiTest, AnErrorOfMemoryRaisesItsFlag) {
  write(0x014, static_cast<std::uint32_t>(kBase));
  write(0x018, static_cast<std::uint32_t>(kBase >> 32));
  write(0x020, 0u);
  write(0x030, glm::vec3(0.0f, 0.0f, 2.5f));
  write(0x040, glm::vec3(0.0f, 0.0f, -1.0f));
  write(0x050, glm::vec3(0.01f, 0.0f, 0.0f));
  write(0x060, glm::vec3(0.0f, 0.01f, 0.0f));
  write(0x00C, 4);
  model_->mem_rresp_i = 2;
  write(0x024, 1u << 16 | 1u);
  write(0x004, 1);
  for (int n = 0; model_->interrupt_o == 0; ++n) {
    ASSERT_LT(n, 10'000);
    clock();
  }
  EXPECT_EQ(read(0x010) & 4, 4u);
}

}  // namespace
}  // namespace raygate
