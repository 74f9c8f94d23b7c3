// Special cases of the rows for hits.
#include "host/trace/hit_table.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/trace/ray_table.h"

namespace raygate {
namespace {

TEST(HitTable, SharesOfCornersAreNeverNegative) {
  const Scene scene = test::scene_of(test::sphere(2));
  const Bvh bvh(scene);
  const HitTable answers(scene, bvh, {HitColumn::kUv}, TableFormat::kBinary);
  test::Random random;
  RayTable block;
  std::vector<RayHit> found;
  for (int i = 0; i < 2000; ++i) {  // at corners and edges, where u, v or 1 - u - v is 0
    const Triangle& aim = scene.triangles[static_cast<std::size_t>(random.below(320))];
    glm::dvec3 target(scene.positions[aim.vertices[0]]);
    if (i % 2 == 0) target = 0.5 * (target + glm::dvec3(scene.positions[aim.vertices[1]]));
    const glm::dvec3 from(random.point(0.5f));
    ASSERT_EQ(block.add(from, target - from, std::numeric_limits<double>::infinity(), {}), nullptr);
    std::vector<NearestHit> hits;
    RayWork work;
    all_hits(bvh, block.rays.back(), block.limits.back(), hits, work);
    for (const NearestHit& hit : hits) found.push_back({static_cast<std::uint32_t>(i), hit});
  }
  ASSERT_GT(found.size(), 1500u);
  std::string bytes;
  answers.append(block, found, bytes);
  int zeros = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 16) {
    double uv[2];
    std::memcpy(uv, bytes.data() + at, 16);
    for (const double share : uv) {
      EXPECT_FALSE(std::signbit(share)) << share;
      zeros += share == 0.0;
    }
    EXPECT_LE(uv[0] + uv[1], 1.0);
    EXPECT_GE(1.0 - uv[0] - uv[1], 0.0);
  }
  EXPECT_GT(zeros, 0);
}

}  // namespace
}  // namespace raygate
