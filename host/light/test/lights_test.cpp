// Which rays point at area lights, beside what a ray tracer hits.
#include "host/light/lights.h"

#include <gtest/gtest.h>

#include "host/intersect/cpu/cpu_intersector.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

Triple<float> triple(const glm::vec3& v) { return {v.x, v.y, v.z}; }

TEST(PointAtAreas, AgreesWithTheIntersector) {
  Random random;
  int hits = 0, different = 0, rays = 0;
  for (int round = 0; round < 50; ++round) {
    Scene scene;  // lamps and nothing else: what is hit is one
    add(scene, rectangle(random.point(), random.point(), random.point()), emitter(glm::vec3(1)));
    add(scene, {{random.point(), random.point(), random.point()}}, emitter(glm::vec3(1)));
    const Bvh bvh(scene);
    const Lights lights(scene, bvh);
    CpuIntersector intersector(bvh);
    for (int i = 0; i < 200; ++i, ++rays) {
      const Ray ray{random.point(2.0f), scaled_direction(glm::dvec3(random.point()))};
      NearestHit hit;
      intersector.intersect({&ray, 1}, {}, {&hit, 1});
      const bool is_hit = hit.primitive != NearestHit::kNone;
      hits += is_hit ? 1 : 0;
      different += is_hit != lights.point_at_areas(triple(ray.origin), triple(ray.direction));
    }
  }
  EXPECT_GT(hits, rays / 50);
  EXPECT_LT(different, rays / 1000) << "edges are rounded";
}

TEST(PointAtAreas, LooksAtFewPatchesOnly) {
  Scene scene;
  for (int i = 0; i < 9; ++i) {
    add(scene, rectangle({i, 0, 0}, {1, 0, 0}, {0, 1, 0}), emitter(glm::vec3(1)));
    const Bvh bvh(scene);
    const Lights lights(scene, bvh);
    EXPECT_EQ(lights.point_at_areas<float>({0.5f, 0.5f, 1}, {0, 0, -1}), i < 8) << i;
  }
}

}  // namespace
}  // namespace raygate
