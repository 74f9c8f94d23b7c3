#include "host/scene/io/gltf_camera.h"

#include <numbers>

#include "host/scene/instances.h"

namespace raygate {

void read_camera(const GltfFile& file, const tinygltf::Camera& camera, const glm::dmat4& world,
                 Scene& scene) {
  const auto warn = [&](const char* what) { file.warn_once(what, scene.warnings); };
  if (camera.type != "perspective") return warn("orthographic cameras are not read");
  const double fov = camera.perspective.yfov * 180.0 / std::numbers::pi;
  if (!(fov > 0.0 && fov < 180.0)) {
    file.fail("a camera's yfov: expected more than 0 and less than pi");
  }
  if (scene.camera) return warn("of several cameras the first one is taken");
  const glm::dvec3 eye(world[3]), back(world[2]), up(world[1]);
  if (glm::length(back) == 0.0 || glm::length(glm::cross(back, up)) == 0.0) {
    return warn("a camera without a direction is left out");
  }
  scene.camera = {eye, eye - glm::normalize(back), up, fov};
}

void aim_camera(Scene& scene) {
  if (!scene.camera) return;
  const auto [low, high] = position_box(scene);
  const glm::dvec3 middle = 0.5 * (low + high);
  CameraSetting& camera = *scene.camera;
  const glm::dvec3 forward = camera.target - camera.eye;
  const double depth = glm::dot(middle + scene.origin - camera.eye, forward);
  if (depth > 0.0) camera.target = camera.eye + depth * forward;
}

}  // namespace raygate
