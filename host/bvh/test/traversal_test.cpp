// Box queries, compared with a test of every triangle.
#include "host/bvh/traversal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "host/exact/test/meshes.h"

namespace raygate {
namespace {

std::vector<std::uint32_t> primitives_near(const Bvh& bvh, const glm::vec3& low,
                                           const glm::vec3& high) {
  std::vector<std::uint32_t> primitives;
  EXPECT_FALSE(
      any_primitive_near(bvh, low, high, [&](std::uint32_t primitive, const Corners& corners) {
        EXPECT_EQ(corners, bvh.corners_of(primitive));
        primitives.push_back(primitive);
        return false;
      }));
  if (primitives.empty()) return primitives;
  std::size_t left = primitives.size() / 2;
  const auto end = [&](std::uint32_t, const Corners&) { return left-- == 0; };
  EXPECT_TRUE(any_primitive_near(bvh, low, high, end)) << "it can be ended";
  return primitives;
}

TEST(BoxQuery, FindsWhatTouchesAndNothingElse) {
  test::Random random;
  const Bvh bvh(test::scene_of(test::sphere(3)));
  std::vector<std::uint32_t> found;
  std::size_t total = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 p = random.point(), q = p + random.point(0.3f);
    const glm::vec3 low = glm::min(p, q), high = glm::max(p, q);
    found = primitives_near(bvh, low, high);
    std::ranges::sort(found);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
      const Bvh::Corners& t = bvh.corners_of(primitive);
      bool touches = true;
      for (int k = 0; k < 3; ++k) {
        const auto [least, most] = std::minmax({t[0][k], t[1][k], t[2][k]});
        touches = touches && least <= high[k] && low[k] <= most;
      }
      if (touches) expected.push_back(primitive);
    }
    ASSERT_EQ(found, expected);
    total += found.size();
  }
  EXPECT_GT(total, 1000u);
}

// A box that is a vertex touches all triangles around it: boxes are closed.
TEST(BoxQuery, APointTouchesTheTrianglesThatEndThere) {
  const std::vector<Corners> mesh = test::sphere(2);
  const Bvh bvh(test::scene_of(mesh));
  std::vector<std::uint32_t> found;
  for (const Corners& t : mesh) {
    found = primitives_near(bvh, t[0], t[0]);
    EXPECT_GE(found.size(), 5u);
  }
}

TEST(BoxQuery, AnEmptySceneHasNothing) {
  const Bvh bvh(test::scene_of({}));
  std::vector<std::uint32_t> found = {7};
  found = primitives_near(bvh, glm::vec3(-1), glm::vec3(1));
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace raygate
