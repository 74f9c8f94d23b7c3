// Films are right in every pixel, and equal for all threads, windows and engines.
#include "host/render/renderer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

RenderSettings size(int width, int height, int threads = 1) {
  RenderSettings options;
  options.width = width;
  options.height = height;
  options.threads = threads;
  options.samples = 1;
  options.integrator = IntegratorKind::kPrimary;
  return options;
}

/// Returns a sphere in a box; the camera is inside the box and sees many edges.
Scene sphere_in_box() {
  std::vector<Corners> mesh = sphere(3);
  const auto walls = box(glm::vec3(-3), glm::vec3(3));
  mesh.insert(mesh.end(), walls.begin(), walls.end());
  Scene scene = scene_of(mesh);
  scene.materials[0].emission = glm::vec3(0.25f, 0, 0);
  return scene;
}

// The eye is on a diagonal and the picture is square: rays run exactly through edges and vertices.
const Camera kCamera =
    Camera::look_at({glm::dvec3(2), glm::dvec3(0), glm::dvec3(0, 0, 1), 60.0}, 1.0);

TEST(Renderer, EveryPixelIsTheExactNearestPolygon) {
  const Scene scene = sphere_in_box();
  const Bvh bvh(scene);
  RenderStats stats;
  const Film film = render(scene, bvh, kCamera, size(65, 65), serial_model(bvh), stats);
  for (int y = 0; y < 65; ++y) {
    for (int x = 0; x < 65; ++x) {
      const Ray ray = {kCamera.eye(), kCamera.direction((x + 0.5) / 65, (y + 0.5) / 65)};
      std::optional<std::uint32_t> nearest;
      for (std::uint32_t i = 0; i < bvh.primitive_count(); ++i) {
        const Corners& t = bvh.corners_of(i);
        if (!hits_triangle(ray, t)) continue;
        if (!nearest || compare_hits(ray, t, bvh.corners_of(*nearest)) < 0) nearest = i;
      }
      ASSERT_TRUE(nearest);
      const std::size_t pixel = std::size_t(y) * 65 + x;
      ASSERT_EQ(film.primitive[pixel], bvh.triangle_of(*nearest)) << x << ", " << y;
      EXPECT_NEAR(glm::length(film.normal[pixel]), 1.0f, 1e-6f);
      EXPECT_LE(glm::dot(film.normal[pixel], ray.direction), 0.0f);
      EXPECT_EQ(film.color[pixel].a, 1.0f);
      EXPECT_GE(film.color[pixel].r, 0.25f);
      EXPECT_TRUE(std::isfinite(film.depth[pixel]));
    }
  }
  EXPECT_EQ(stats.rays, 65u * 65u);
  EXPECT_GT(stats.intersect.exact_inside, 0u);
  EXPECT_GT(stats.intersect.records, 0u);
  EXPECT_FALSE(stats.cancelled);
}

TEST(Renderer, CountsDoNotDependOnThreads) {
  const Scene scene = sphere_in_box();
  const Bvh bvh(scene);
  RenderStats one, other;
  (void)render(scene, bvh, kCamera, size(200, 150), serial_model(bvh), one);
  (void)render(scene, bvh, kCamera, size(200, 150, 8), serial_model(bvh), other);
  EXPECT_EQ(one.intersect.hit.tests, other.intersect.hit.tests);
  EXPECT_EQ(one.intersect.records, other.intersect.records);
}

TEST(Renderer, MissesLeaveNothing) {
  const Scene scene = scene_of({});
  const Bvh bvh(scene);
  RenderStats stats;
  const Film film = render(scene, bvh, kCamera, size(9, 5, 4), serial_model(bvh), stats);
  EXPECT_EQ(film.primitive, std::vector<std::uint32_t>(45, kNoPrimitive));
  EXPECT_EQ(film.depth[0], std::numeric_limits<float>::infinity());
  EXPECT_EQ(film.color[44], glm::vec4(0.0f));
  EXPECT_EQ(stats.intersect.hit.tests, 0u);
}

// A wall straight ahead at distance 2 has its material's colour, and depth 2.
TEST(Renderer, LambertLitFromTheCamera) {
  Scene scene = scene_of({{glm::vec3(-9, -9, -2), glm::vec3(9, -9, -2), glm::vec3(0, 9, -2)}});
  scene.materials[0].diffuse = glm::vec3(0.5f, 0.25f, 1.0f);
  const Camera camera = Camera::look_at({.target = {0, 0, -1}, .fov = 60.0}, 1.0);
  const Bvh bvh(scene);
  RenderStats stats;
  Film film = render(scene, bvh, camera, size(1, 1), serial_model(bvh), stats);
  EXPECT_EQ(film.color[0], glm::vec4(0.5f, 0.25f, 1.0f, 1.0f));
  EXPECT_EQ(film.normal[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(film.depth[0], 2.0f);
  // Now the file has normals, and the wall is seen at 60 degrees from either side.
  const float c = 0.5f, s = std::sqrt(0.75f);
  scene.normals = {glm::vec3(s, 0, -c)};
  scene.triangles[0].normals = {0, 0, 0};
  film = render(scene, bvh, camera, size(1, 1), serial_model(bvh), stats);
  EXPECT_NEAR(film.color[0].b, 0.5f, 1e-6f);
  EXPECT_NEAR(film.normal[0].z, 0.5f, 1e-6f);
}

// Each extra channel alone has the right contents, and no other channel is made or changed.
TEST(Renderer, ExtraChannelsOnDemand) {
  Scene scene = sphere_in_box();
  scene.origin = glm::dvec3(100.0, 0.0, 0.0);
  scene.objects = {"sphere", "box"};
  const std::size_t sphere_size = sphere(3).size();
  for (std::size_t i = sphere_size; i < scene.triangles.size(); ++i) scene.triangles[i].object = 1;
  const Bvh bvh(scene);
  RenderStats stats;
  const Film plain = render(scene, bvh, kCamera, size(64, 64), serial_model(bvh), stats);
  for (const auto wanted :
       {&ExtraChannels::position, &ExtraChannels::albedo, &ExtraChannels::object,
        &ExtraChannels::tests, &ExtraChannels::doubts}) {
    RenderSettings options = size(64, 64);
    options.channels.*wanted = true;
    const Film film = render(scene, bvh, kCamera, options, serial_model(bvh), stats);
    EXPECT_TRUE(same(film, plain));
    const auto expected = [&](auto channel) { return channel == wanted ? 64u * 64u : 0u; };
    EXPECT_EQ(film.position.size(), expected(&ExtraChannels::position));
    EXPECT_EQ(film.albedo.size(), expected(&ExtraChannels::albedo));
    EXPECT_EQ(film.object.size(), expected(&ExtraChannels::object));
    EXPECT_EQ(film.tests.size(), expected(&ExtraChannels::tests));
    EXPECT_EQ(film.doubts.size(), expected(&ExtraChannels::doubts));
    for (std::size_t i = 0; i < film.object.size(); ++i) {
      ASSERT_EQ(film.object[i], film.primitive[i] < sphere_size ? 0u : 1u);
    }
    for (std::size_t i = 0; i < film.position.size(); ++i) {
      // The distance of the point along the camera's axis is the depth.
      const glm::dvec3 from_eye =
          glm::dvec3(film.position[i]) - scene.origin - glm::dvec3(kCamera.eye());
      ASSERT_NEAR(glm::dot(from_eye, kCamera.forward()), film.depth[i], 2e-5);
    }
    for (const glm::vec3& albedo : film.albedo) ASSERT_EQ(albedo, scene.materials[0].diffuse);
  }
}

TEST(Renderer, ProgressReachesOneAndCanCancel) {
  const Scene scene = sphere_in_box();
  const Bvh bvh(scene);
  RenderStats stats;
  double last = 0.0;
  (void)render(scene, bvh, kCamera, size(300, 300, 2), serial_model(bvh), stats,
               {.progress = [&](double done) {
                 EXPECT_GE(done, last);
                 last = done;
                 return true;
               }});
  EXPECT_EQ(last, 1.0);
  (void)render(scene, bvh, kCamera, size(300, 300), serial_model(bvh), stats,
               {.progress = [](double) { return false; }});
  EXPECT_TRUE(stats.cancelled);
  EXPECT_LT(stats.rays, 300u * 300u);
}

/// render() does not wait for a thread that is stuck in a long search.
TEST(Renderer, AThreadThatDoesNotStopIsAbandoned) {
  const Scene scene = sphere_in_box();
  const Bvh bvh(scene);
  std::atomic<int> made = 0;
  const IntersectorFactory stuck = [&, usual = serial_model(bvh)] {
    while (made++ > 0) std::this_thread::sleep_for(std::chrono::hours(1));
    return usual();
  };
  const RenderMonitor monitor{
      .progress = [reports = 0](double) mutable { return reports++ == 0; },
      .abandon = [](const Film& film) { std::_Exit(film.color.size() == 300 * 300 ? 7 : 8); }};
  RenderStats stats;
  EXPECT_EXIT((void)render(scene, bvh, kCamera, size(300, 300, 2), stuck, stats, monitor),
              testing::ExitedWithCode(7), "");
}

TEST(Renderer, AnIntersectorsExceptionReachesTheCaller) {
  const Scene scene = sphere_in_box();
  RenderStats stats;
  const Bvh bvh(scene);
  const IntersectorFactory broken = []() -> std::unique_ptr<Intersector> {
    throw std::runtime_error("no unit");
  };
  EXPECT_THROW((void)render(scene, bvh, kCamera, size(64, 64, 3), broken, stats),
               std::runtime_error);
}

/// An intersector that reports three billion tests for each ray.
class Counting : public CpuIntersector {
 public:
  using CpuIntersector::CpuIntersector;
  void trace(std::span<const Ray> rays, const RayQuery& query,
             std::span<NearestHit> hits) override {
    CpuIntersector::trace(rays, query, hits);
    for (RayWork& work : query.work) work = {.tests = 3'000'000'000u, .doubts = 1000};
  }
};

TEST(Renderer, CountsStayAtTheLargestNumber) {
  const Scene scene = sphere_in_box();
  const Bvh bvh(scene);
  RenderSettings options = size(9, 9);
  options.samples = 3;
  options.channels.tests = options.channels.doubts = true;
  RenderStats stats;
  const IntersectorFactory counting = [&] { return std::make_unique<Counting>(bvh); };
  const Film film = render(scene, bvh, kCamera, options, counting, stats);
  ASSERT_EQ(film.doubts.size(), 81u);
  for (const std::uint32_t tests : film.tests) EXPECT_EQ(tests, 4294967295u);
  for (const std::uint32_t doubts : film.doubts) {
    EXPECT_GE(doubts, 3000u);
    EXPECT_EQ(doubts % 1000, 0u);
  }
}

}  // namespace
}  // namespace raygate
