// Compares Fresnel's formulas, Snell's law and the lobes of materials with closed formulas, and
// microfacets with quadratures and the formulas of papers.
#include "host/light/bsdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "host/light/scattering.h"
#include "host/light/test/light_scenes.h"

namespace raygate {
namespace {

using std::numbers::pi;
using test::seen, test::triple;

const Triple<float> kUp = {0.0f, 0.0f, 1.0f};

glm::dvec3 vector(const Triple<float>& v) { return {v.x, v.y, v.z}; }

SquarePoint<float> point(int index, std::uint32_t stream = 0) {
  return random_point<float>(index, 7u, stream);
}

Triple<float> at_angles(double angle, double turn) {
  return {float(std::sin(angle) * std::cos(turn)), float(std::sin(angle) * std::sin(turn)),
          float(std::cos(angle))};
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

Material facets(float metallic, float roughness, float transmission = 0.0f) {
  Material material;
  material.diffuse = {1.0f, 0.5f, 0.1f};
  material.metallic_roughness = {metallic, roughness, transmission};
  return material;
}

/// Scattered fraction of white light from all sides: `sampled` by sample() and pdf(), `integral` by
/// fixed directions. `chosen`: fraction of samples that count; `density`: integral of pdf().
struct Balance {
  double sampled = 0.0, integral = 0.0, chosen = 0.0, density = 0.0;
  float off_unit = 0.0f;  // largest error of a sample's squared length
};

Balance balance(const Bsdf<float>& bsdf, int count = 1 << 14) {
  Balance sum;
  for (int i = 0; i < count; ++i) {
    const Triple<float> way = bsdf.sample(point(i, 1), point(i, 2).x);
    const auto counts = [&](float z) { return z > 0.0f || (bsdf.has_rough_glass() && z < 0.0f); };
    if (counts(way.z)) {
      sum.sampled += bsdf.eval(way).x * std::abs(way.z) / bsdf.pdf(way) / count;
      sum.chosen += 1.0 / count;
      sum.off_unit = std::max(sum.off_unit, std::abs(dot(way, way) - 1.0f));
    }
    const SquarePoint<float> u = point(i, 3);
    const Triple<float> fixed = at_angles(std::acos(2 * u.x - 1), 2 * pi * u.y);
    sum.integral += bsdf.eval(fixed).x * std::abs(fixed.z) * 4 * pi / count;
    if (counts(fixed.z)) sum.density += bsdf.pdf(fixed) * 4 * pi / count;
  }
  return sum;
}

// Uses the formulas in angles (Born and Wolf 1.5.2): sines and tangents, not the code's cosines.
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
      ASSERT_NEAR(reflectance, test::reflectance(angle, eta), 5e-5) << eta << " " << angle;
    }
    EXPECT_NEAR(fresnel_reflectance(1.0f, float(eta)), std::pow((eta - 1) / (eta + 1), 2), 1e-7);
    EXPECT_NEAR(fresnel_reflectance(0.0f, float(eta)), 1.0, 1e-7);
  }
  // At Brewster's angle one polarisation is not reflected.
  const double brewster = std::atan(1.5), beyond = std::asin(std::sin(brewster) / 1.5);
  EXPECT_NEAR(fresnel_reflectance(float(std::cos(brewster)), 1.5f),
              0.5 * std::pow(std::sin(brewster - beyond) / std::sin(brewster + beyond), 2), 1e-6);
}

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

// For all mixes of lobes, samples have the density pdf(). The integral of pdf() is the fraction of
// samples that count, and the mean of the samples is the integral of eval().
TEST(Bsdf, SamplesHaveTheDensityThatIsClaimed) {
  const auto check = [](const Balance& sum, double of_mean, double of_density,
                        const std::string& which) {
    EXPECT_NEAR(sum.sampled, sum.integral, of_mean) << which;
    EXPECT_NEAR(sum.chosen, sum.density, of_density) << which;
  };
  for (const float specular : {0.0f, 0.3f}) {
    for (const double angle : {0.0, 0.7, 1.3}) {
      const Balance sum = balance(seen(material(2, 0.5f, specular, 1.0f), angle), 1 << 16);
      check(sum, 2e-3, 5e-3, std::to_string(angle));
      EXPECT_LE(sum.off_unit, 2e-6f);
      EXPECT_TRUE(specular > 0.0f || std::abs(sum.sampled - 0.5) < 1e-6);
    }
  }
  for (const float transmission : {0.0f, 0.5f, 1.0f}) {
    for (const double angle : {0.2, 1.0}) {
      for (const bool outside : {true, false}) {
        check(balance(seen(facets(0.3f, 0.7f, transmission), angle, outside)), 0.01, 0.01,
              std::to_string(transmission));
      }
    }
  }
}

// Even the narrowest lobes have the right height, and their samples are within the lobe.
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
      const Triple<float> light = bsdf.sample(point(i));
      const glm::dvec3 mirror(-std::sin(0.6), 0.0, std::cos(0.6));
      ASSERT_LT(glm::length(vector(light) - mirror), 6.0 / std::sqrt(exponent));
    }
  }
}

// For any material, the albedos of all lobes add up to at most 1.
TEST(Bsdf, NoMaterialMakesEnergy) {
  for (int model = 1; model <= 10; ++model) {
    for (const float colour : {0.0f, 0.4f, 1.0f, 3.0f}) {
      for (const float opacity : {0.0f, 0.5f, 1.0f}) {
        for (const double angle : {0.0, 0.8, 1.5}) {
          const Bsdf<float> bsdf = seen(material(model, colour, colour, opacity), angle);
          const Triple<float> sum = bsdf.diffuse + bsdf.glossy + bsdf.mirror + bsdf.transmission;
          EXPECT_LE(largest(sum), 1.0f + 1e-6f) << model << " " << colour;
          EXPECT_GE(std::min({bsdf.transmission.x, bsdf.diffuse.x, bsdf.mirror.x}), 0.0f);
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
  EXPECT_EQ(of(0, 1).diffuse.x, 0.0f);
  EXPECT_NEAR(of(0, 1).unlit.x, 0.4, 1e-7);
  EXPECT_NEAR(of(1, 1).diffuse.x, 0.4, 1e-7);
  EXPECT_EQ(of(1, 1).glossy.x, 0.0f);
  EXPECT_NEAR(of(1, 0.25f).diffuse.x, 0.1, 1e-7);
  EXPECT_NEAR(of(1, 0.25f).transmission.z, 0.75, 1e-7) << "straight, and not tinted";
  EXPECT_NEAR(of(2, 1).glossy.x, 0.2, 1e-7);
  EXPECT_NEAR(of(3, 1).mirror.x, 0.2, 1e-7);
  EXPECT_NEAR(of(4, 0.5f).transmission.x, 0.5 * 0.9 * 0.8, 1e-7);
  EXPECT_FALSE(of(4, 0.5f).is_refracting);
  EXPECT_NEAR(of(5, 1).mirror.x, 0.2 + 0.8 * std::pow(1 - std::cos(0.6), 5), 1e-7);
  EXPECT_TRUE(of(6, 0).is_refracting);
  EXPECT_NEAR(of(6, 0).transmission.x, 0.9 * 0.8, 1e-7);
  EXPECT_NEAR(of(7, 0).mirror.x, fresnel, 1e-6);
  EXPECT_NEAR(of(7, 0).transmission.x, (1 - fresnel) * 0.9, 1e-6);
  EXPECT_EQ(of(7, 1).transmission.x, of(7, 0).transmission.x)
      << "d 1 of a glass is left there by exporters";
  EXPECT_EQ(of(8, 1).mirror.x, of(3, 1).mirror.x);
  EXPECT_EQ(of(9, 0.5f).transmission.x, of(4, 0.5f).transmission.x);
  EXPECT_NEAR(of(10, 1).diffuse.x, 0.4, 1e-7);
}

// The projected areas of all facets add up to the surface's area.
TEST(Ggx, FacetsAddUpToTheSurface) {
  for (const float alpha : {0.01f, 0.1f, 0.5f, 1.0f}) {
    const Ggx<float> ggx(kUp, alpha);
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      // Even steps in t, with tan(angle) / alpha = t / (1 - t), suit lobes of all widths.
      const double t = (i + 0.5) / kSteps, tangent = alpha * t / (1 - t);
      const double angle = std::atan(tangent), slope = alpha / ((1 - t) * (1 - t));
      const Triple<float> normal = at_angles(angle, 1.0);
      const double height = ggx.pair(normal, normal).d;
      sum += height * std::cos(angle) * std::sin(angle) * 2 * pi * slope / (1 + tangent * tangent) /
             kSteps;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << alpha;
  }
}

// Compares means over samples with integrals that use the pdf.
TEST(Ggx, SamplesHaveTheDensityThatIsClaimed) {
  for (const float alpha : {0.2f, 0.5f, 1.0f}) {
    for (const double angle : {0.0, 0.7, 1.4}) {
      const Ggx<float> ggx(kUp, alpha);
      const Triple<float> view = at_angles(angle, 0.5);
      constexpr int kCount = 1 << 16;
      double sampled[3] = {}, integral[3] = {};
      for (int i = 0; i < kCount; ++i) {
        const auto add = [](double(&sums)[3], const Triple<float>& way, double weight) {
          if (way.z <= 0.0f) return;
          sums[0] += weight;
          sums[1] += weight * way.z * way.z;
          sums[2] += weight * (way.x - 0.3) * way.y;
        };
        add(sampled, reflect(view, ggx.sample(view, point(i))), 1.0);
        const SquarePoint<float> u = point(i, 1);
        const Triple<float> way = at_angles(std::acos(u.x), 2 * pi * u.y);
        add(integral, way, 2 * pi * ggx.reflection_pdf(view.z, ggx.pair(view, way).d));
      }
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(sampled[k] / kCount, integral[k] / kCount, 6e-3) << alpha << " " << angle;
      }
    }
  }
}

TEST(MetallicRoughnessLobes, AreTheSameThereAndBack) {
  for (const float roughness : {0.1f, 0.4f, 1.0f}) {
    for (const float metallic : {0.0f, 0.3f, 1.0f}) {
      for (int i = 0; i < 200; ++i) {
        const SquarePoint<float> u = point(i);
        const double a = 1.5 * u.x, b = 1.5 * u.y;
        const Material material = facets(metallic, roughness);
        // Both views are in the plane of x and z.
        const Bsdf<float> there = seen(material, a), back = seen(material, b);
        const Triple<float> f = there.eval(at_angles(b, 2.0)), g = back.eval(at_angles(a, -2.0));
        ASSERT_NEAR(f.x, g.x, 1e-4f * f.x + 1e-6f) << roughness << " " << metallic;
        ASSERT_NEAR(f.z, g.z, 1e-4f * f.z + 1e-6f);
      }
    }
  }
}

// By KHR_materials_specular, facets of weight 0 reflect nothing, and the specular colour is the
// colour of reflection at normal incidence.
TEST(MetallicRoughnessLobes, ReflectBySpecularWeightAndColor) {
  Material material = facets(0.0f, 0.3f);
  const Triple<float> plain = seen(material, 0.0).facets.f0;
  material.metallic_roughness->specular_color = {1.0f, 0.5f, 0.0f};
  const Triple<float> colored = seen(material, 0.0).facets.f0;
  EXPECT_EQ(colored.x, plain.x);
  EXPECT_EQ(colored.y, 0.5f * plain.x);
  EXPECT_EQ(colored.z, 0.0f);
  material.metallic_roughness->specular = 0.0f;
  for (const double angle : {0.0, 1.4}) {
    const Triple<float> none = seen(material, angle).glossy;
    EXPECT_EQ(none.x, 0.0f);
    EXPECT_EQ(none.z, 0.0f);
  }
}

// White furnace: surfaces that absorb nothing return all light, within 1 %. Tests facets over a
// base, metal, and rough glass from either side.
TEST(MetallicRoughnessLobes, KeepAllLight) {
  const struct {
    float metallic, transmission;
    bool outside;
  } kCases[] = {{0.0f, 0.0f, true},
                {0.5f, 0.0f, true},
                {1.0f, 0.0f, true},
                {0.0f, 1.0f, true},
                {0.0f, 1.0f, false}};
  double worst = 0.0;
  for (const auto& [metallic, transmission, outside] : kCases) {
    for (const float roughness : {0.04f, 0.1f, 0.2f, 0.4f, 0.7f, 1.0f}) {
      for (const float index : {1.1f, 1.5f, 2.5f}) {
        for (double angle = 0.0; angle < 1.5; angle += 0.25) {
          Material white = test::facets(metallic, roughness, transmission);
          white.refraction_index = index;
          const Bsdf<float> bsdf = seen(white, angle, outside);
          const double all = balance(bsdf).sampled;
          EXPECT_NEAR(all, 1.0, 1e-2) << metallic << " " << transmission << " " << outside << " "
                                      << roughness << " " << index << " " << angle;
          if (transmission == 0.0f) {
            EXPECT_NEAR(largest(bsdf.diffuse + bsdf.glossy), all, 1e-2);
          }
          worst = std::max(worst, std::abs(all - 1.0));
        }
      }
    }
  }
  std::cout << "off by up to " << 100 * worst << " %\n";
}

// Smooth surfaces reflect in one direction only, so no light is lost between facets.
TEST(MetallicRoughnessLobes, SmoothOnesLoseNothing) {
  for (const float metallic : {0.0f, 0.5f, 1.0f}) {
    Material white = test::facets(metallic, 0.0f, 0.0f);
    for (const double angle : {0.0, 0.8, 1.5}) {
      const Bsdf<float> bsdf = seen(white, angle);
      EXPECT_NEAR(largest(bsdf.mirror + bsdf.diffuse), 1.0, 1e-6);
      EXPECT_EQ(largest(bsdf.glossy), 0.0f);
      double diffuse = 0.0;
      for (int i = 0; i < 4096; ++i) {
        const Triple<float> light = bsdf.sample(point(i));
        diffuse += bsdf.eval(light).x * light.z / bsdf.pdf(light) / 4096;
      }
      EXPECT_NEAR(diffuse, bsdf.diffuse.x, 1e-3);
    }
    white.metallic_roughness->transmission = 0.7f;
    const Bsdf<float> clear = seen(white, 0.8);
    EXPECT_NEAR(largest(clear.mirror + clear.transmission + clear.diffuse), 1.0, 1e-6);
  }
}

/// Returns the BTDF of Walter and others (equation 21) times the cosine, for light along `in` that
/// leaves along `out` beyond a surface with normal +z. Masking is separable (equation 34).
double walter(const glm::dvec3& in, const glm::dvec3& out, double alpha, double eta) {
  glm::dvec3 half = -glm::normalize(in + eta * out);
  if (half.z < 0.0) half = -half;
  const double ih = glm::dot(in, half), oh = glm::dot(out, half);
  if (ih <= 0.0 || oh >= 0.0) return 0.0;
  const double squared = (half.z * half.z) * (alpha * alpha - 1.0) + 1.0;
  const double height = alpha * alpha / (pi * squared * squared);
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
    for (const bool outside : {true, false}) {
      for (const double angle : {0.1, 0.9}) {
        Material glass = facets(0.0f, 0.6f, 1.0f);
        glass.refraction_index = index;
        const Bsdf<float> bsdf = seen(glass, angle, outside);
        const MetallicRoughnessLobes<float>& lobes = bsdf.facets;
        const glm::dvec3 in(lobes.view.x, lobes.view.y, lobes.view.z);
        int count = 0;
        for (int i = 0; i < 400; ++i) {
          const SquarePoint<float> u = point(i);
          const Triple<float> way = at_angles(std::acos(-0.01 - 0.99 * u.x), 2 * pi * u.y);
          const double expected = walter(in, {way.x, way.y, way.z}, 0.36, lobes.eta) / -way.z;
          const Triple<float> value = bsdf.eval(way);
          ASSERT_NEAR(value.y, 0.5 * lobes.glass_gain * expected, 2e-4 * expected + 1e-6);
          ASSERT_NEAR(value.z, 0.2 * value.y, 1e-5 * value.y) << "in the base colour";
          count += expected > 0.01;
        }
        EXPECT_GT(count, 30);
      }
    }
  }
}

// Compares the table with integrals over light directions; the table integrates over facets.
TEST(FacetAlbedo, IsTheIntegralOfTheLobe) {
  double worst = 0.0;
  for (const float alpha : {0.05f, 0.2f, 0.5f, 0.9f}) {
    for (const float cosine : {0.06f, 0.2f, 0.5f, 0.9f, 1.0f}) {
      const Ggx<float> ggx(kUp, alpha);
      const double angle = std::acos(cosine);
      const Triple<float> view = at_angles(angle, 0.0);
      constexpr int kSteps = 1200;
      double all = 0.0, fresnel = 0.0;
      for (int i = 0; i < kSteps; ++i) {
        for (int k = 0; k < kSteps; ++k) {
          // Cubes make the points denser around the mirror direction, (angle, pi).
          const double t = 2 * (i + 0.5) / kSteps - 1, u = (k + 0.5) / kSteps;
          const double reach = t < 0 ? angle : pi / 2 - angle;
          const double theta = angle + reach * t * t * t, turn = pi * (1 - u * u * u);
          const double area =
              3 * t * t * reach * 2.0 / kSteps * 3 * u * u * pi * 2.0 / kSteps * std::sin(theta);
          const Triple<float> light = at_angles(theta, turn);
          const auto pair = ggx.pair(view, light);
          const double value = double(pair.d) * ggx.visibility(view.z, light.z) * light.z * area;
          all += value;
          fresnel += value * schlick_weight(pair.cos_half);
        }
      }
      const auto shares = FacetAlbedo::of_mirrors().at(cosine, alpha);
      EXPECT_NEAR(shares.first, all, 1e-2) << alpha << " " << cosine;
      EXPECT_NEAR(shares.second, fresnel, 1e-2) << alpha << " " << cosine;
      worst = std::max(worst, std::abs(shares.first - all));
    }
  }
  std::cout << "off by up to " << worst << "\n";
}

}  // namespace
}  // namespace raygate
