#include "host/light/fresnel.h"

#include <algorithm>
#include <cmath>

namespace raygate {
namespace {

/// The square of the cosine beyond the border; negative at total reflection.
double transmitted_cosine_squared(double cosine, double eta) {
  return 1.0 - (1.0 - cosine * cosine) / (eta * eta);
}

}  // namespace

double fresnel_reflectance(double cosine, double eta) {
  const double squared = transmitted_cosine_squared(cosine, eta);
  if (squared <= 0.0) return 1.0;
  const double beyond = std::sqrt(squared);
  const double across = (cosine - eta * beyond) / (cosine + eta * beyond);
  const double parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
  return 0.5 * (across * across + parallel * parallel);
}

glm::dvec3 schlick_reflectance(double cosine, const glm::dvec3& normal_incidence) {
  const double x = 1.0 - std::clamp(cosine, 0.0, 1.0);
  return normal_incidence + (1.0 - normal_incidence) * (x * x * x * x * x);
}

glm::dvec3 reflected(const glm::dvec3& direction, const glm::dvec3& normal) {
  return direction - 2.0 * glm::dot(direction, normal) * normal;
}

std::optional<glm::dvec3> refracted(const glm::dvec3& direction, const glm::dvec3& normal,
                                    double eta) {
  const double cosine = -glm::dot(direction, normal);
  const double squared = transmitted_cosine_squared(cosine, eta);
  if (squared <= 0.0) return std::nullopt;
  return direction / eta + (cosine / eta - std::sqrt(squared)) * normal;
}

}  // namespace raygate
