#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "host/exact/exact.h"
#include "host/scene/io/ear_clipper.h"

namespace raygate {
namespace {

TEST(PointTree, WithoutPointsHoldsNothing) {
  PointTree tree;
  tree.build({}, 0);
  EXPECT_FALSE(tree.any_in_triangle({glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}));
}

TEST(PointTree, BorderCountsCornersDoNot) {
  const std::array<glm::vec2, 3> triangle{glm::vec2(0, 0), glm::vec2(2, 0), glm::vec2(0, 2)};
  const auto holds = [&](glm::vec2 point) {
    const PointTree::Point points[]{{point, 0}};
    PointTree tree;
    tree.build(points, 1);
    return tree.any_in_triangle(triangle);
  };
  EXPECT_TRUE(holds({0.5f, 0.5f}));
  EXPECT_TRUE(holds({1, 0}));
  EXPECT_TRUE(holds({1, 1}));
  EXPECT_FALSE(holds({2, 0}));
  EXPECT_FALSE(holds({1, 1.0000001f}));
  EXPECT_FALSE(holds({3, 0}));
}

// On a small grid, so that points coincide and lie on borders often; points vanish on the way.
TEST(PointTree, AgreesWithLookingAtAllPoints) {
  std::mt19937 random(3);
  int yes = 0, no = 0;
  for (int round = 0; round < 300; ++round) {
    const int grid = round % 2 ? 8 : 1000;
    const auto point = [&] {
      return glm::vec2(static_cast<float>(random() % grid), static_cast<float>(random() % grid));
    };
    std::vector<PointTree::Point> points(random() % 60);
    for (std::uint32_t i = 0; i < points.size(); ++i) points[i] = {point(), 3 * i};
    PointTree tree;
    tree.build(points, 3 * points.size());
    while (!points.empty()) {
      std::array<glm::vec2, 3> triangle{point(), point(), point()};
      const int orientation = orient2d(triangle[0], triangle[1], triangle[2]);
      if (orientation < 0) std::swap(triangle[0], triangle[1]);
      if (orientation != 0) {
        const bool expected = std::any_of(points.begin(), points.end(), [&](const auto& p) {
          return std::find(triangle.begin(), triangle.end(), p.position) == triangle.end() &&
                 orient2d(triangle[0], triangle[1], p.position) >= 0 &&
                 orient2d(triangle[1], triangle[2], p.position) >= 0 &&
                 orient2d(triangle[2], triangle[0], p.position) >= 0;
        });
        ++(expected ? yes : no);
        ASSERT_EQ(tree.any_in_triangle(triangle), expected) << "round " << round;
      }
      const std::size_t victim = random() % points.size();
      tree.remove(points[victim].id);
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(victim));
    }
  }
  EXPECT_GT(yes, 500);
  EXPECT_GT(no, 500);
}

}  // namespace
}  // namespace raygate
