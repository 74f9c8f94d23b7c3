// No true hit is culled: compares the traversal with an exact test of every triangle.
#include "host/bvh/packet_traversal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "host/bvh/traversal.h"
#include "host/exact/exact.h"
#include "host/exact/test/meshes.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

using test::Random;

/// Sends up to eight rays through the BVH. Expects that a ray visits every triangle that it hits.
/// If `shorten`, hits shorten rays, and one nearest triangle is enough. Returns the number of hits.
int expect_nothing_culled(const Bvh& bvh, const std::vector<Ray>& rays, bool shorten) {
  int found = 0;
  LaneMask left = (1u << rays.size()) - 1;
  while (left != 0) {
    const int octant = octant_of(rays[std::countr_zero(left)].direction);
    PacketTraversal packet(bvh, octant);
    LaneMask lanes = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if ((left >> i & 1) == 0 || octant_of(rays[i].direction) != octant) continue;
      packet.set_ray(static_cast<int>(i), rays[i].origin, rays[i].direction);
      lanes |= 1u << i;
    }
    left &= ~lanes;
    std::vector<std::vector<std::uint32_t>> hits(rays.size());
    std::vector<double> farthest(rays.size(), std::numeric_limits<double>::infinity());
    const auto look_at = [&](const LeafVisit& visit) {
      EXPECT_NE(visit.lanes, 0u);
      EXPECT_EQ(visit.lanes & ~lanes, 0u);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if ((visit.lanes >> i & 1) == 0) continue;
        for (std::uint32_t s = visit.first; s < visit.first + visit.count; ++s) {
          if (!hits_triangle(rays[i], bvh.corners_of(s))) continue;
          hits[i].push_back(s);
          if (!shorten) continue;
          farthest[i] = std::min(farthest[i], hit_distance(rays[i], bvh.corners_of(s)).high);
          packet.set_cutoff(static_cast<int>(i), farthest[i]);
        }
      }
    };
    for (LeafVisits leaf = packet.next_leaf(); leaf.count != 0; leaf = packet.next_leaf()) {
      for (const LeafVisit& visit : leaf) look_at(visit);
    }
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if ((lanes >> i & 1) == 0) continue;
      std::size_t expected = 0;
      std::uint32_t nearest = 0;
      for (std::uint32_t s = 0; s < bvh.primitive_count(); ++s) {
        if (!hits_triangle(rays[i], bvh.corners_of(s))) continue;
        const bool first = expected++ == 0;
        if (first || compare_hits(rays[i], bvh.corners_of(s), bvh.corners_of(nearest)) < 0) {
          nearest = s;
        }
      }
      found += static_cast<int>(expected);
      if (!shorten) {
        EXPECT_EQ(hits[i].size(), expected);
      } else if (expected != 0) {
        bool reached = false;  // whether a triangle at exactly the least distance was visited
        for (const std::uint32_t s : hits[i]) {
          reached |= compare_hits(rays[i], bvh.corners_of(s), bvh.corners_of(nearest)) == 0;
        }
        EXPECT_TRUE(reached);
      }
    }
  }
  return found;
}

/// Returns a ray that is difficult for box tests: along an axis, with tiny components, from a
/// vertex or an edge, or aimed at a vertex or an edge.
Ray hard_ray(Random& random, const std::vector<Corners>& mesh, float size) {
  const Corners& t = mesh[random.below(static_cast<int>(mesh.size()))];
  const Corners& other = mesh[random.below(static_cast<int>(mesh.size()))];
  Ray ray;
  switch (random.below(3)) {
    case 0:
      ray.origin = random.point(1.5f * size);
      break;
    case 1:
      ray.origin = other[0];
      break;
    default:
      ray.origin = glm::mix(other[0], other[1], 0.5f);
      break;
  }
  glm::dvec3 aim = glm::dvec3(t[random.below(3)]);
  if (random.below(2) == 0)
    aim = glm::mix(aim, glm::dvec3(t[random.below(3)]), random.uniform(0, 1));
  glm::dvec3 direction = aim - glm::dvec3(ray.origin);
  if (random.below(3) == 0) {
    const int axis = random.below(3);
    const double kept = direction[axis] == 0.0 ? 1.0 : direction[axis];
    direction = glm::dvec3(0.0);
    direction[axis] = kept;
    if (random.below(2) == 0) {  // almost along the axis
      direction[(axis + 1) % 3] = kept * std::ldexp(random.uniform(), -random.below(149));
    }
  }
  if (direction == glm::dvec3(0.0)) direction = {1.0, 0.0, 0.0};
  ray.direction = scaled_direction(direction);
  return ray;
}

void try_mesh(Random& random, const std::vector<Corners>& mesh, float size, int packets) {
  const Bvh bvh(test::scene_of(mesh));
  int found = 0;
  for (int i = 0; i < packets; ++i) {
    std::vector<Ray> rays;
    for (int lane = 0; lane < kLanes; ++lane) rays.push_back(hard_ray(random, mesh, size));
    found += expect_nothing_culled(bvh, rays, i % 2 == 0);
  }
  EXPECT_GT(found, packets);
}

TEST(PacketTraversal, CullsNoTrueHit) {
  Random random;
  try_mesh(random, test::sphere(2), 1.0f, 3000);
  try_mesh(random, test::box(glm::vec3(-1), glm::vec3(1)), 1.0f, 30000);
  std::vector<Corners> soup;
  for (int i = 0; i < 100; ++i) soup.push_back({random.point(), random.point(), random.point()});
  try_mesh(random, soup, 1.0f, 3000);
}

TEST(PacketTraversal, CullsNoTrueHitAtAnyScale) {
  Random random;
  for (const float size : {1e-43f, 1e-37f, 1e-30f, 1e-18f, 1e18f, 1e30f, 5e37f}) {
    std::vector<Corners> mesh = test::box(glm::vec3(-size), glm::vec3(size));
    for (int i = 0; i < 20; ++i) {
      mesh.push_back({random.point(size), random.point(size), random.point(size)});
    }
    try_mesh(random, mesh, size, 2000);
  }
  const glm::vec3 far(1e6f);
  try_mesh(random, test::box(far - 1.0f, far + 1.0f), 2e6f, 5000);
}

TEST(PacketTraversal, FindsNothingInAnEmptySceneOrWithoutRays) {
  const Bvh empty((Scene()));
  PacketTraversal packet(empty, 0);
  packet.set_ray(0, glm::vec3(0), glm::vec3(1, 0, 0));
  EXPECT_EQ(packet.next_leaf().count, 0u);
  const Bvh bvh(test::scene_of(test::sphere(0)));
  PacketTraversal idle(bvh, 0);
  EXPECT_EQ(idle.next_leaf().count, 0u);
}

}  // namespace
}  // namespace raygate
