// An exact core settles every doubt: its hits are CpuIntersector's, and none of the host's exact
// predicates is asked. The linker gives every call of a predicate to the guards below (--wrap).
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/core_cases.h"
#include "host/intersect/cpu/cpu_intersector.h"

namespace raygate {
namespace {

bool forbidden = false;
int asked = 0;

void ask(const char* predicate) {
  ++asked;
  if (!forbidden) return;
  std::fprintf(stderr, "%s: found a call of an exact predicate, expected none\n", predicate);
  std::abort();
}

}  // namespace
}  // namespace raygate

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" {
#define GUARD(result, wrapped, real, parameters, arguments) \
  result real parameters;                                   \
  result wrapped parameters {                               \
    raygate::ask(#real);                                    \
    return real arguments;                                  \
  }
GUARD(
    bool,
    __wrap__ZN7raygate13hits_triangleERKNS_3RayERKSt5arrayIN3glm3vecILi3EfLNS4_9qualifierE0EEELm3EE,
    __real__ZN7raygate13hits_triangleERKNS_3RayERKSt5arrayIN3glm3vecILi3EfLNS4_9qualifierE0EEELm3EE,
    (const raygate::Ray& ray, const raygate::Corners& triangle), (ray, triangle))
GUARD(
    int,
    __wrap__ZN7raygate12compare_hitsERKNS_3RayERKSt5arrayIN3glm3vecILi3EfLNS4_9qualifierE0EEELm3EESA_,
    __real__ZN7raygate12compare_hitsERKNS_3RayERKSt5arrayIN3glm3vecILi3EfLNS4_9qualifierE0EEELm3EESA_,
    (const raygate::Ray& ray, const raygate::Corners& first, const raygate::Corners& second),
    (ray, first, second))
GUARD(
    int,
    __wrap__ZN7raygate20compare_hit_to_limitERKNS_3RayERKSt5arrayIN3glm3vecILi3EfLNS4_9qualifierE0EEELm3EEf,
    __real__ZN7raygate20compare_hit_to_limitERKNS_3RayERKSt5arrayIN3glm3vecILi3EfLNS4_9qualifierE0EEELm3EEf,
    (const raygate::Ray& ray, const raygate::Corners& triangle, float limit),
    (ray, triangle, limit))
#undef GUARD
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace raygate {
namespace {

using test::Random;
using test::some_rays;

class ExactCoreTest : public testing::Test {
 protected:
  void SetUp() override { asked = 0; }

  /// The core's hits without an exact predicate; then CpuIntersector's are the same.
  void check(const std::vector<Ray>& rays, const RayQuery& query) {
    std::vector<NearestHit> found(rays.size()), expected(rays.size());
    auto unit = std::make_unique<ReferenceCore>(ReferenceCore::kStackDepth, true);
    const ReferenceCore& core = *unit;
    CoreIntersector intersector(bvh_, image_, std::move(unit));
    forbidden = true;
    intersector.intersect(rays, query, found);
    forbidden = false;
    counters_ = core.counters();
    EXPECT_EQ(intersector.counters().exact_inside + intersector.counters().exact_depth, 0u);
    CpuIntersector(bvh_).intersect(rays, query, expected);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (query.any_hit_before.empty()) {
        ASSERT_EQ(found[i].primitive, expected[i].primitive) << i;
      } else {
        ASSERT_EQ(found[i].primitive == NearestHit::kNone,
                  expected[i].primitive == NearestHit::kNone)
            << i;
      }
      hits_ += found[i].primitive != NearestHit::kNone;
    }
  }

  /// The bodies, each triangle twice, its corners in another order: every hit is a tie.
  static std::vector<Corners> doubled() {
    std::vector<Corners> mesh = test::bodies();
    const std::size_t count = mesh.size();
    for (std::size_t i = 0; i < count; ++i) mesh.push_back({mesh[i][1], mesh[i][2], mesh[i][0]});
    return mesh;
  }

  std::vector<Corners> mesh_ = doubled();
  Bvh bvh_{test::scene_of(mesh_)};
  std::shared_ptr<const MemoryImage> image_ = std::make_shared<MemoryImage>(bvh_);
  Random random_;
  CoreCounters counters_;
  int hits_ = 0;
};

TEST_F(ExactCoreTest, NearestHitsAreTheCpuIntersectors) {
  check(some_rays(mesh_, random_, 10'000), {});
  EXPECT_GT(hits_, 9'500);
  EXPECT_GT(counters_.doubts, 1'000u);
  EXPECT_GT(counters_.near_ties, 5'000u);
  EXPECT_GT(counters_.exact_clocks, 56 * counters_.near_ties);
  EXPECT_GT(asked, 5'000) << "the guards see CpuIntersector";
}

TEST_F(ExactCoreTest, LimitsSkippedTrianglesFirstHitsAndSourcesCount) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 5'000);
  std::vector<NearestHit> nearest(rays.size());
  CpuIntersector(bvh_).intersect(rays, {}, nearest);
  std::vector<float> limits;
  std::vector<std::uint32_t> skipped;
  for (const NearestHit& hit : nearest) {
    // Mostly at the hit, within a few floats: on this side of it, on that one, or there.
    float limit = 1.0f;
    if (hit.primitive != NearestHit::kNone) {
      limit =
          static_cast<float>(hit_distance(rays[limits.size()], bvh_.corners_of(hit.primitive)).low);
    }
    for (int n = random_.below(3); n > 0; --n) limit = std::nextafter(limit, 0.0f);
    for (int n = random_.below(3); n > 0; --n) limit = std::nextafter(limit, 2.0f * limit);
    limits.push_back(random_.below(8) == 0 ? std::numeric_limits<float>::infinity() : limit);
    skipped.push_back(
        hit.primitive != NearestHit::kNone && random_.below(2) == 0
            ? hit.primitive
            : static_cast<std::uint32_t>(random_.below(static_cast<int>(mesh_.size()))));
  }
  check(rays, {.t_max = limits});
  EXPECT_GT(hits_, 1'000);
  EXPECT_LT(hits_, 4'500);
  check(rays, {.t_max = limits, .skip_ids = skipped});
  check(rays, {.t_max = limits, .skip_ids = skipped, .any_hit_before = limits});
  std::vector<std::uint32_t> sources;
  for (const Ray& ray : rays) {
    const auto primitive =
        static_cast<std::uint32_t>(random_.below(static_cast<int>(mesh_.size())));
    const bool is_hit = hits_triangle(ray, bvh_.corners_of(primitive));
    sources.push_back(is_hit ? NearestHit::kNone : primitive);
  }
  check(rays, {.t_max = limits, .source_ids = sources});
}

/// A sure hit has t within its bound, whoever settled it; what float32 has no t for says so.
TEST_F(ExactCoreTest, DistancesHoldTheirBounds) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 5'000);
  ReferenceCore core(ReferenceCore::kStackDepth, true);
  int without = 0, with = 0;
  for (const Ray& ray : rays) {
    const CoreRay sent{.ray = ray};
    std::vector<CoreResult> results;
    core.trace(image_->lines(), {&sent, 1}, results);
    ASSERT_EQ(results.size(), 1u) << "one word a ray";
    const CoreResult& end = results[0];
    if (!end.found) continue;
    if (end.t_error == CoreResult::kNoT) {
      EXPECT_EQ(end.t, 0.0f);
      EXPECT_EQ(end.point, glm::vec3(0.0f));
      ++without;
      continue;
    }
    const auto word = std::bit_cast<std::int32_t>(end.t), error = std::int32_t{1} << end.t_error;
    const Interval t = hit_distance(ray, bvh_.corners_of(image_->primitive_at(end.triangle)));
    EXPECT_GT(t.high, std::bit_cast<float>(std::max(word - error, 0)));
    EXPECT_LT(t.low, std::bit_cast<float>(std::min(word + error, 0x7F800000)));
    ++with;
  }
  EXPECT_GT(without, 50);
  EXPECT_GT(with, 3'000);
}

}  // namespace
}  // namespace raygate
