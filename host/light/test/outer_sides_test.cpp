#include <gtest/gtest.h>

#include <numeric>
#include <utility>

#include "host/light/lights.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using test::rectangle, test::scene_of, test::sphere;

/// Of all triangles, in their order, but for the last `others`.
std::vector<OuterSide> sides_of(const std::vector<Corners>& triangles, std::size_t others = 0) {
  const Scene scene = scene_of(triangles);
  const Bvh bvh(scene);
  std::vector<std::uint32_t> primitives(triangles.size());
  for (std::uint32_t primitive = 0; primitive < primitives.size(); ++primitive)
    primitives[bvh.triangle_of(primitive)] = primitive;
  primitives.resize(primitives.size() - others);
  return outer_sides(bvh, primitives);
}

TEST(OuterSides, OfEachSphereAreOutside) {
  std::vector<Corners> all = sphere(1, 1.0f, {0, 0, 0});
  const std::size_t count = all.size();
  for (Corners triangle : sphere(1, 1.0f, {5, 0, 0})) {
    std::swap(triangle[0], triangle[1]);
    all.push_back(triangle);
  }
  const auto sides = sides_of(all);
  ASSERT_EQ(sides.size(), 2 * count);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    ASSERT_EQ(sides[i], i < count ? OuterSide::kAlongNormal : OuterSide::kAgainstNormal);
  }
}

TEST(OuterSides, AreBothOfWhatIsOpen) {
  std::vector<Corners> hole = sphere(1, 1.0f, {0, 0, 0}), torn = hole, full = hole;
  hole.pop_back();
  std::swap(torn[3][0], torn[3][1]);  // one triangle the other way round
  full.push_back({glm::vec3(0.0f), {0.1f, 0, 0}, {0, 0.1f, 0}});
  for (const auto& sides : {sides_of(rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})), sides_of(hole),
                            sides_of(torn), sides_of(full, 1)}) {
    for (const OuterSide side : sides) ASSERT_EQ(side, OuterSide::kBoth);
  }
}

}  // namespace
}  // namespace raygate
