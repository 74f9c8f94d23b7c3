#include "host/light/default_lights.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "host/exact/exact.h"
#include "host/light/lights.h"
#include "host/scene/bounds.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

/// Lights stand still while the camera is looked through: they are found from it.
class LightPlaces {
 public:
  LightPlaces(const Scene& scene, const Camera& camera) : camera_(camera) {
    const auto [low, high] = position_bounds(scene);
    const glm::dvec3 eye(camera.eye());
    middle_ = 0.5 * (low + high);
    size_ = glm::length(high - low);
    is_inside_ = glm::all(glm::lessThanEqual(low, eye)) && glm::all(glm::lessThanEqual(eye, high));
  }

  [[nodiscard]] bool is_inside() const { return is_inside_; }
  [[nodiscard]] double size() const { return size_; }

  /// From the upper left of the camera, or from the camera.
  [[nodiscard]] PointLight key() const {
    // In the middle of the scene a white wall that faces the light has radiance 0.8 from it.
    if (is_inside_) return light(glm::dvec3(camera_.eye()), 0.35 * size_, 0.8);
    const glm::dvec3 at = place(-0.8, 1.2);
    return light(at, glm::length(at - middle_), 0.8);
  }
  /// From the right of the camera.
  [[nodiscard]] PointLight fill() const {
    const glm::dvec3 at = place(1.4, 0.3);
    return light(at, glm::length(at - middle_), 0.25);
  }

 private:
  [[nodiscard]] glm::dvec3 place(double right, double up) const {
    return middle_ +
           size_ * (up * camera_.up() + right * camera_.right() - 1.3 * camera_.forward());
  }
  [[nodiscard]] static PointLight light(const glm::dvec3& at, double distance, double radiance) {
    return {glm::vec3(at), glm::dvec3(radiance * std::numbers::pi * distance * distance)};
  }

  const Camera& camera_;
  glm::dvec3 middle_;
  double size_;
  bool is_inside_;
};

/// Neither lights nor faces that emit.
bool has_no_light(const Scene& scene) {
  return scene.lights.empty() && scene.directional_lights.empty() && !scene.environment &&
         std::ranges::none_of(scene.triangles, [&](const Triangle& face) {
           return emits(scene.materials[face.material]);
         });
}

/// Radiance times area of all faces that emit.
double emitted(const Scene& scene) {
  double sum = 0.0;
  for (const Triangle& face : scene.triangles) {
    const Material& material = scene.materials[face.material];
    if (!emits(material)) continue;
    const auto& [a, b, c] = face.vertices;
    sum +=
        0.5 * mean(glm::dvec3(material.emission)) *
        glm::length(triangle_normal({scene.positions[a], scene.positions[b], scene.positions[c]}));
  }
  return sum;
}

constexpr glm::vec3 kDimSky(0.18f, 0.2f, 0.24f);

}  // namespace

std::optional<CameraLights> default_lights(const Scene& scene, const Camera& camera) {
  if (is_empty(scene) || scene.background != glm::vec3(0.0f) || !has_no_light(scene)) return {};
  return CameraLights{{LightPlaces(scene, camera).key()}, kDimSky};
}

std::optional<CameraLights> preview_lights(const Scene& scene, const Camera& camera) {
  if (is_empty(scene) || !scene.lights.empty() || !scene.directional_lights.empty() ||
      scene.environment) {
    return {};
  }
  const LightPlaces places(scene, camera);
  // Labels and the like that glow are no lights: not a hundredth of what the key light does.
  constexpr double kGlow = 0.01;
  if (emitted(scene) > kGlow * places.size() * places.size()) return {};
  CameraLights lights{{places.key()}, scene.background};
  if (!places.is_inside()) lights.points.push_back(places.fill());
  if (lights.background == glm::vec3(0.0f)) lights.background = kDimSky;
  return lights;
}

}  // namespace raygate
