// Rooms of perfect mirrors in a white world, traced by the renderer itself: a ray that gets out,
// after whatever number of reflections, brings light.
#include <gtest/gtest.h>

#include <cmath>

#include "host/lab/stress/meshes.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

constexpr int kDepth = 24, kSize = 32, kSamples = 2;

struct Outcome {
  int lit = 0;               // pixels that any light came to
  double rays_a_path = 0.0;  // at most kDepth + 1
};

Outcome look_around(const std::vector<Corners>& walls, const glm::dvec3& eye) {
  Scene scene;
  test::add(scene, walls, test::mirror(1.0f));
  scene.background = glm::vec3(1.0f);
  const Bvh bvh(scene);
  RenderSettings options = test::light(IntegratorKind::kWhitted, kSize, kSize, kSamples);
  options.max_depth = kDepth;
  Outcome outcome;
  RenderStats stats;
  double rays = 0.0;
  const glm::dvec3 ways[] = {{1, 0.1, 0.2},  {-1, 0.2, 0.1}, {0.1, 1, 0.3},
                             {0.2, -1, 0.1}, {0.1, 0.2, 1},  {0.3, 0.1, -1}};
  for (const glm::dvec3& way : ways) {
    const Camera camera = test::camera_at(eye, eye + way, 100.0);
    // Whoever computes the points of hits: where rays begin is decided exactly.
    for (const float point_error : {0.0f, kPointError, std::numeric_limits<float>::max()}) {
      options.point_error = point_error;
      const Film film = render(scene, bvh, camera, options, test::pipeline_model(bvh), stats);
      for (const glm::vec4& color : film.color) outcome.lit += color.r != 0.0f || color.a != 1.0f;
      rays += static_cast<double>(stats.rays) / 3.0;
    }
  }
  outcome.rays_a_path = rays / (std::size(ways) * kSize * kSize * kSamples);
  return outcome;
}

TEST(MirrorRoom, NoRayGetsOutOfClosedRooms) {
  lab::Random random(1);
  const lab::MeshPointer rooms[] = {lab::box(), lab::sphere(1), lab::random_sphere(42, random),
                                    lab::box({glm::dvec3(1), glm::dvec3(900, -700, 800)}),
                                    lab::sphere(1, {glm::dvec3(1, 0.1, 0.02), glm::dvec3(0)})};
  for (const lab::MeshPointer& room : rooms) {
    glm::dvec3 center(0.0);
    for (const Corners& t : room->triangles) center += glm::dvec3(t[0] + t[1] + t[2]) / 3.0;
    center /= static_cast<double>(room->triangles.size());
    const Outcome outcome = look_around(room->triangles, center);
    EXPECT_EQ(outcome.lit, 0);
    EXPECT_GT(outcome.rays_a_path, 0.99 * (kDepth + 1));
  }
}

TEST(MirrorRoom, NoRayGetsOutOfSharpCorners) {
  for (const double angle : {1.0, 0.1, 1e-2, 1e-4, 1e-6}) {
    const Outcome outcome =
        look_around(lab::wedge(angle)->triangles, {0.7, 0.35 * std::tan(angle), 0.2});
    EXPECT_EQ(outcome.lit, 0) << angle;
    EXPECT_GT(outcome.rays_a_path, 2.0) << angle;
  }
}

// The same room with one of its triangles gone: light comes in, so that it would be seen above.
TEST(MirrorRoom, LightComesThroughAHole) {
  auto walls = lab::box()->triangles;
  walls.pop_back();
  EXPECT_GT(look_around(walls, glm::dvec3(0.1)).lit, 1000);
}

}  // namespace
}  // namespace raygate
