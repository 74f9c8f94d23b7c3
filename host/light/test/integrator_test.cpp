// Pictures with shadows, mirrors and glass have the same bytes for all engines and threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <optional>

#include "host/base/test/using_vectors.h"
#include "host/light/test/light_scenes.h"

static thread_local bool refuse_large = false;  // makes large allocations of this thread fail

namespace raygate {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

/// An intersector that prefers larger tiles.
class ManyAtOnce : public CpuIntersector {
 public:
  ManyAtOnce(const Bvh& bvh, std::size_t lanes) : CpuIntersector(bvh) { traits_.batch *= lanes; }
};

const Camera kWide = camera_at({0.6, 0.4, 5.5}, {0, -0.3, 0}, 55.0, 4.0 / 3.0);
const Camera kSquare = camera_at({0.6, 0.4, 5.5}, {0, -0.3, 0}, 45.0);

class EveryIntegrator : public testing::TestWithParam<IntegratorKind> {
 protected:
  RenderSettings options(int width = 40, int height = 30) const {
    return light(GetParam(), width, height, 5);  // two passes
  }
  Film film(const RenderSettings& options, RenderStats& stats) const {
    return render(scene_, bvh_, camera_, options, pipeline_model(bvh_), stats);
  }
  Film film(const RenderSettings& options) const {
    RenderStats stats;
    return film(options, stats);
  }

  Scene scene_ = everything();
  Bvh bvh_{scene_};
  Camera camera_ = kWide;
};

INSTANTIATE_TEST_SUITE_P(Kinds, EveryIntegrator,
                         testing::Values(IntegratorKind::kPrimary, IntegratorKind::kWhitted,
                                         IntegratorKind::kPath));

TEST_P(EveryIntegrator, ThreadsAndUnitsChangeNoByte) {
  const Film one = film(options(150, 100));
  for (const int threads : {2, 8}) {
    RenderSettings more = options(150, 100);
    more.threads = threads;
    EXPECT_TRUE(same(one, film(more))) << threads;
  }
  RenderStats stats;
  for (const std::size_t lanes : {4, 8}) {  // larger tiles
    const IntersectorFactory several = [&] { return std::make_unique<ManyAtOnce>(bvh_, lanes); };
    EXPECT_TRUE(same(one, render(scene_, bvh_, camera_, options(150, 100), several, stats)));
  }
  for (const auto& engine : {serial_model(bvh_), cpu(bvh_)}) {
    EXPECT_TRUE(same(one, render(scene_, bvh_, camera_, options(150, 100), engine, stats)));
  }
}

/// Counts rays with and without a source primitive, and checks that none hits its source.
class SourceGuard : public CpuIntersector {
 public:
  SourceGuard(const Bvh& bvh, std::size_t& named, std::size_t& unnamed)
      : CpuIntersector(bvh), bvh_(bvh), named_(named), unnamed_(unnamed) {
    traits_.wants_sources = true;
  }
  void trace(std::span<const Ray> rays, const RayQuery& query,
             std::span<NearestHit> hits) override {
    for (std::size_t i = 0; i < rays.size() && !query.common_origin; ++i) {
      const std::uint32_t source =
          query.source_ids.empty() ? NearestHit::kNone : query.source_ids[i];
      ++(source == NearestHit::kNone ? unnamed_ : named_);
      if (source == NearestHit::kNone) continue;
      EXPECT_FALSE(hits_triangle(rays[i], bvh_.corners_of(source)));
    }
    CpuIntersector::trace(rays, query, hits);
  }

 private:
  const Bvh& bvh_;
  std::size_t &named_, &unnamed_;
};

TEST_P(EveryIntegrator, RaysNameTheTriangleThatTheyLeave) {
  std::size_t named = 0, unnamed = 0;
  const IntersectorFactory guard = [&] {
    return std::make_unique<SourceGuard>(bvh_, named, unnamed);
  };
  RenderStats stats;
  RenderSettings one_thread = options(150, 100);
  one_thread.threads = 1;
  one_thread.caustics = false;  // light paths start off the lights, without a source
  EXPECT_TRUE(same(film(one_thread), render(scene_, bvh_, camera_, one_thread, guard, stats)));
  if (GetParam() == IntegratorKind::kPrimary) return;
  EXPECT_GT(named, 10'000u);
  EXPECT_LT(1'000 * unnamed, named);
}

// Baseline code shades one hit at a time; other instruction sets shade one hit per lane.
TEST_P(EveryIntegrator, VectorsChangeNoByte) {
  RenderSettings all = options(80, 60);
  all.channels.albedo = true;
  std::optional<Film> expected;
  for (const Vectors vectors : machine_vectors()) {
    const UsingVectors in_use(vectors);
    Film found = film(all);
    if (!expected) expected = found;
    EXPECT_TRUE(same(*expected, found)) << name_of(vectors);
    EXPECT_TRUE(same_bytes(expected->albedo, found.albedo)) << name_of(vectors);
  }
}

// With the unit's P instead of the host's, positions hardly differ.
TEST_P(EveryIntegrator, TheUnitsPointsAreGoodEnough) {
  RenderSettings host = options(80, 60), unit = host;
  host.channels.position = unit.channels.position = true;
  host.point_error = 0.0f;
  unit.point_error = std::numeric_limits<float>::max();
  RenderStats all, none, some;
  const Film exact = film(host, all), given = film(unit, none);
  (void)film(options(80, 60), some);
  EXPECT_EQ(none.point_doubts, 0u);
  EXPECT_GT(some.point_doubts, 0u);
  EXPECT_LT(10 * some.point_doubts, all.point_doubts);
  EXPECT_EQ(exact.primitive, given.primitive);
  EXPECT_NE(exact.position, given.position);
  for (std::size_t i = 0; i < exact.depth.size(); ++i) {
    if (exact.primitive[i] != kNoPrimitive) {
      ASSERT_NEAR(given.depth[i] / exact.depth[i], 1.0, 0x1p-12);
    }
  }
}

// Traces more shadow rays than fit into one batch.
TEST(ManyLights, WindowsArePartsOfTheWhole) {
  Scene scene = everything();
  for (int i = 0; i < 40; ++i) {
    scene.lights.push_back({{-1.8f + 0.09f * float(i), 1.7f, 0.3f}, glm::vec3(0.1f)});
  }
  const Bvh bvh(scene);
  RenderSettings options = light(IntegratorKind::kWhitted, 96, 96, 1);
  options.max_depth = 1;
  RenderStats stats;
  const Film whole = render(scene, bvh, kSquare, options, pipeline_model(bvh), stats);
  EXPECT_GT(stats.shadow_rays, 1u << 17);
  options.window = {50, 20, 77, 63};
  const Film part = render(scene, bvh, kSquare, options, pipeline_model(bvh), stats);
  for (int y = 20; y < 63; ++y) {
    for (int x = 50; x < 77; ++x) {
      ASSERT_EQ(part.color[std::size_t(y - 20) * 27 + (x - 50)], whole.color[y * 96u + x]);
    }
  }
}

// With many lights, shadow rays start at surfaces; with few, at lights. Shadows are the same.
TEST(ManyLights, ShadowsAreTheSameFromEitherEnd) {
  Scene few = everything();
  Scene many = few;
  for (int i = 0; i < 70; ++i) many.lights.push_back({{0.0f, 1.0f, 0.0f}, glm::vec3(0.0f)});
  const RenderSettings options = light(IntegratorKind::kWhitted, 96, 96, 1);
  const Film a = film_of(few, kSquare, options), b = film_of(many, kSquare, options);
  int different = 0;
  for (std::size_t i = 0; i < a.color.size(); ++i) different += a.color[i] != b.color[i];
  EXPECT_LT(different, 10) << "of 9,216: rays from the light end a float away";
}

TEST_P(EveryIntegrator, SeedsChangeTheNoiseAlone) {
  RenderSettings other = options();
  other.seed = 1;
  const Film a = film(options()), b = film(other);
  EXPECT_TRUE(same_bytes(a.color, film(options()).color));
  EXPECT_FALSE(same_bytes(a.color, b.color));
  EXPECT_NEAR(mean_colour(b).r, mean_colour(a).r, 0.05 * mean_colour(a).r);
}

// No value in a file and no position of a light makes a pixel infinite or NaN.
TEST_P(EveryIntegrator, EveryPixelIsFinite) {
  for (const float extreme : {0.0f, 1e-30f, 0.001f, 1e30f}) {
    for (int model = 0; model <= 10; ++model) {
      Scene scene = everything();
      for (Material& material : scene.materials) {
        material.illumination_model = model;
        material.shininess = extreme;
        material.refraction_index = std::max(extreme, 0.001f);
        material.emission *= extreme;
        material.specular = glm::vec3(extreme);
      }
      scene.materials[5].emission = glm::vec3(extreme);
      scene.lights.push_back({{-2, -2, -2}, glm::vec3(extreme)});     // in a corner
      scene.lights.push_back({scene.positions[0], glm::vec3(1.0f)});  // on a vertex
      scene.lights.push_back({glm::vec3(camera_.eye()), glm::vec3(0.0f)});
      RenderSettings small = light(GetParam(), 10, 8, 2);
      small.max_depth = 3;
      for (const glm::vec4& colour : film_of(scene, camera_, small).color) {
        for (int k = 0; k < 4; ++k)
          ASSERT_TRUE(std::isfinite(colour[k])) << model << " " << extreme;
      }
    }
  }
}

// Tiles are empty if the scene fills only a corner of the picture.
TEST(EmptyTiles, HaveNoCameraRays) {
  Scene scene = everything();
  const Bvh bvh(scene);
  const Camera camera = camera_at({0.6, 0.4, 60}, {12, 12, 0}, 40.0);
  RenderSettings options = light(IntegratorKind::kWhitted, 400, 400, 1);
  RenderStats stats;
  // Only integrators that see an environment need camera rays in empty tiles.
  EnvironmentMap sky;
  sky.width = sky.height = 1;
  sky.texels = {glm::vec3(1.0f)};
  scene.environment = sky;
  for (const IntegratorKind kind : {IntegratorKind::kWhitted, IntegratorKind::kPrimary}) {
    options.integrator = kind;
    (void)render(scene, bvh, camera, options, pipeline_model(bvh), stats);
    EXPECT_EQ(stats.camera_rays < 400u * 400u, kind == IntegratorKind::kPrimary);
  }
}

// The threshold saves rays, and changes the picture by at most the contribution of these rays.
TEST(Threshold, SavesRaysThatHardlyCount) {
  Scene scene = everything();
  const Bvh bvh(scene);
  RenderSettings options = light(IntegratorKind::kWhitted, 64, 64, 1);
  RenderStats all, some;
  options.threshold = 0.0;
  const Film exact = render(scene, bvh, kSquare, options, pipeline_model(bvh), all);
  options.threshold = 0.05;
  const Film film = render(scene, bvh, kSquare, options, pipeline_model(bvh), some);
  EXPECT_LT(some.rays, all.rays - 100);
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    // At most 2^4 rays of a pixel are cut off, each showing at most the light's radiance of 6.
    ASSERT_LE(std::abs(film.color[i].r - exact.color[i].r), 0.05f * 16 * 6);
    ASSERT_LE(film.color[i].r, exact.color[i].r + 1e-6f);
  }
}

// Snapshots show the samples so far while rendering goes on.
TEST(Snapshots, AreTakenOnTheWay) {
  const Scene scene = everything();
  const RenderSettings options = light(IntegratorKind::kPath, 40, 30, 400);
  RenderMonitor monitor;
  int snapshots = 0;
  float seen = 0.0f;
  monitor.snapshot = [&](const Film* film) {
    ++snapshots;
    ASSERT_NE(film, nullptr);
    EXPECT_EQ(film->color.size(), 1200u);
    seen = std::max(seen, film->color[600].r);
  };
  monitor.snapshot_seconds = 0.0;
  RenderStats stats;
  const Bvh bvh(scene);
  (void)render(scene, bvh, kWide, options, pipeline_model(bvh), stats, monitor);
  EXPECT_GT(snapshots, 0);
  EXPECT_GT(seen, 0.0f);
}

// If memory for a copy is lacking, the snapshot is null and rendering goes on.
TEST(Snapshots, WithoutMemoryForACopyTheRenderGoesOn) {
  const Scene scene = everything();
  const RenderSettings options = light(IntegratorKind::kPath, 40, 30, 100);
  RenderMonitor monitor;
  int missing = 0;
  monitor.progress = [&](double fraction) {
    refuse_large = fraction < 1.0;  // the copy follows, on this thread
    return true;
  };
  monitor.snapshot = [&](const Film* film) {
    refuse_large = false;
    missing += film == nullptr;
  };
  monitor.snapshot_seconds = 0.0;
  RenderStats stats;
  const Bvh bvh(scene);
  const Film film = render(scene, bvh, kWide, options, pipeline_model(bvh), stats, monitor);
  refuse_large = false;
  EXPECT_GT(missing, 0);
  EXPECT_FALSE(stats.cancelled);
  EXPECT_GT(film.color[600].r, 0.0f);
}

}  // namespace
}  // namespace raygate

// An allocation function that fails for large sizes while refuse_large is set.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* const memory = refuse_large && size > 4000 ? nullptr : std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
