// What happens to light at the border of two clear media.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace raygate {

/// The share of unpolarised light that a smooth border reflects, by Fresnel's formulas: the mean
/// of both polarisations' |r|^2. `cosine` of the angle of incidence, in [0, 1]; `eta` is the
/// refraction index beyond the border over the one before it. 1 at total reflection.
[[nodiscard]] double fresnel_reflectance(double cosine, double eta);

/// Schlick's stand-in for it (1994): from `normal_incidence` up to 1 at grazing.
[[nodiscard]] glm::dvec3 schlick_reflectance(double cosine, const glm::dvec3& normal_incidence);

/// `direction` mirrored at a plane with the unit normal `normal`, as long as before.
[[nodiscard]] glm::dvec3 reflected(const glm::dvec3& direction, const glm::dvec3& normal);

/// The unit `direction`, which runs against the unit `normal`, bent after Snell's law; nothing at
/// total reflection. `eta` as above.
[[nodiscard]] std::optional<glm::dvec3> refracted(const glm::dvec3& direction,
                                                  const glm::dvec3& normal, double eta);

}  // namespace raygate
