// Facets against quadratures, and against the formulas of the paper.
#include "host/light/metallic_roughness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/light/bsdf.h"
#include "host/light/test/seen.h"

namespace raygate {
namespace {

using test::seen;

constexpr double kPi = std::numbers::pi;
const Triple<float> kUp = {0.0f, 0.0f, 1.0f};

Triple<float> at_angles(double angle, double turn) {
  return {float(std::sin(angle) * std::cos(turn)), float(std::sin(angle) * std::sin(turn)),
          float(std::cos(angle))};
}

Material facets(float metallic, float roughness, float transmission = 0.0f) {
  Material material;
  material.diffuse = {1.0f, 0.5f, 0.1f};
  material.metallic_roughness = {metallic, roughness, transmission, {}, {}};
  return material;
}

// Facets cover the surface once, seen from above.
TEST(Ggx, FacetsAddUpToTheSurface) {
  for (const float alpha : {0.01f, 0.1f, 0.5f, 1.0f}) {
    const Ggx<float> ggx(kUp, alpha);
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      // By the tangent over alpha, t / (1 - t): lobes of all widths fill it.
      const double t = (i + 0.5) / kSteps, tangent = alpha * t / (1 - t);
      const double angle = std::atan(tangent), slope = alpha / ((1 - t) * (1 - t));
      const Triple<float> normal = at_angles(angle, 1.0);
      const double height = ggx.pair(normal, normal).d;
      sum += height * std::cos(angle) * std::sin(angle) * 2 * kPi * slope /
             (1 + tangent * tangent) / kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << alpha;
  }
}

// The mean over samples against an integral with the pdf that is claimed.
TEST(Ggx, SamplesHaveTheDensityThatIsClaimed) {
  for (const float alpha : {0.2f, 0.5f, 1.0f}) {
    for (const double angle : {0.0, 0.7, 1.4}) {
      const Ggx<float> ggx(kUp, alpha);
      const Triple<float> view = at_angles(angle, 0.5);
      const Sampler sampler(1, 2, 3);
      constexpr int kCount = 1 << 16;
      double sampled[3] = {}, integral[3] = {};
      for (int i = 0; i < kCount; ++i) {
        const auto add = [](double(&sums)[3], const Triple<float>& way, double weight) {
          if (way.z <= 0.0f) return;
          sums[0] += weight;
          sums[1] += weight * way.z * way.z;
          sums[2] += weight * (way.x - 0.3) * way.y;
        };
        add(sampled, reflect(view, ggx.sample(view, sampler(i, 0))), 1.0);
        const SquarePoint<float> u = sampler(i, 1);
        const Triple<float> way = at_angles(std::acos(u.x), 2 * kPi * u.y);
        add(integral, way, 2 * kPi * ggx.reflection_pdf(view.z, ggx.pair(view, way).d));
      }
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(sampled[k] / kCount, integral[k] / kCount, 6e-3) << alpha << " " << angle;
      }
    }
  }
}

TEST(MetallicRoughnessLobes, AreTheSameThereAndBack) {
  const Sampler sampler(4, 5, 6);
  for (const float roughness : {0.1f, 0.4f, 1.0f}) {
    for (const float metallic : {0.0f, 0.3f, 1.0f}) {
      for (int i = 0; i < 200; ++i) {
        const SquarePoint<float> u = sampler(i, 0);
        const double a = 1.5 * u.x, b = 1.5 * u.y;
        // Both have their view in the plane of x and z.
        const Bsdf<float> there = seen(facets(metallic, roughness), a);
        const Bsdf<float> back = seen(facets(metallic, roughness), b);
        const Triple<float> f = there.eval(at_angles(b, 2.0)), g = back.eval(at_angles(a, -2.0));
        ASSERT_NEAR(f.x, g.x, 1e-4f * f.x + 1e-6f) << roughness << " " << metallic;
        ASSERT_NEAR(f.z, g.z, 1e-4f * f.z + 1e-6f);
      }
    }
  }
}

// KHR_materials_specular: without weight facets reflect nothing; its colour is that of what they
// reflect straight on.
TEST(MetallicRoughnessLobes, ReflectBySpecularWeightAndColor) {
  Material material = facets(0.0f, 0.3f);
  const Triple<float> plain = seen(material, 0.0).facets().f0;
  material.metallic_roughness->specular_color = {1.0f, 0.5f, 0.0f};
  const Triple<float> colored = seen(material, 0.0).facets().f0;
  EXPECT_EQ(colored.x, plain.x);
  EXPECT_EQ(colored.y, 0.5f * plain.x);
  EXPECT_EQ(colored.z, 0.0f);
  material.metallic_roughness->specular = 0.0f;
  for (const double angle : {0.0, 1.4}) {
    const Triple<float> none = seen(material, angle).glossy();
    EXPECT_EQ(none.x, 0.0f);
    EXPECT_EQ(none.z, 0.0f);
  }
}

// The white furnace: of light from all sides no more comes back than was there. What facets hide
// from each other is missing.
TEST(MetallicRoughnessLobes, MakeNoEnergy) {
  for (const float roughness : {0.04f, 0.2f, 0.4f, 0.6f, 0.8f, 1.0f}) {
    double most_lost = 0.0;
    for (const float index : {1.1f, 1.5f, 2.5f}) {
      for (const float metallic : {0.0f, 0.5f, 1.0f}) {
        for (double angle = 0.0; angle < 1.56; angle += 0.11) {
          Material white = facets(metallic, roughness);
          white.diffuse = glm::vec3(1.0f);
          white.refraction_index = index;
          const Bsdf<float> bsdf = seen(white, angle);
          const MetallicRoughnessLobes<float>& lobes = bsdf.facets();
          constexpr int kCount = 1 << 12;
          double reflected = 0.0, all = 0.0;
          for (int i = 0; i < kCount; ++i) {
            const Triple<float> facet = lobes.ggx.sample(lobes.view, Sampler(7, 8, 9)(i, 0));
            const Triple<float> way = reflect(lobes.view, facet);
            const float share = schlick_weight(dot(lobes.view, facet));
            reflected += lobes.schlick(share).x * lobes.g2_over_g1(way);
            const Triple<float> light = bsdf.sample(Sampler(7, 8, 9)(i, 1));
            if (light.z <= 0.0f) continue;
            all += bsdf.eval(light).x * light.z / bsdf.pdf(light);
          }
          reflected /= kCount;
          all /= kCount;
          // Also what is left for under the facets rests on this.
          EXPECT_LE(reflected, lobes.specular.x + 4e-4)
              << roughness << " " << index << " " << angle;
          EXPECT_NEAR(all, reflected + lobes.diffuse.x, 1e-2);
          EXPECT_LE(all, 1.003) << roughness << " " << index << " " << metallic << " " << angle;
          most_lost = std::max(most_lost, 1.0 - all);
        }
      }
    }
    std::cout << "roughness " << roughness << ": up to " << 100 * most_lost << " % lost\n";
    EXPECT_LE(most_lost, roughness <= 0.2f ? 0.15 : roughness <= 0.4f ? 0.2 : 0.7);
  }
}

// Smooth ones reflect all that they do in one direction, and nothing is missing.
TEST(MetallicRoughnessLobes, SmoothOnesLoseNothing) {
  for (const float metallic : {0.0f, 0.5f, 1.0f}) {
    Material white = facets(metallic, 0.0f);
    white.diffuse = glm::vec3(1.0f);
    for (const double angle : {0.0, 0.8, 1.5}) {
      const Bsdf<float> bsdf = seen(white, angle);
      EXPECT_NEAR(largest(bsdf.mirror() + bsdf.diffuse()), 1.0, 1e-6);
      EXPECT_EQ(largest(bsdf.glossy()), 0.0f);
      double diffuse = 0.0;
      for (int i = 0; i < 4096; ++i) {
        const Triple<float> light = bsdf.sample(Sampler(1, 1, 1)(i, 0));
        diffuse += bsdf.eval(light).x * light.z / bsdf.pdf(light) / 4096;
      }
      EXPECT_NEAR(diffuse, bsdf.diffuse().x, 1e-3);
    }
    white.metallic_roughness->transmission = 0.7f;
    const Bsdf<float> clear = seen(white, 0.8);
    EXPECT_NEAR(largest(clear.mirror() + clear.transmission() + clear.diffuse()), 1.0, 1e-6);
  }
}

/// Equation 21 of Walter and others times the cosine: of light along `in` that comes out along
/// `out`, on the other side of a surface whose normal is +z. Separable masking, equation 34.
double walter(const glm::dvec3& in, const glm::dvec3& out, double alpha, double eta) {
  glm::dvec3 half = -glm::normalize(in + eta * out);
  if (half.z < 0.0) half = -half;
  const double ih = glm::dot(in, half), oh = glm::dot(out, half);
  if (ih <= 0.0 || oh >= 0.0) return 0.0;
  const double squared = (half.z * half.z) * (alpha * alpha - 1.0) + 1.0;
  const double height = alpha * alpha / (kPi * squared * squared);
  const auto masking = [&](double z) {
    const double tangent2 = (1.0 - z * z) / (z * z);
    return 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * tangent2));
  };
  const double below = ih + eta * oh;
  const double fresnel = fresnel_reflectance(float(ih), float(eta));
  return ih * -oh / in.z * eta * eta * (1.0 - fresnel) * masking(in.z) * masking(out.z) * height /
         (below * below);
}

TEST(MetallicRoughnessLobes, RoughGlassIsThatOfWalterAndOthers) {
  for (const float index : {1.5f, 1.3f}) {
    for (const double angle : {0.1, 0.9}) {
      Material glass = facets(0.0f, 0.6f, 1.0f);
      glass.diffuse = glm::vec3(1.0f);
      glass.refraction_index = index;
      const MetallicRoughnessLobes<float> lobes = seen(glass, angle).facets();
      constexpr int kCount = 1 << 16, kSteps = 600;
      glm::dvec3 sampled(0.0), integral(0.0);
      const auto tested = [](const glm::dvec3& way) {
        return glm::dvec3(1.0, way.z * way.z, (way.x + 0.2) * (way.x + 0.2));
      };
      for (int i = 0; i < kCount; ++i) {
        const auto facet = lobes.sample_glass_facet(Sampler(1, 2, 4)(i, 0));
        const Refraction<float> bent(lobes.view, facet.normal, lobes.eta);
        if (!bent.exists) continue;
        const glm::dvec3 way(bent.direction.x, bent.direction.y, bent.direction.z);
        sampled += tested(way) * double((1 - facet.reflectance) * lobes.g1(bent.direction));
      }
      const glm::dvec3 in(lobes.view.x, lobes.view.y, lobes.view.z);
      for (int i = 0; i < kSteps; ++i) {
        for (int k = 0; k < kSteps; ++k) {
          const double z = -(i + 0.5) / kSteps, turn = 2 * kPi * (k + 0.5) / kSteps;
          const double across = std::sqrt(1 - z * z);
          const glm::dvec3 out(across * std::cos(turn), across * std::sin(turn), z);
          integral += tested(out) * walter(in, out, 0.36, lobes.eta) * (2 * kPi / kSteps / kSteps);
        }
      }
      sampled /= kCount;
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(sampled[k], integral[k], 4e-3) << index << " " << angle;
      EXPECT_GT(sampled.x, 0.5);
    }
  }
}

// From either side. What is lost meets a second facet.
TEST(MetallicRoughnessLobes, RoughGlassLosesWhatMeetsASecondFacet) {
  for (const float roughness : {0.04f, 0.2f, 0.4f, 0.7f, 1.0f}) {
    double most_lost = 0.0;
    for (const bool outside : {true, false}) {
      for (double angle = 0.0; angle < 1.5; angle += 0.1) {
        Material glass = facets(0.0f, roughness, 1.0f);
        glass.diffuse = glm::vec3(1.0f);
        MetallicRoughnessLobes<float> lobes = seen(glass, angle).facets();
        if (!outside) lobes.eta = 1.0f / lobes.eta;
        double all = 0.0;
        constexpr int kCount = 1 << 12;
        for (int i = 0; i < kCount; ++i) {
          const auto facet = lobes.sample_glass_facet(Sampler(1, 2, 4)(i, 0));
          const Refraction<float> bent(lobes.view, facet.normal, lobes.eta);
          all += facet.reflectance * lobes.g2_over_g1(reflect(lobes.view, facet.normal));
          if (bent.exists) all += (1 - facet.reflectance) * lobes.g1(bent.direction);
        }
        all /= kCount;
        EXPECT_LE(all, 1.0 + 1e-5) << roughness << " " << angle;
        most_lost = std::max(most_lost, 1.0 - all);
      }
    }
    std::cout << "roughness " << roughness << ": up to " << 100 * most_lost << " % lost\n";
    EXPECT_LE(most_lost, roughness <= 0.2f ? 0.05 : roughness <= 0.4f ? 0.2 : 0.7);
  }
}

}  // namespace
}  // namespace raygate
