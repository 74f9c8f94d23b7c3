// What a material does with light: the MTL illumination models, as lobes that make no energy.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "host/light/surface.h"

namespace raygate {

/// What becomes of light that arrives along the view: four shares, each a colour.
///
/// `illum` says which there are; d is the opacity, 1 opaque. Where the lobes of an opaque surface
/// add up to more than 1 they are scaled down, so that no energy comes from nowhere.
///
/// | illum | diffuse | glossy | mirror | through |
/// |---|---|---|---|---|
/// | 0 | none: Kd is shown as it is, unlit | | | 1 - d, straight |
/// | 1 | d Kd | | | 1 - d, straight |
/// | 2 | d Kd | d Ks, exponent Ns | | 1 - d, straight |
/// | 3 | d Kd | | d Ks | 1 - d, straight |
/// | 4 | d Kd | | Ks | the rest of (1 - d) Tf, straight: thin glass |
/// | 5 | d Kd | | d times Schlick's Fresnel from Ks | 1 - d, straight |
/// | 6 | d Kd | | Ks | the rest of (1 - d) Tf, refracted by Ni |
/// | 7 | d Kd | | Fresnel's formula for Ni | the rest of (1 - d) Tf, refracted by Ni |
/// | 8, 9 | as 3, 4, but mirrors show only the background | | | |
/// | 10 | as 1: a shadow to lay over a picture needs a picture | | | |
///
/// With 4, 6, 7 and 9, d = 1 counts as 0: it is what exporters leave there, and the model says
/// that the material is clear. Light that enters glass is not made denser by Ni squared, and not
/// thinner when it leaves: what is counted is radiance over the square of the index, which does not
/// change. "The rest" is what the mirror leaves. A mirror cannot show a point
/// light, which has no size: there it has a highlight with exponent Ns instead, unless that is 1
/// (what it is where the file does not say) or less.
class Bsdf {
 public:
  explicit Bsdf(const Surface& surface);

  [[nodiscard]] const glm::dvec3& diffuse() const { return diffuse_; }
  [[nodiscard]] const glm::dvec3& glossy() const { return glossy_; }
  [[nodiscard]] const glm::dvec3& mirror() const { return mirror_; }
  [[nodiscard]] const glm::dvec3& through() const { return through_; }
  [[nodiscard]] bool mirror_is_traced() const { return mirror_is_traced_; }
  [[nodiscard]] bool is_refracting() const { return is_refracting_; }
  /// Radiance that the surface sends along the view by itself, as a lamp does (Ke).
  [[nodiscard]] const glm::dvec3& emission() const { return emission_; }
  /// Radiance that is only there to be seen: illum 0.
  [[nodiscard]] const glm::dvec3& unlit() const { return unlit_; }
  /// Whether light from a direction of its own is scattered: diffuse or glossy.
  [[nodiscard]] bool scatters() const;

  /// Diffuse and glossy reflection, per steradian and without the cosine, from unit direction
  /// `light`; 0 from behind.
  [[nodiscard]] glm::dvec3 scattered(const glm::dvec3& light) const;
  /// The same with the mirror as a highlight, for point lights.
  [[nodiscard]] glm::dvec3 scattered_from_point(const glm::dvec3& light) const;

  /// A direction for diffuse or glossy reflection, chosen for a point of the unit square, nearly
  /// in proportion to what it brings. May point behind the surface: it brings nothing then.
  [[nodiscard]] glm::dvec3 sample(const glm::dvec2& u) const;
  /// The density of sample() per steradian.
  [[nodiscard]] double density(const glm::dvec3& light) const;

  [[nodiscard]] glm::dvec3 mirror_direction() const;
  /// Bent, at a surface of this normal, or straight; nothing at total reflection.
  [[nodiscard]] std::optional<glm::dvec3> through_direction(const glm::dvec3& normal) const;

 private:
  [[nodiscard]] double glossy_share() const;
  [[nodiscard]] double lobe(const glm::dvec3& light) const;

  glm::dvec3 view_, normal_;
  double eta_ = 1.0, exponent_ = 0.0;
  glm::dvec3 diffuse_{0.0}, glossy_{0.0}, mirror_{0.0}, through_{0.0}, emission_{0.0}, unlit_{0.0};
  bool mirror_is_traced_ = true, is_refracting_ = false;
};

/// The share of light that goes through a material straight on, as far as shadows are concerned:
/// `refracting` surfaces let none through, or, where `bent` says so, as much as if they did not
/// bend it (caustics are then where the shadow is).
[[nodiscard]] glm::dvec3 shadow_transmittance(const Surface& surface, bool bent);

/// Whether any light goes through.
[[nodiscard]] bool is_clear(const Material& material);

}  // namespace raygate
