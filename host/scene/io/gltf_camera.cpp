#include "host/scene/io/gltf_camera.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "host/scene/instances.h"

namespace raygate {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

}  // namespace

void read_camera(const GltfFile& file, const tinygltf::Camera& camera, const glm::dmat4& world,
                 Scene& scene) {
  const auto warn = [&](const char* what) { file.warn_once(what, scene.warnings); };
  const bool is_orthographic = camera.type == "orthographic";
  // An orthographic picture is as large as a perspective one has it at the target.
  const double fov = is_orthographic ? 90.0 : camera.perspective.yfov * kDegrees;
  const double distance = is_orthographic ? camera.orthographic.ymag : 1.0;
  if (!(fov > 0.0 && fov < 180.0)) {
    file.fail("a camera's yfov: expected more than 0 and less than pi");
  }
  if (!(distance > 0.0 && distance <= std::numeric_limits<float>::max())) {
    file.fail("a camera's ymag: expected a positive number within the range of float");
  }
  if (scene.camera) return warn("of several cameras the first one is taken");
  const glm::dvec3 eye(world[3]), back(world[2]), up(world[1]);
  if (glm::length(back) == 0.0 || glm::length(glm::cross(back, up)) == 0.0) {
    return warn("a camera without a direction is left out");
  }
  scene.camera = {eye, eye - distance * glm::normalize(back), up, fov};
  if (is_orthographic) scene.camera->lens.projection = Projection::kOrthographic;
}

void aim_camera(Scene& scene) {
  if (!scene.camera) return;
  const auto [low, high] = position_bounds(scene);
  const glm::dvec3 middle = 0.5 * (low + high);
  CameraSetting& camera = *scene.camera;
  glm::dvec3 forward = camera.target - camera.eye;
  double fov = *camera.fov;
  const bool is_orthographic = camera.lens.projection == Projection::kOrthographic;
  const double size = glm::length(forward);
  if (is_orthographic) forward /= size;
  const double depth = glm::dot(middle + scene.origin - camera.eye, forward);
  if (is_orthographic) fov = 2.0 * std::atan(size / depth) * kDegrees;
  if (!(depth > 0.0 && fov > 0.0 && fov < 180.0)) return;
  camera.target = camera.eye + depth * forward;
  camera.fov = fov;
}

}  // namespace raygate
