// The simulated exact core has the results of its reference model, bit for bit, under any delays.
// Tests: exact_resolver
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "Vray_core_small_exact.h"
#include "host/exact/exact.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/core_cases.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "sim/core_model.h"

namespace raygate {
namespace {

using test::Random;
using test::some_rays;
using Core = CoreModel<Vray_core_small_exact>;

constexpr CoreSet kExact{.exact = true};

/// The core has four rays, stacks of one group and caches of 16 lines.
class ExactResolverTest : public testing::Test {
 protected:
  /// Returns test::bodies() with a copy after each triangle, with rotated corners: every hit ties.
  static std::vector<Corners> doubled() {
    std::vector<Corners> mesh;
    for (const Corners& corners : test::bodies()) {
      mesh.push_back(corners);
      mesh.push_back({corners[1], corners[2], corners[0]});
    }
    return mesh;
  }

  /// Traces rays; returns their results, indexed by tag. All results must be final (kEnd).
  static std::vector<CoreResult> words(CoreUnit& unit, std::span<const MemoryLine> lines,
                                       std::span<const CoreRay> rays) {
    std::vector<CoreResult> results, words(rays.size());
    unit.trace(lines, rays, results);
    for (const CoreResult& result : results) {
      EXPECT_EQ(result.kind, CoreResult::Kind::kEnd);
      words.at(result.tag) = result;
    }
    return words;
  }

  /// Compares triangle, t, the bound of t's error and P with the reference model's.
  void compare(Core& core, std::vector<CoreRay> rays) {
    for (std::uint32_t i = 0; i < rays.size(); ++i) rays[i].tag = i;
    ReferenceCore reference(ReferenceCore::kStackDepth, true);
    const std::vector<CoreResult> got = words(core, lines_, rays),
                                  expected = words(reference, lines_, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(got[i].error, CoreResult::Error::kNone) << i;
      ASSERT_EQ(got[i].found, expected[i].found) << i;
      if (!got[i].found || rays[i].any_hit) continue;
      ASSERT_EQ(got[i].triangle, expected[i].triangle) << i;
      ASSERT_EQ(got[i].t, expected[i].t) << i;
      ASSERT_EQ(got[i].t_error, expected[i].t_error) << i;
      ASSERT_EQ(got[i].point, expected[i].point) << i;
      found_ += got[i].found;
      without_t_ += got[i].t_error == CoreResult::kNoT;
    }
  }

  std::vector<Corners> mesh_ = doubled();
  Bvh bvh_{test::scene_of(mesh_)};
  std::shared_ptr<const MemoryImage> image_ = std::make_shared<MemoryImage>(bvh_);
  test::FarLines far_{*image_};
  std::span<const MemoryLine> lines_ = far_.lines();
  Random random_;
  int found_ = 0, without_t_ = 0;
};

TEST_F(ExactResolverTest, WordsAreTheReferences) {
  std::vector<CoreRay> rays;
  for (const Ray& ray : some_rays(mesh_, random_, 1'500)) rays.push_back({.ray = ray});
  for (const MemoryTiming& timing :
       {MemoryTiming{.latency = 1},
        MemoryTiming{.latency = 50, .disorder = 100, .not_taken = 64}}) {
    Core core(timing, {.no_ray = 32, .not_taken = timing.not_taken, .seed = 3}, kExact);
    compare(core, rays);
    EXPECT_GT(core.counters().depth_doubts, 1'000u);
    EXPECT_GT(core.counters().exact_clocks, 56'000u);
  }
  EXPECT_GT(found_, 1'500);
  EXPECT_GT(without_t_, 20);
}

TEST_F(ExactResolverTest, LimitsAndFirstHitsAreTheReferences) {
  std::vector<CoreRay> rays;
  for (const Ray& ray : some_rays(mesh_, random_, 2'000)) {
    const Corners& corners =
        mesh_[static_cast<std::size_t>(random_.below(static_cast<int>(mesh_.size())))];
    CoreRay& sent = rays.emplace_back(CoreRay{.ray = ray});
    sent.any_hit = random_.below(4) == 0;
    for (std::uint32_t* const id : {&sent.skip_id, &sent.source_id}) {
      *id = test::kFar + image_->line_of(static_cast<std::uint32_t>(
                             random_.below(static_cast<int>(mesh_.size()))));
    }
    const bool is_hit = hits_triangle(ray, corners);
    sent.t_max =
        is_hit ? static_cast<float>(hit_distance(ray, corners).low) : random_.uniform(0.01f, 3.0f);
    if (is_hit && random_.below(2) == 0) sent.t_max = std::nextafter(sent.t_max, 1e9f);
  }
  std::vector<NearestHit> nearest(rays.size());
  // Half of the limits are next to the distance of the nearest hit.
  for (std::size_t i = 0; i < rays.size(); i += 2) {
    CpuIntersector(bvh_).nearest({&rays[i].ray, 1}, {}, {&nearest[i], 1});
    if (nearest[i].primitive == NearestHit::kNone) continue;
    rays[i].t_max =
        static_cast<float>(hit_distance(rays[i].ray, bvh_.corners_of(nearest[i].primitive)).low);
    for (int n = random_.below(3); n > 0; --n) rays[i].t_max = std::nextafter(rays[i].t_max, 1e9f);
  }
  Core core({.latency = 5}, {.not_taken = 100}, kExact);
  compare(core, rays);
  EXPECT_GT(found_, 250);
}

TEST_F(ExactResolverTest, NearestHitsAreTheCpuIntersectors) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 500);
  std::vector<NearestHit> found(rays.size()), expected(rays.size());
  CoreIntersector intersector(bvh_, image_,
                              std::make_unique<Core>(MemoryTiming{.latency = 20, .disorder = 40},
                                                     CoreStalls{.not_taken = 100}, kExact));
  intersector.nearest(rays, {}, found);
  CpuIntersector(bvh_).nearest(rays, {}, expected);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(found[i].primitive, expected[i].primitive) << i;
  }
  EXPECT_EQ(intersector.counters().exact_inside, 0u);
}

/// Many doubts per ray: rays meet all triangles of a fan at their common corner. Doubts must then
/// wait for room in the queue.
TEST_F(ExactResolverTest, ManyDoubtsOfARayFindRoom) {
  std::vector<Corners> fan;
  for (int n = 0; n < 600; ++n) {
    const auto corner = [&](int k) {
      const double angle = 2.0 * M_PI * k / 200.0;
      return glm::vec3(1.0f, static_cast<float>(std::cos(angle)),
                       static_cast<float>(std::sin(angle)));
    };
    fan.push_back({glm::vec3(1, 0, 0), corner(n), corner(n + 1)});
  }
  const Bvh bvh(test::scene_of(fan));
  const MemoryImage image(bvh);
  std::vector<CoreRay> rays;
  for (std::uint32_t n = 0; n < 20; ++n) {
    rays.push_back({.ray = {glm::vec3(-1, 0.01f * static_cast<float>(n % 3), 0), {}}, .tag = n});
    rays.back().ray.direction =
        scaled_direction(glm::dvec3(1, 0, 0) - glm::dvec3(rays.back().ray.origin));
  }
  Core core({.latency = 5}, {}, kExact);
  std::vector<CoreResult> results;
  core.trace(image.lines(), rays, results);
  int found = 0;
  for (const CoreResult& result : results) {
    NearestHit expected;
    CpuIntersector(bvh).nearest({&rays[result.tag].ray, 1}, {}, {&expected, 1});
    found += result.found && result.triangle == image.line_of(expected.primitive);
  }
  EXPECT_GT(core.counters().edge_doubts, 150u * rays.size());
  EXPECT_GT(found, 0);
}

/// Many long exact decisions about few lines: for a long time no ray ends and nothing is read.
TEST_F(ExactResolverTest, LongWorkIsWaitedFor) {
  std::vector<Corners> fan;
  for (int n = 0; n < 14; ++n) {
    const auto corner = [](int k) {
      const float sign = k % 2 == 0 ? 1.0f : -1.0f;
      return glm::vec3(sign * 0x1.234567p100f, std::ldexp(1.3f, 7 * k - 100), sign * 0x1.77p-90f);
    };
    fan.push_back({glm::vec3(1, 1, 1.5f), corner(n), corner(n + 1)});
  }
  const Bvh bvh(test::scene_of(fan));
  const test::FarLines far{MemoryImage(bvh)};
  lines_ = far.lines();
  Core core({.latency = 5}, {}, kExact);
  compare(core, std::vector<CoreRay>(
                    40, {.ray = {glm::vec3(0x1.1p-100f), scaled_direction({1, 1, 1.5})}}));
}

/// One read in 32 returns an error, even for lines read before, and sometimes rays are aborted.
/// Affected rays report an error; all others have the reference model's hit.
TEST_F(ExactResolverTest, FailedRaysSayWhyAndLeaveNothing) {
  std::vector<CoreRay> rays;
  for (const Ray& ray : some_rays(mesh_, random_, 1'000)) {
    rays.push_back({.ray = ray, .tag = static_cast<std::uint32_t>(rays.size())});
  }
  ReferenceCore reference(ReferenceCore::kStackDepth, true);
  const std::vector<CoreResult> expected = words(reference, lines_, rays);
  CorePort<Vray_core_small_exact> core;
  core.invalidate(lines_.size());
  core.set_read_ready(true);
  std::deque<std::pair<std::uint32_t, std::uint64_t>> reads;  // lines and their tags
  std::size_t sent = 0, ended = 0;
  int compared = 0, broken = 0, aborted = 0;
  for (int clock = 0; ended < rays.size(); ++clock) {
    ASSERT_LT(clock, 3'000'000) << "a ray has not ended";
    if (sent < rays.size() && !core.is_offering()) core.offer(rays[sent++]);
    if (core.take_result(true)) {
      const CoreResult result = core.result();
      ASSERT_EQ(result.kind, CoreResult::Kind::kEnd);
      ++ended;
      broken += result.error == CoreResult::Error::kMemory;
      aborted += result.error == CoreResult::Error::kAbort;
      if (result.error == CoreResult::Error::kNone) {
        ASSERT_EQ(result.found, expected.at(result.tag).found) << result.tag;
        if (result.found) {
          ASSERT_EQ(result.triangle, expected[result.tag].triangle) << result.tag;
        }
        ++compared;
      }
    }
    if (core.is_reading()) reads.emplace_back(core.line(), core.tag());
    if (!reads.empty() && core.has_room()) {
      const auto [line, tag] = reads.front();
      reads.pop_front();
      core.put(lines_[line], random_.below(32) == 0, tag);
    }
    core.model()->abort_i = random_.below(4'096) == 0;
    core.clock();
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(broken, 100);
  EXPECT_GT(aborted, 20);
  EXPECT_GT(core.counters().exact_clocks, 1'000u);
}

TEST_F(ExactResolverTest, ResetsInMidRunLeaveNothing) {
  std::vector<CoreRay> rays;
  for (const Ray& ray : some_rays(mesh_, random_, 200)) rays.push_back({.ray = ray});
  Core core({.latency = 20, .disorder = 100, .not_taken = 64}, {.not_taken = 100}, kExact);
  for (int round = 0; round < 8; ++round) {
    core.abandon(lines_, rays, static_cast<unsigned>(1 + random_.below(3'000)));
  }
  compare(core, rays);
  EXPECT_GT(found_, 20);
}

/// Counters for fixed rays equal recorded values: see RayCoreTest.EventsAreTheRecorded.
TEST_F(ExactResolverTest, EventsAreTheRecorded) {
  Core core({.latency = 20, .disorder = 30, .not_taken = 32}, {}, kExact);
  EXPECT_EQ(test::events(core, lines_, test::fixed_rays(500)),
            (std::vector<std::uint64_t>{203'193, 5'102, 5'139, 7'206, 81'965}));
}

}  // namespace
}  // namespace raygate
