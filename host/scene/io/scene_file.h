// scene.json: what an OBJ file cannot say of a scene. scenes/README.md has the format for users.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace raygate {

/// A parallelogram that shines to both sides: corner, corner + edges[0], ...
struct AreaLightSetting {
  glm::dvec3 corner{0.0};
  glm::dvec3 edges[2]{};     ///< not parallel
  glm::vec3 radiance{0.0f};  ///< scene-linear RGB, none negative
};

struct PointLightSetting {
  glm::dvec3 position{0.0};
  glm::vec3 intensity{0.0f};  ///< radiant intensity, scene-linear RGB, none negative
};

/// A command-line option that the file sets, unless the command line does.
struct OptionSetting {
  std::string name;   ///< "size": --size
  std::string value;  ///< as it would be typed
  std::size_t line = 0;
};

/// A scene file as it stands; every value is possible, but options are not looked into.
struct SceneFile {
  std::filesystem::path file;
  std::filesystem::path obj;
  std::optional<CameraSetting> camera;
  std::optional<glm::dvec3> up;     ///< "camera.up", also without a camera: of views
  std::optional<double> fov;        ///< the same of "camera.fov"
  std::vector<CameraSetting> path;  ///< what the camera passes, in order; at least two, or none
  std::vector<PointLightSetting> point_lights;
  std::vector<AreaLightSetting> area_lights;
  std::optional<glm::vec3> background;  ///< radiance, scene-linear RGB, none negative
  std::vector<OptionSetting> options;
};

/// Reads a scene file. Throws InputError, "file:line: what: found, expected ...": what cannot be
/// read or is not JSON, unknown keys, values of a wrong type or out of range.
[[nodiscard]] SceneFile read_scene_file(const std::filesystem::path& file);

/// Adds the file's lights to the scene of its OBJ file, area lights as two triangles each of an
/// object and a material of their own, "light 1" and on. Throws InputError if a light is too far
/// away or too small for float.
void add_lights(const SceneFile& file, Scene& scene);

}  // namespace raygate
