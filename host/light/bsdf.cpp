#include "host/light/bsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/light/fresnel.h"
#include "host/light/orthonormal.h"

namespace raygate {
namespace {

constexpr double kPi = std::numbers::pi;

bool is_glass(int model) { return model == 4 || model == 6 || model == 7 || model == 9; }
bool refracts(int model) { return model == 6 || model == 7; }

double opacity(const Material& material) {
  const double d = std::clamp(static_cast<double>(material.opacity), 0.0, 1.0);
  return is_glass(material.illumination_model) && d == 1.0 ? 0.0 : d;
}

glm::dvec3 limited(const glm::vec3& colour) {
  return glm::clamp(glm::dvec3(colour), glm::dvec3(0.0), glm::dvec3(1.0));
}

}  // namespace

Bsdf::Bsdf(const Surface& surface) : view_(surface.view), normal_(surface.normal) {
  const Material& material = *surface.material;
  const int model = material.illumination_model;
  const double d = opacity(material), cosine = std::max(0.0, glm::dot(normal_, view_));
  const glm::dvec3 ks = limited(material.specular);
  exponent_ = std::clamp(static_cast<double>(material.shininess), 0.0, 1e6);
  emission_ = glm::dvec3(material.emission);
  is_refracting_ = refracts(model);
  mirror_is_traced_ = model != 8 && model != 9;
  if (is_refracting_) {
    eta_ = surface.outside ? material.refraction_index : 1.0 / material.refraction_index;
  }
  if (model == 0) {
    unlit_ = d * surface.diffuse;
  } else {
    diffuse_ = d * glm::clamp(surface.diffuse, glm::dvec3(0.0), glm::dvec3(1.0));
  }
  if (model == 2) glossy_ = d * ks;
  if (model == 3 || model == 8) mirror_ = d * ks;
  if (model == 4 || model == 6 || model == 9) mirror_ = ks;
  if (model == 5) mirror_ = d * schlick_reflectance(cosine, ks);
  if (model == 7) mirror_ = glm::dvec3(fresnel_reflectance(cosine, eta_));
  if (is_glass(model)) {
    const bool total = is_refracting_ && fresnel_reflectance(cosine, eta_) == 1.0;
    if (total) mirror_ = glm::dvec3(1.0);
    // What the mirror takes is gone for all that lies under it.
    diffuse_ *= 1.0 - mirror_;
    through_ = (1.0 - d) * limited(material.transmittance) * (1.0 - mirror_);
  } else {
    through_ = glm::dvec3(1.0 - d);
    const double sum = largest(diffuse_ + glossy_ + mirror_);
    if (sum > d) {
      const double scale = d / sum;
      diffuse_ *= scale;
      glossy_ *= scale;
      mirror_ *= scale;
    }
  }
}

bool Bsdf::scatters() const { return largest(diffuse_) > 0.0 || largest(glossy_) > 0.0; }

/// Phong's lobe around the mirrored view, so high that it reflects no more than what arrives
/// (Lafortune and Willems 1994).
double Bsdf::lobe(const glm::dvec3& light) const {
  const double cosine = glm::dot(reflected(-view_, normal_), light);
  if (cosine <= 0.0) return 0.0;
  return (exponent_ + 2.0) / (2.0 * kPi) * std::pow(cosine, exponent_);
}

glm::dvec3 Bsdf::scattered(const glm::dvec3& light) const {
  if (glm::dot(normal_, light) <= 0.0) return glm::dvec3(0.0);
  glm::dvec3 sum = diffuse_ / kPi;
  if (largest(glossy_) > 0.0) sum += glossy_ * lobe(light);
  return sum;
}

glm::dvec3 Bsdf::scattered_from_point(const glm::dvec3& light) const {
  if (glm::dot(normal_, light) <= 0.0) return glm::dvec3(0.0);
  glm::dvec3 sum = diffuse_ / kPi;
  const glm::dvec3 highlight = exponent_ > 1.0 ? glossy_ + mirror_ : glossy_;
  if (largest(highlight) > 0.0) sum += highlight * lobe(light);
  return sum;
}

double Bsdf::glossy_share() const {
  const double glossy = largest(glossy_);
  return glossy > 0.0 ? glossy / (glossy + largest(diffuse_)) : 0.0;
}

glm::dvec3 Bsdf::sample(const glm::dvec2& u) const {
  const double share = glossy_share();
  if (u.x < share) {
    const double cosine = std::pow(1.0 - u.x / share, 1.0 / (exponent_ + 1.0));
    return around(reflected(-view_, normal_), cosine, 2.0 * kPi * u.y);
  }
  const double rest = (u.x - share) / (1.0 - share);
  return around(normal_, std::sqrt(1.0 - rest), 2.0 * kPi * u.y);
}

double Bsdf::density(const glm::dvec3& light) const {
  const double share = glossy_share();
  const double diffuse = std::max(0.0, glm::dot(normal_, light)) / kPi;
  const double glossy = share > 0.0 ? lobe(light) * (exponent_ + 1.0) / (exponent_ + 2.0) : 0.0;
  return (1.0 - share) * diffuse + share * glossy;
}

glm::dvec3 Bsdf::mirror_direction() const { return reflected(-view_, normal_); }

std::optional<glm::dvec3> Bsdf::through_direction(const glm::dvec3& normal) const {
  return is_refracting_ ? refracted(-view_, normal, eta_) : std::optional(-view_);
}

glm::dvec3 shadow_transmittance(const Surface& surface, bool bent) {
  const Bsdf bsdf(surface);
  return bsdf.is_refracting() && !bent ? glm::dvec3(0.0) : bsdf.through();
}

bool is_clear(const Material& material) {
  return opacity(material) < 1.0 &&
         (!is_glass(material.illumination_model) || largest(limited(material.transmittance)) > 0.0);
}

}  // namespace raygate
