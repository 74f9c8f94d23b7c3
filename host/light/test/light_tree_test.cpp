// Lights are chosen as often as their probabilities say; the outer sides of closed lights.
#include "host/light/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "host/base/vectors.h"
#include "host/light/lights.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using test::add, test::emitter, test::rectangle;

constexpr std::uint32_t kSeed = 20;

/// Lights of all kinds, strewn about: points, spots, triangles and parallelograms, from afar.
class ManyLights : public testing::TestWithParam<int> {
 protected:
  ManyLights() {
    for (int i = 0; i < GetParam(); ++i) {
      const glm::vec3 at = place();
      const float size = 0.01f + 0.2f * one();
      if (i % 4 == 0) {
        scene_.lights.push_back({at, glm::dvec3(0.01 + one())});
      } else if (i % 4 == 1) {
        const double inner = 40.0 * one();
        scene_.lights.push_back({at, glm::dvec3(one()),
                                 SpotCone{glm::dvec3(way()), inner, inner + 1.0 + 40.0 * one()}});
      } else {
        add(scene_,
            i % 4 == 2 ? rectangle(at, size * way(), size * way())
                       : std::vector<Corners>{{at, at + size * way(), at + size * way()}},
            emitter(glm::vec3(0.1f + 9.0f * one())));
      }
    }
    if (scene_.triangles.empty()) add(scene_, rectangle(way(), way(), way()), emitter({1, 1, 1}));
    scene_.directional_lights.push_back({glm::dvec3(way()), glm::vec3(0.1f)});
    scene_.directional_lights.push_back({glm::dvec3(way()), glm::vec3(0.5f)});
  }

  float one() { return std::uniform_real_distribution<float>(0.0f, 1.0f)(random_); }
  glm::vec3 place() { return {8.0f * one() - 4.0f, 8.0f * one() - 4.0f, 8.0f * one() - 4.0f}; }
  glm::vec3 way() {
    for (;;) {
      const glm::vec3 v(2.0f * one() - 1.0f, 2.0f * one() - 1.0f, 2.0f * one() - 1.0f);
      if (glm::dot(v, v) < 1.0f && glm::dot(v, v) > 0.01f) return glm::normalize(v);
    }
  }

  /// Whether a source brings anything to a surface there, if nothing is between.
  bool brings(const Lights& lights, const Lights::Source& source, const glm::vec3& point,
              const glm::vec3& normal) {
    const Lights::Light& light = lights.light(source.light);
    if (light.kind == Lights::Kind::kDirection) return glm::dot(light.position, normal) > 0.0f;
    if (light.kind == Lights::Kind::kPoint) {
      const glm::vec3 to = light.position - point;
      const float cosine = -glm::dot(glm::normalize(to), light.spot.axis);
      return glm::dot(to, normal) > 0.0f &&
             (!light.is_spot || spot_falloff(cosine, light.spot.scale, light.spot.offset) > 0.0f);
    }
    for (int i = 0; i < 8; ++i) {
      const std::uint32_t patches[] = {source.patch};
      const auto place = lights.sample_patches<float>(patches, {one(), one()}).position;
      if (glm::dot(glm::vec3(place.x, place.y, place.z) - point, normal) > 0.0f) return true;
    }
    return false;
  }

  std::mt19937 random_{kSeed};
  Scene scene_;
};

INSTANTIATE_TEST_SUITE_P(Numbers, ManyLights, testing::Values(0, 5, 40, 1000));

std::uint32_t count_of(const Lights& lights) { return lights.environment_source() + 1; }

// Who asks all lights has the same ones, and nothing to choose from.
TEST_P(ManyLights, AreListedWithoutAChoice) {
  const Bvh bvh(scene_);
  const Lights chosen(scene_, bvh), all(scene_, bvh, Lights::Sampling::kAll);
  EXPECT_EQ(count_of(all), 0u);
  EXPECT_FALSE(all.any_power());
  ASSERT_EQ(all.count(), chosen.count());
  for (std::size_t i = 0; i < all.count(); ++i) {
    EXPECT_EQ(all.light(i).emission, chosen.light(i).emission);
    EXPECT_EQ(all.light(i).patches, chosen.light(i).patches);
  }
  EXPECT_EQ(all.ambient(), chosen.ambient());
}

// At places all over, among the lights too.
TEST_P(ManyLights, ChancesAreOneInAllAndNoLightThatBringsLightHasNone) {
  const Bvh bvh(scene_);
  const Lights lights(scene_, bvh);
  int bringing = 0;
  double all = 0.0;
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 point = place(), normal = way();
    double sum = 0.0;
    for (std::uint32_t source = 0; source < count_of(lights); ++source) {
      const float pmf = lights.pmf<float>(source, point, normal);
      sum += double{pmf};
      if (brings(lights, lights.source(source), point, normal)) {
        ++bringing;
        EXPECT_GT(pmf, 0.0f) << "seed " << kSeed << ", source " << source;
      }
    }
    EXPECT_LT(sum, 1.0 + 1e-5);
    all += sum;
  }
  EXPECT_GT(bringing, 50);
  // Less than 1 where a cluster may bring something and none of it does: spots, mostly.
  EXPECT_GT(all / 100, 0.7);
}

// What pmf() says is how often sample_source() gives it: for evenly spread u, off by the spread.
TEST_P(ManyLights, ArePickedAsOftenAsTheirChance) {
  const Bvh bvh(scene_);
  const Lights lights(scene_, bvh);
  constexpr int kPicks = 40000;
  for (int i = 0; i < 4; ++i) {
    const glm::vec3 point = place(), normal = way();
    std::vector<int> picked(count_of(lights));
    int none = 0;
    for (int k = 0; k < kPicks; ++k) {
      const auto choice = lights.sample_source<float>(point, normal, (k + 0.5) / kPicks);
      if (choice.source == kNoIndex) {
        ++none;
        continue;
      }
      ++picked[choice.source];
      ASSERT_NEAR(choice.pmf, lights.pmf<float>(choice.source, point, normal), 1e-5f * choice.pmf);
    }
    EXPECT_LT(none, kPicks);
    for (std::uint32_t source = 0; source < count_of(lights); ++source) {
      ASSERT_NEAR(picked[source], kPicks * lights.pmf<float>(source, point, normal), 1.01);
    }
  }
}

// The same bits, one child at a time and eight.
TEST_P(ManyLights, LanesChangeNoBit) {
  const Bvh bvh(scene_);
  const Lights lights(scene_, bvh);
  int cases = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 point = place(), normal = way();
    const double u = double{one()} * 0.999;
    const auto one_by_one = lights.sample_source<float>(point, normal, u);
    for (const Vectors vectors : machine_vectors()) {
      const UsingVectors in_use(vectors);
      in_vectors([&](auto code) RAYGATE_BODY {
        using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
        const auto choice = lights.sample_source<T>(point, normal, u);
        EXPECT_EQ(choice.source, one_by_one.source);
        EXPECT_EQ(choice.pmf, one_by_one.pmf);
        ++cases;
        return 0;
      });
    }
  }
  EXPECT_GE(cases, 2000);
}

TEST(LightTree, PrefersWhatIsNearAndFacesTheSurface) {
  std::vector<LightBounds> sources(64);
  for (std::size_t i = 0; i < sources.size(); ++i) {
    sources[i].middle = glm::dvec3(static_cast<double>(i), 1.0, 0.0);
    sources[i].power = 1.0;
  }
  const LightTree tree(sources);
  const glm::vec3 up(0, 1, 0);
  for (const float x : {3.0f, 20.0f, 50.0f}) {
    const auto here = static_cast<std::uint32_t>(x);
    EXPECT_GT(tree.pmf<float>(here, {x, 0, 0}, up), 0.25f) << "of 64";
    EXPECT_LT(tree.pmf<float>(here > 32 ? 0 : 63, {x, 0, 0}, up), 0.003f);
    EXPECT_EQ(tree.sample<float>({x, 0, 0}, -up, 0.5).source, kNoIndex) << "all are behind";
  }
}

/// Of all triangles, in their order, but for the last `others`.
std::vector<OuterSide> sides_of(const std::vector<Corners>& triangles, std::size_t others = 0) {
  const Scene scene = test::scene_of(triangles);
  const Bvh bvh(scene);
  std::vector<std::uint32_t> primitives(triangles.size());
  for (std::uint32_t primitive = 0; primitive < primitives.size(); ++primitive)
    primitives[bvh.triangle_of(primitive)] = primitive;
  primitives.resize(primitives.size() - others);
  return outer_sides(bvh, primitives);
}

TEST(OuterSides, OfEachSphereAreOutside) {
  std::vector<Corners> all = test::sphere(1, 1.0f, {0, 0, 0});
  const std::size_t count = all.size();
  for (Corners triangle : test::sphere(1, 1.0f, {5, 0, 0})) {
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
  std::vector<Corners> hole = test::sphere(1, 1.0f, {0, 0, 0}), torn = hole, full = hole;
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
