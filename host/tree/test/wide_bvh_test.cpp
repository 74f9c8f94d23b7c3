// The wide tree has the binary tree's slots, each once, within all boxes on the way to it.
#include "host/tree/wide_bvh.h"

#include <gtest/gtest.h>

#include "host/exact/test/meshes.h"

namespace raygate {
namespace {

using test::Random;

struct Walker {
  const Bvh& bvh;
  std::vector<std::uint32_t> slots;

  void walk(std::uint32_t index) {
    const WideBvh::Node& node = bvh.wide().nodes()[index];
    for (int i = 0; i < WideBvh::kWidth; ++i) {
      const WideBvh::Child child = node.child[i];
      if (node.bounds[0][0][i] > node.bounds[1][0][i]) continue;  // absent
      const std::size_t before = slots.size();
      if (child.count == 0) {
        walk(child.first);
      } else {
        EXPECT_LE(child.count, WideBvh::kMaxLeafSize);
        for (std::uint32_t s = child.first; s < child.first + child.count; ++s) slots.push_back(s);
      }
      for (std::size_t s = before; s < slots.size(); ++s) {
        for (const glm::vec3& v : bvh.corners_of(slots[s])) {
          for (int k = 0; k < 3; ++k) {
            EXPECT_LT(node.bounds[0][k][i], v[k]);
            EXPECT_GT(node.bounds[1][k][i], v[k]);
          }
        }
      }
    }
  }
};

void expect_whole(const std::vector<Corners>& mesh) {
  const Bvh bvh(test::scene_of(mesh));
  Walker walker{bvh, {}};
  walker.walk(0);
  ASSERT_EQ(walker.slots.size(), mesh.size());
  std::vector<int> seen(mesh.size(), 0);
  for (const std::uint32_t slot : walker.slots) ++seen[slot];
  for (const int times : seen) EXPECT_EQ(times, 1);
}

TEST(WideBvh, HoldsEverySlotOnce) {
  Random random;
  for (int count = 0; count < 40; ++count) {
    std::vector<Corners> soup;
    for (int i = 0; i < count; ++i)
      soup.push_back({random.point(), random.point(), random.point()});
    expect_whole(soup);
  }
  expect_whole(test::sphere(4));
}

}  // namespace
}  // namespace raygate
