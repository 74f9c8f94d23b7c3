// Fresnel, Snell and the lobes of materials against their formulas.
#include "host/light/bsdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/light/sampler.h"
#include "host/light/scattering.h"
#include "host/light/test/seen.h"

namespace raygate {
namespace {

using test::seen;
using test::triple;

using std::numbers::pi;

// The formulas in angles (Born and Wolf 1.5.2): sines and tangents, not the cosines of the code.
TEST(Fresnel, IsTheFormulaInAngles) {
  for (const double eta : {1.5, 1.0 / 1.5, 1.33, 2.4, 1.0 / 2.4}) {
    for (double angle = 0.01; angle < pi / 2; angle += 0.01) {
      const double sine = std::sin(angle) / eta;
      const float reflectance = fresnel_reflectance(float(std::cos(angle)), float(eta));
      if (std::abs(sine - 1.0) < 1e-6) continue;  // the border of total reflection
      if (sine > 1.0) {
        ASSERT_EQ(reflectance, 1.0f);
        continue;
      }
      const double beyond = std::asin(sine);
      const double across = std::sin(angle - beyond) / std::sin(angle + beyond);
      const double parallel = std::tan(angle - beyond) / std::tan(angle + beyond);
      ASSERT_NEAR(reflectance, 0.5 * (across * across + parallel * parallel), 5e-5)
          << eta << " " << angle;
    }
    EXPECT_NEAR(fresnel_reflectance(1.0f, float(eta)), std::pow((eta - 1) / (eta + 1), 2), 1e-7);
    EXPECT_NEAR(fresnel_reflectance(0.0f, float(eta)), 1.0, 1e-7);
  }
  // At Brewster's angle nothing of one polarisation is reflected.
  const double brewster = std::atan(1.5), beyond = std::asin(std::sin(brewster) / 1.5);
  EXPECT_NEAR(fresnel_reflectance(float(std::cos(brewster)), 1.5f),
              0.5 * std::pow(std::sin(brewster - beyond) / std::sin(brewster + beyond), 2), 1e-6);
}

glm::dvec3 vector(const Triple<float>& v) { return {v.x, v.y, v.z}; }

TEST(Fresnel, RefractionIsSnellsLaw) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(1, 2, -0.5));
  const glm::dvec3 tangent = glm::normalize(glm::cross(normal, glm::dvec3(0, 0, 1)));
  for (const double eta : {1.5, 1.0 / 1.5, 1.0}) {
    for (double angle = 0.0; angle < pi / 2; angle += 0.05) {
      const glm::dvec3 in = std::sin(angle) * tangent - std::cos(angle) * normal;
      const Refraction<float> refraction(triple(-in), triple(normal), float(eta));
      ASSERT_EQ(refraction.exists, std::sin(angle) < eta) << eta << " " << angle;
      if (!refraction.exists) continue;
      const glm::dvec3 out = vector(refraction.direction);
      EXPECT_NEAR(glm::length(out), 1.0, 1e-5);
      EXPECT_NEAR(glm::length(glm::cross(out, normal)), std::sin(angle) / eta, 1e-6);
      EXPECT_LT(glm::dot(out, normal), 0.0);
      EXPECT_GE(glm::dot(out, tangent), 0.0) << "on in the same direction";
      EXPECT_NEAR(glm::dot(out, glm::cross(normal, tangent)), 0.0, 1e-6) << "out of the plane";
    }
  }
}

Material material(int model, float diffuse, float specular, float opacity) {
  Material m;
  m.illumination_model = model;
  m.diffuse = glm::vec3(diffuse, 0.5f * diffuse, 0.0f);
  m.specular = glm::vec3(specular);
  m.shininess = 20.0f;
  m.refraction_index = 1.5f;
  m.opacity = opacity;
  m.transmittance = glm::vec3(0.9f, 1.0f, 0.8f);
  return m;
}

// Sampled by its own pdf, a lobe's mean is what it reflects; and pdfs integrate to what
// lies above the surface.
TEST(Bsdf, SamplesHaveTheDensityThatIsClaimed) {
  for (const float specular : {0.0f, 0.3f}) {
    for (const double angle : {0.0, 0.7, 1.3}) {
      const Bsdf<float> bsdf = seen(material(2, 0.5f, specular, 1.0f), angle);
      const Sampler sampler(1, 2, 3);
      // The mean of f cos / p over samples against a plain integral of f cos over the hemisphere.
      constexpr int kCount = 1 << 16;
      double sampled = 0.0, integral = 0.0, pdf = 0.0, above = 0.0;
      for (int i = 0; i < kCount; ++i) {
        const Triple<float> way = bsdf.sample(sampler(i, 0));
        EXPECT_NEAR(dot(way, way), 1.0f, 2e-6f);
        above += way.z > 0.0f;
        if (way.z > 0.0f) sampled += bsdf.eval(way).x * way.z / bsdf.pdf(way);
        const SquarePoint<float> u = sampler(i, 1);
        const double sine = std::sqrt(1.0 - double(u.x) * u.x);
        const Triple<float> uniform = {float(sine * std::cos(2 * pi * u.y)),
                                       float(sine * std::sin(2 * pi * u.y)), u.x};
        integral += bsdf.eval(uniform).x * uniform.z * 2 * pi;
        pdf += bsdf.pdf(uniform) * 2 * pi;
      }
      EXPECT_NEAR(sampled / kCount, integral / kCount, 2e-3);
      EXPECT_NEAR(pdf / kCount, above / kCount, 5e-3);
      EXPECT_TRUE(specular > 0.0f || std::abs(sampled / kCount - 0.5) < 1e-6);
    }
  }
}

// A lobe as narrow as can be still has the height that it is to have, and is sampled within it.
TEST(Bsdf, NarrowLobesKeepTheirShape) {
  Material polished = material(2, 0.0f, 1.0f, 1.0f);
  for (const float exponent : {1e3f, 1e5f, 1e6f}) {
    polished.shininess = exponent;
    const Bsdf<float> bsdf = seen(polished, 0.6);
    for (const double angle : {0.0, 1e-4, 3e-4, 1e-3}) {
      const double away = 0.6 + angle;
      const Triple<float> light = triple({-std::sin(away), 0.0, std::cos(away)});
      const double expected = (exponent + 2) / (2 * pi) * std::pow(std::cos(angle), exponent);
      EXPECT_NEAR(bsdf.eval(light).x, expected, 2e-2 * expected + 1e-30) << angle;
    }
    for (int i = 0; i < 1000; ++i) {
      const Triple<float> light = bsdf.sample(Sampler(4, 5, 6)(i, 0));
      const glm::dvec3 mirror(-std::sin(0.6), 0.0, std::cos(0.6));
      ASSERT_LT(glm::length(vector(light) - mirror), 6.0 / std::sqrt(exponent));
    }
  }
}

// Whatever the material says, all shares together are at most what arrives.
TEST(Bsdf, NoMaterialMakesEnergy) {
  for (int model = 1; model <= 10; ++model) {
    for (const float colour : {0.0f, 0.4f, 1.0f, 3.0f}) {
      for (const float opacity : {0.0f, 0.5f, 1.0f}) {
        for (const double angle : {0.0, 0.8, 1.5}) {
          const Bsdf<float> bsdf = seen(material(model, colour, colour, opacity), angle);
          const Triple<float> sum =
              bsdf.diffuse() + bsdf.glossy() + bsdf.mirror() + bsdf.transmission();
          EXPECT_LE(largest(sum), 1.0f + 1e-6f) << model << " " << colour;
          EXPECT_GE(std::min({bsdf.transmission().x, bsdf.diffuse().x, bsdf.mirror().x}), 0.0f);
        }
      }
    }
  }
}

TEST(Bsdf, EachIllumDoesWhatItsTableSays) {
  const auto of = [](int model, float opacity) {
    return seen(material(model, 0.4f, 0.2f, opacity), 0.6);
  };
  const double fresnel = fresnel_reflectance(float(std::cos(0.6)), 1.5f);
  EXPECT_EQ(of(0, 1).diffuse().x, 0.0f);
  EXPECT_NEAR(of(0, 1).unlit().x, 0.4, 1e-7);
  EXPECT_NEAR(of(1, 1).diffuse().x, 0.4, 1e-7);
  EXPECT_EQ(of(1, 1).glossy().x, 0.0f);
  EXPECT_NEAR(of(1, 0.25f).diffuse().x, 0.1, 1e-7);
  EXPECT_NEAR(of(1, 0.25f).transmission().z, 0.75, 1e-7) << "straight, and not tinted";
  EXPECT_NEAR(of(2, 1).glossy().x, 0.2, 1e-7);
  EXPECT_NEAR(of(3, 1).mirror().x, 0.2, 1e-7);
  EXPECT_NEAR(of(4, 0.5f).transmission().x, 0.5 * 0.9 * 0.8, 1e-7);
  EXPECT_FALSE(of(4, 0.5f).is_refracting());
  EXPECT_NEAR(of(5, 1).mirror().x, 0.2 + 0.8 * std::pow(1 - std::cos(0.6), 5), 1e-7);
  EXPECT_TRUE(of(6, 0).is_refracting());
  EXPECT_NEAR(of(6, 0).transmission().x, 0.9 * 0.8, 1e-7);
  EXPECT_NEAR(of(7, 0).mirror().x, fresnel, 1e-6);
  EXPECT_NEAR(of(7, 0).transmission().x, (1 - fresnel) * 0.9, 1e-6);
  EXPECT_EQ(of(7, 1).transmission().x, of(7, 0).transmission().x)
      << "d 1 of a glass is left there by exporters";
  EXPECT_FALSE(of(8, 1).mirror_is_traced());
  EXPECT_FALSE(of(9, 1).mirror_is_traced());
  EXPECT_NEAR(of(10, 1).diffuse().x, 0.4, 1e-7);
}

}  // namespace
}  // namespace raygate
