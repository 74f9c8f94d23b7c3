// Lights that the camera sees begin and end where they do, to a fraction of what a sample is.
#include "host/render/emitter_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/intersect/cpu/cpu_intersector.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

constexpr int kSide = 8;
constexpr float kRadiance = 10.0f;

/// A light that covers these pixels of 8 x 8, from left to right and from the upper edge down.
struct Panel {
  Scene scene;
  Camera camera;

  Panel(float left, float upper, float right, float lower,
        Projection projection = Projection::kPerspective)
      : camera(Camera::look_at({.eye = glm::dvec3(0, 0, 1),
                                .target = glm::dvec3(0),
                                .up = glm::dvec3(0, 1, 0),
                                .fov = 90.0,
                                .lens = {.projection = projection, .aperture = {}, .focus = {}}},
                               1.0)) {
    const auto place = [](float x, float y) {
      return glm::vec3(2.0f * x / kSide - 1.0f, 1.0f - 2.0f * y / kSide, 0.0f);
    };
    const glm::vec3 corner = place(left, upper);
    test::add(scene,
              test::rectangle(corner, place(right, upper) - corner, place(left, lower) - corner),
              test::emitter(glm::vec3(kRadiance)));
  }
};

RenderOptions options(int samples, ReconstructionFilter filter = ReconstructionFilter::kBox) {
  return {.width = kSide,
          .height = kSide,
          .window = {},
          .samples = samples,
          .filter = filter,
          .integrator = IntegratorKind::kPath};
}

std::vector<EmitterEdge> marks(const Panel& panel, ReconstructionFilter filter, std::size_t& rays) {
  const Bvh bvh(panel.scene);
  const PreparedScene prepared(panel.scene, bvh);
  const Lights lights(panel.scene, bvh);
  const RenderOptions asked = options(4, filter);
  CpuIntersector intersector(bvh);
  Film film;
  film.width = film.height = kSide;
  film.window = {0, 0, kSide, kSide};
  std::vector<EmitterEdge> found(std::size_t{kSide} * kSide);
  rays = find_emitter_edges({prepared, panel.camera, asked, lights, {}}, intersector, film,
                            film.window, found, {});
  return found;
}

TEST(EmitterEdges, ArePixelsWithCornersOnBothSides) {
  std::size_t rays = 0;
  const std::vector<EmitterEdge> found =
      marks(Panel(2.5f, 1.5f, 6.5f, 5.5f), ReconstructionFilter::kBox, rays);
  EXPECT_EQ(rays, std::size_t{kSide + 1} * (kSide + 1));
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool is_near = x >= 2 && x <= 6 && y >= 1 && y <= 5;
      const bool is_within = x >= 3 && x <= 5 && y >= 2 && y <= 4;
      EXPECT_EQ(found[std::size_t(y * kSide + x)],
                is_near && !is_within ? EmitterEdge::kYes : EmitterEdge::kNo)
          << x << " " << y;
    }
  }
}

TEST(EmitterEdges, AreAsFarAsTheFilterReaches) {
  std::size_t rays = 0;
  const std::vector<EmitterEdge> found =
      marks(Panel(2.5f, -9.0f, 20.0f, 20.0f), ReconstructionFilter::kBlackmanHarris, rays);
  for (int x = 0; x < kSide; ++x)
    EXPECT_EQ(found[std::size_t(x)], x >= 1 && x <= 3 ? EmitterEdge::kYes : EmitterEdge::kNo) << x;
}

TEST(EmitterEdges, AreNotLookedForWhereNoLightCanBe) {
  std::size_t rays = 0;
  marks(Panel(20.0f, 2.0f, 22.0f, 3.0f), ReconstructionFilter::kBox, rays);
  EXPECT_EQ(rays, 0u);
}

/// The mean square of what pixels are off by, where coverage is known.
double error(const Panel& panel, float left, float upper, float right, float lower, int samples) {
  RenderStats stats;
  const Bvh bvh(panel.scene);
  const Film film = render(
      panel.scene, bvh, panel.camera, options(samples),
      [&] { return std::make_unique<CpuIntersector>(bvh); }, stats);
  const auto covered = [](float low, float high, int pixel) {
    return std::max(0.0,
                    std::min(double{high}, pixel + 1.0) - std::max(double{low}, double(pixel)));
  };
  double sum = 0.0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double is = film.color[film.index_of(x, y)].x;
      const double should = kRadiance * covered(left, right, x) * covered(upper, lower, y);
      EXPECT_GE(is, 0.0);
      sum += (is - should) * (is - should);
    }
  }
  return sum / (kSide * kSide);
}

// Of an edge along an axis, n samples alone are off by 0.4 / n in the mean. Eight times as many are
// off by an eighth, and by a little more at corners, and where their number is no power of two.
TEST(EmitterEdges, AreSharperThanTheSamplesAlone) {
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    for (const int samples : {4, 10, 16}) {
      const float left = 2.3f, upper = 1.6f, right = 6.45f, lower = 5.2f;
      const double found =
          error(Panel(left, upper, right, lower, projection), left, upper, right, lower, samples);
      constexpr double kEdgePixels = 16.0 / (kSide * kSide);
      const double alone = kRadiance * 0.4 / samples;
      EXPECT_LT(found, kEdgePixels * alone * alone / 16.0) << samples;
      EXPECT_GT(found, 0.0) << samples;
    }
  }
}

}  // namespace
}  // namespace raygate
