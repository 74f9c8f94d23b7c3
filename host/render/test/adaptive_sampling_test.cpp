// Adaptive sampling: error estimates hold, and the film does not depend on how work is distributed.
#include "host/render/adaptive_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <set>

#include "host/film/display.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr double kStudent = 2.12;  // Student's t: 95 %, 16 values
constexpr double kNever = 1e-9;    // an error that no pixel reaches

/// Returns the number of seeds to try: RAYGATE_SEEDS, or 100.
int seeds() {
  const char* const given = std::getenv("RAYGATE_SEEDS");
  return given == nullptr ? 100 : std::max(1, std::atoi(given));
}

RenderSettings adaptive(int width, int height, int most, double error) {
  RenderSettings options = light(IntegratorKind::kPath, width, height, most);
  options.error = error;
  return options;
}

/// Calls `each` with the film of a scene for each seed.
void with_seeds(const Scene& scene, const Camera& camera, RenderSettings options,
                const std::function<void(const Film&)>& each) {
  const Bvh bvh(scene);
  const PreparedScene prepared(scene, bvh);
  for (int seed = 0; seed < seeds(); ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    RenderStats stats;
    each(raygate::render({prepared, camera, options}, cpu(bvh), stats));
  }
}

/// A closed room whose walls emit 1 and reflect `albedo`: the radiance is 1 / (1 - albedo).
Scene furnace(float albedo) {
  Scene scene;
  Material wall = matte(glm::vec3(albedo));
  wall.emission = glm::vec3(1.0f);
  add(scene, box(glm::vec3(-1.0f), glm::vec3(1.0f, 1.5f, 2.0f)), wall);
  return scene;
}

const Camera kInside = camera_at({0.2, 0.1, 0.3}, {-1, -0.4, -0.7}, 5.0);

/// Percentage of seeds for which a pixel's 95 % interval contains the known value, in a picture of
/// one block: mean over the pixels, lowest and highest.
struct Coverage {
  double all, least, most;
};

Coverage coverage_of(const Scene& scene, const Camera& camera, int samples, double known) {
  int held[kErrorBlock * kErrorBlock] = {};
  RenderSettings options = adaptive(kErrorBlock, kErrorBlock, samples, kNever);
  const double truth = display_steps(glm::vec3(static_cast<float>(known)), 0.0);
  with_seeds(scene, camera, options, [&](const Film& film) {
    for (std::size_t i = 0; i < film.color.size(); ++i) {
      EXPECT_EQ(film.sums.samples[i], static_cast<std::uint32_t>(samples));
      const double off = display_steps(glm::vec3(film.color[i]), 0.0) - truth;
      held[i] += std::abs(off) <= kStudent * double{film.sums.error[i]};
    }
  });
  Coverage coverage{0.0, 100.0, 0.0};
  for (const int count : held) {
    const double percent = 100.0 * count / seeds();
    coverage.all += percent / (kErrorBlock * kErrorBlock);
    coverage.least = std::min(coverage.least, percent);
    coverage.most = std::max(coverage.most, percent);
  }
  return coverage;
}

/// Returns a white floor under `lights`. kAtFloor is so close to it that pixels hardly differ.
Scene floor_under(Scene lights) {
  add(lights, rectangle({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}), matte(glm::vec3(1.0f)));
  return lights;
}

const Camera kAtFloor = camera_at({0, 1e-3, 0}, {0, 0, 0}, 1e-3);

/// Prints `coverage`, and expects that its mean is from 93 % to `most` %.
void expect_coverage(const char* name, int samples, double most, const Coverage& coverage) {
  std::printf("%-22s %4d samples: %5.1f %% (pixels: %.1f to %.1f), %d seeds\n", name, samples,
              coverage.all, coverage.least, coverage.most, seeds());
  EXPECT_GE(coverage.all, 93.0) << name << " " << samples;
  EXPECT_LE(coverage.all, most) << name << " " << samples;
}

TEST(ErrorEstimate, HoldsInAFurnace) {
  for (const float albedo : {0.5f, 0.8f}) {
    for (const int samples : {64, 256}) {
      expect_coverage(albedo == 0.5f ? "furnace, albedo 0.5" : "furnace, albedo 0.8", samples, 97.0,
                      coverage_of(furnace(albedo), kInside, samples, 1.0 / (1.0 - albedo)));
    }
  }
}

// If evenly spread samples have few dimensions, the error falls faster than the estimate.
TEST(ErrorEstimate, IsCarefulWhereSamplesAreEvenlySpread) {
  constexpr double kPi = std::numbers::pi;
  Scene lights;
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) {
    const double side = 0.3 * i, height = 1.0 + 0.2 * i, intensity = 1.0 + i * i;
    lights.lights.push_back({{side, height, 0}, glm::dvec3(intensity)});
    const double squared = side * side + height * height;
    sum += intensity * height / (squared * std::sqrt(squared)) / kPi;
  }
  // A corner of the light is straight above (Siegel and Howell's catalogue, B-4).
  Scene panel;
  const double a = 1.5, b = 0.8, height = 1.2, x = a / height, y = b / height;
  add(panel, rectangle({0, float(height), 0}, {float(a), 0, 0}, {0, 0, float(b)}),
      emitter(glm::vec3(3.0f)));
  const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
  const double form = (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
  for (const int samples : {16, 64, 256}) {
    expect_coverage("twelve point lights", samples, 100.0,
                    coverage_of(floor_under(lights), kAtFloor, samples, sum));
    expect_coverage("rectangular light", samples, 100.0,
                    coverage_of(floor_under(panel), kAtFloor, samples, 3.0 * form));
  }
}

TEST(AdaptiveSampling, LooksAreAtPowersOfTwo) {
  EXPECT_EQ(next_error_check(0), 8);
  EXPECT_EQ(next_error_check(7), 8);
  EXPECT_EQ(next_error_check(8), 16);
  EXPECT_EQ(next_error_check(100), 128);
  EXPECT_TRUE(is_error_check(8) && is_error_check(16) && is_error_check(1024));
  EXPECT_FALSE(is_error_check(4) || is_error_check(12) || is_error_check(0));
  EXPECT_TRUE(has_converged(2.0f, 16, 2.0));
  EXPECT_FALSE(has_converged(2.1f, 16, 2.0));
  EXPECT_TRUE(has_converged(4.0f, 32, 2.0));
  EXPECT_FALSE(has_converged(0.0f, 8, 2.0)) << "it has not been judged";
  EXPECT_FALSE(has_converged(0.0f, 24, 2.0)) << "no look";
}

/// A scene with blocks that need many samples and blocks that need few.
struct Uneven {
  Scene scene = everything();
  Camera camera = camera_at({0, 0, 6}, {0, 0, 0}, 45.0, 44.0 / 34.0);
  Bvh bvh{scene};
  PreparedScene prepared{scene, bvh};
  Film film(RenderSettings options, const IntersectorFactory& intersectors, RenderStats& stats,
            const Film* unfinished = nullptr) const {
    options.channels.sums = true;
    return raygate::render({prepared, camera, options, {}, unfinished}, intersectors, stats);
  }
  Film film(const RenderSettings& options, const Film* unfinished = nullptr) const {
    RenderStats stats;
    return film(options, cpu(bvh), stats, unfinished);
  }
};

bool same_film(const Film& a, const Film& b) {
  return same(a, b) && same_bytes(a.sums.samples, b.sums.samples) &&
         same_bytes(a.sums.error, b.sums.error) && same_bytes(a.sums.shown, b.sums.shown) &&
         same_bytes(a.sums.color, b.sums.color);
}

TEST(AdaptiveSampling, GivesSamplesWhereTheErrorIs) {
  const Uneven uneven;
  RenderStats stats;
  const Film film = uneven.film(adaptive(44, 34, 200, 0.4), cpu(uneven.bvh), stats);
  std::set<std::uint32_t> counts;
  std::uint64_t taken = 0, unfinished = 0;
  for (int y = 0; y < 34; ++y) {
    for (int x = 0; x < 44; ++x) {
      const std::size_t i = film.index_of(x, y);
      const std::size_t first =
          film.index_of(x / kErrorBlock * kErrorBlock, y / kErrorBlock * kErrorBlock);
      const std::uint32_t samples = film.sums.samples[i];
      EXPECT_EQ(samples, film.sums.samples[first]) << "a block is judged as one";
      counts.insert(samples);
      taken += samples;
      unfinished += samples == 200;
      if (samples < 200) {
        EXPECT_TRUE(has_converged(film.sums.error[i], static_cast<int>(samples), 0.4))
            << x << " " << y;
      }
    }
  }
  EXPECT_EQ(*counts.begin(), 16u) << "the sky needs none";
  EXPECT_EQ(*counts.rbegin(), 200u);
  EXPECT_GE(counts.size(), 4u);
  EXPECT_EQ(stats.spare_samples, 44u * 34u * 200u - taken);
  EXPECT_EQ(stats.unfinished_pixels, unfinished);
}

TEST(AdaptiveSampling, FilmDoesNotDependOnThreadsTilesOrEngine) {
  const Uneven uneven;
  const RenderSettings options = adaptive(44, 34, 72, 1.0);
  const Film whole = uneven.film(options);
  for (const int threads : {3, 8}) {  // the number of threads changes the tiles, too
    RenderSettings other = options;
    other.threads = threads;
    EXPECT_TRUE(same_film(whole, uneven.film(other)));
  }
  RenderStats stats;
  EXPECT_TRUE(same_film(whole, uneven.film(options, pipeline_model(uneven.bvh), stats)));
  RenderSettings part = options;
  part.window = {8, 12, 44, 32};
  const Film window = uneven.film(part);
  for (int y = part.window.y0; y < part.window.y1; ++y) {
    for (int x = part.window.x0; x < part.window.x1; ++x) {
      const std::size_t i = window.index_of(x, y), k = whole.index_of(x, y);
      EXPECT_EQ(window.color[i], whole.color[k]);
      EXPECT_EQ(window.sums.samples[i], whole.sums.samples[k]);
      EXPECT_EQ(window.sums.error[i], whole.sums.error[k]);
    }
  }
}

TEST(AdaptiveSampling, GoesOnFromAnyFilm) {
  const Uneven uneven;
  const RenderSettings options = adaptive(44, 34, 150, 0.5);
  const Film whole = uneven.film(options);
  for (const int fewer : {17, 22, 64, 90}) {
    RenderSettings first = options;
    first.samples = fewer;
    const Film begun = uneven.film(first);
    EXPECT_TRUE(same_film(whole, uneven.film(options, &begun))) << fewer;
  }
  int reports = 0;
  RenderStats stats;
  const Film broken_off = render(uneven.scene, uneven.bvh, uneven.camera, options, cpu(uneven.bvh),
                                 stats, {.progress = [&](double) { return ++reports < 3; }});
  EXPECT_TRUE(same_film(whole, uneven.film(options, &broken_off)));
}

// Blocks stop when their error happens to be small. This must not bias the mean.
TEST(AdaptiveSampling, StoppingFavoursNoSideInTheLarge) {
  double sum = 0.0, squares = 0.0, samples = 0.0;
  int blocks = 0;
  with_seeds(furnace(0.8f), kInside, adaptive(8, 8, 512, 1.5), [&](const Film& film) {
    const double mean = mean_colour(film).g;
    sum += mean;
    squares += mean * mean;
    for (const std::uint32_t count : film.sums.samples) samples += count;
    blocks += 64;
  });
  const double n = seeds(), mean = sum / n;
  const double deviation = std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
  std::printf("furnace: %.5f +- %.5f of 5, %.1f samples a pixel\n", mean, deviation,
              samples / blocks);
  EXPECT_NEAR(mean, 5.0, 4.0 * deviation + 0.01);
  EXPECT_GT(samples / blocks, 17.0);
  EXPECT_LT(samples / blocks, 500.0);
}

}  // namespace
}  // namespace raygate
