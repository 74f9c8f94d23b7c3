// Outlines of emitters (direct, in mirrors, through glass) are exact to a fraction of a sample.
#include "host/render/emitter_supersampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

constexpr int kSide = 8;
constexpr float kRadiance = 10.0f;

Camera camera_of(Projection projection = Projection::kPerspective, double aperture = 0.0) {
  return Camera::look_at({.eye = glm::dvec3(0, 0, 1),
                          .target = glm::dvec3(0),
                          .up = glm::dvec3(0, 1, 0),
                          .fov = 90.0,
                          .lens = {.projection = projection, .aperture = aperture, .focus = {}}},
                         1.0);
}

/// An emitter that covers the rectangle from (left, upper) to (right, lower), in pixels of an image
/// of 8 x 8; or, if `in_mirror`, an emitter whose mirror image covers it.
struct Panel {
  Scene scene;
  Camera camera;

  Panel(float left, float upper, float right, float lower,
        Projection projection = Projection::kPerspective, bool in_mirror = false)
      : camera(camera_of(projection)) {
    const float far = in_mirror ? 3.0f : 1.0f;
    const auto place = [far](float x, float y) {
      return far * glm::vec3(2.0f * x / kSide - 1.0f, 1.0f - 2.0f * y / kSide, 0.0f);
    };
    const glm::vec3 corner = place(left, upper) + glm::vec3(0, 0, far - 1.0f);
    test::add(scene,
              test::rectangle(corner, place(right, upper) - place(left, upper),
                              place(left, lower) - place(left, upper)),
              test::emitter(glm::vec3(kRadiance)));
    if (in_mirror) {
      test::add(scene, test::rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), test::mirror(1.0f));
    }
  }
};

RenderSettings options(int samples, ReconstructionFilter filter = ReconstructionFilter::kBox,
                       IntegratorKind integrator = IntegratorKind::kPath) {
  RenderSettings options;
  options.width = options.height = kSide;
  options.samples = samples;
  options.filter = filter;
  options.integrator = integrator;
  return options;
}

struct Found {
  std::vector<HistoryMask> ways;  // by pixel
  std::uint64_t rays = 0;
};

Found find(const Scene& scene, const Camera& camera, const RenderSettings& asked) {
  const Bvh bvh(scene);
  const PreparedScene prepared(scene, bvh);
  const Lights lights(scene, bvh);
  CpuIntersector intersector(bvh);
  Film film;
  film.width = film.height = kSide;
  film.window = {0, 0, kSide, kSide};
  Found found;
  found.ways.resize(std::size_t{kSide} * kSide, kUnknownHistories);
  const RenderContext context{prepared, camera, asked, lights};
  RenderStats stats;
  EmitterSupersampler emitters(context, intersector, false, stats);
  emitters.find(film, film.window, found.ways, {});
  found.rays = stats.rays;
  return found;
}

constexpr HistoryMask kDirect = 1u << 1;
constexpr HistoryMask kInMirror = 1u << 2;

/// Expects the mask `expected` in the ring of pixels around [3, 6) x [2, 5), and 0 elsewhere.
void expect_around(const std::vector<HistoryMask>& ways, HistoryMask expected) {
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool is_near = x >= 2 && x <= 6 && y >= 1 && y <= 5;
      const bool is_within = x >= 3 && x <= 5 && y >= 2 && y <= 4;
      EXPECT_EQ(ways[std::size_t(y * kSide + x)], is_near && !is_within ? expected : 0)
          << x << " " << y;
    }
  }
}

TEST(EmitterSupersampler, AreOfPixelsWithCornersOnBothSides) {
  const Panel panel(2.5f, 1.5f, 6.5f, 5.5f);
  const Found found = find(panel.scene, panel.camera, options(4));
  EXPECT_EQ(found.rays, std::size_t{kSide + 1} * (kSide + 1));
  expect_around(found.ways, kDirect);
}

TEST(EmitterSupersampler, GoByMirrorsOfPathTracers) {
  const Panel panel(2.5f, 1.5f, 6.5f, 5.5f, Projection::kPerspective, true);
  expect_around(find(panel.scene, panel.camera, options(4)).ways, kInMirror);
  const Found of_whitted = find(panel.scene, panel.camera,
                                options(4, ReconstructionFilter::kBox, IntegratorKind::kWhitted));
  EXPECT_EQ(of_whitted.rays, 0u) << "the panel is behind the camera";
  EXPECT_EQ(of_whitted.ways, std::vector<HistoryMask>(std::size_t{kSide} * kSide, 0));
}

TEST(EmitterSupersampler, GoStraightThroughWhatIsClear) {
  Panel panel(2.5f, 1.5f, 6.5f, 5.5f);
  Material pane = test::matte(glm::vec3(0.0f));
  pane.opacity = 0.25f;
  test::add(panel.scene, test::rectangle({-9, -9, 0.5}, {18, 0, 0}, {0, 18, 0}), pane);
  expect_around(find(panel.scene, panel.camera, options(4)).ways, kDirect);
}

// With kPrimary, rays end at the first surface, clear or not.
TEST(EmitterSupersampler, SeesOfThePrimaryIntegratorWhatThatSees) {
  Panel panel(2.5f, 1.5f, 6.5f, 5.5f);
  const RenderSettings asked = options(4, ReconstructionFilter::kBox, IntegratorKind::kPrimary);
  expect_around(find(panel.scene, panel.camera, asked).ways, kDirect);
  Material pane = test::matte(glm::vec3(0.0f));
  pane.opacity = 0.0f;
  test::add(panel.scene, test::rectangle({-9, -9, 0.5}, {18, 0, 0}, {0, 18, 0}), pane);
  expect_around(find(panel.scene, panel.camera, asked).ways, 0);
}

/// Returns a glass ball, in which an emitter behind the camera is seen.
Scene ball() {
  Scene scene;
  test::add(scene, test::sphere(3, 0.6f, {0.1f, 0, 0}), test::glass(1.5f));
  test::add(scene, test::rectangle({-2.5f, 0.2f, 2}, {0, 4, 0}, {5, 0, 0}),
            test::emitter(glm::vec3(kRadiance)));
  return scene;
}

TEST(EmitterSupersampler, GoThroughGlass) {
  const Found found = find(ball(), camera_of(), options(4));
  HistoryMask all = 0;
  for (const HistoryMask ways : found.ways) all |= ways;
  EXPECT_NE(all >> 0b10 & 1, 0u) << "mirrored by its front";
  EXPECT_NE(all >> 0b1101 & 1, 0u) << "in, mirrored at the back, out";
}

TEST(EmitterSupersampler, GoThroughTwoPanes) {
  Panel panel(2.5f, 1.5f, 6.5f, 5.5f);
  for (const float z : {0.3f, 0.6f}) {
    test::add(panel.scene, test::box({-9, -9, z}, {9, 9, z + 0.1f}), test::glass(1.5f));
  }
  HistoryMask all = 0;
  for (const HistoryMask ways : find(panel.scene, panel.camera, options(4)).ways) all |= ways;
  EXPECT_NE(all >> 0b11111 & 1, 0u) << "in and out twice";
}

// A lens disables supersampling. A tiny lens gives the same camera without supersampling.
TEST(EmitterSupersampler, HaveTheSameMean) {
  const Scene scene = ball();
  const Bvh bvh(scene);
  constexpr int kSeeds = 16;
  double mean[2] = {}, variance[2] = {};
  for (const int lens : {0, 1}) {
    double sum = 0.0, squares = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      RenderSettings asked = options(256);
      RenderStats stats;
      asked.seed = static_cast<std::uint64_t>(seed);
      asked.caustics = false;
      const Film film = test::render(scene, bvh, camera_of(Projection::kPerspective, lens * 1e-6),
                                     asked, test::cpu(bvh), stats);
      const double light = test::mean_colour(film).x;
      sum += light;
      squares += light * light;
    }
    mean[lens] = sum / kSeeds;
    variance[lens] = (squares / kSeeds - mean[lens] * mean[lens]) / (kSeeds - 1);
  }
  EXPECT_GT(mean[1], 0.1);
  EXPECT_LT(variance[1], 2e-4 * mean[1] * mean[1]) << "5 % more of what is supersampled would show";
  EXPECT_LT(variance[0], variance[1]);
  EXPECT_NEAR(mean[0], mean[1], 4.0 * std::sqrt(variance[0] + variance[1]));
}

TEST(EmitterSupersampler, GoAsFarAsTheFilterReaches) {
  const Panel panel(2.5f, -9.0f, 20.0f, 20.0f);
  const Found found =
      find(panel.scene, panel.camera, options(4, ReconstructionFilter::kBlackmanHarris));
  for (int x = 0; x < kSide; ++x)
    EXPECT_EQ(found.ways[std::size_t(x)], x >= 1 && x <= 3 ? kDirect : 0) << x;
}

TEST(EmitterSupersampler, AreNotMadeWhereNoLightCanBe) {
  const Panel panel(20.0f, 2.0f, 22.0f, 3.0f);
  EXPECT_EQ(find(panel.scene, panel.camera, options(4)).rays, 0u);
}

/// Returns the mean squared error of the pixels of `panel`, which covers this rectangle.
double error(const Panel& panel, float left, float upper, float right, float lower, int samples) {
  RenderStats stats;
  const Bvh bvh(panel.scene);
  const Film film =
      test::render(panel.scene, bvh, panel.camera, options(samples), test::cpu(bvh), stats);
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

// At an axis-parallel edge, the error of n samples alone is 0.4 / n on average. With eight times as
// many samples, the error is 1/8, or slightly more at corners and without a power of two.
TEST(EmitterSupersampler, AreSharperThanTheSamplesAlone) {
  const struct {
    Projection projection;
    bool in_mirror;
  } cases[] = {{Projection::kPerspective, false},
               {Projection::kOrthographic, false},
               {Projection::kPerspective, true}};
  for (const auto& [projection, in_mirror] : cases) {
    for (const int samples : {4, 10, 16}) {
      const float left = 2.3f, upper = 1.6f, right = 6.45f, lower = 5.2f;
      const double found = error(Panel(left, upper, right, lower, projection, in_mirror), left,
                                 upper, right, lower, samples);
      constexpr double kEdgePixels = 16.0 / (kSide * kSide);
      const double alone = kRadiance * 0.4 / samples;
      EXPECT_LT(found, kEdgePixels * alone * alone / 16.0) << samples;
      EXPECT_GT(found, 0.0) << samples;
    }
  }
}

}  // namespace
}  // namespace raygate
