// SceneFile: a scene.json, with the camera, lights, instances and options of a scene. Its format is
// described in host/docs/reference.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// A parallelogram that emits to both sides, with a corner and two edges from it.
struct AreaLightSetting {
  glm::dvec3 corner{0.0};
  glm::dvec3 edges[2]{};     ///< not parallel
  glm::vec3 radiance{0.0f};  ///< scene-linear RGB, none negative
};

/// A model and the transforms of its instances.
struct InstanceSetting {
  std::filesystem::path model;
  std::vector<glm::dmat4> transforms;  ///< from the model's coordinates to the world's
};

/// A value that was given to an option.
struct OptionValue {
  std::string name;     ///< of the option, without dashes
  std::string text;     ///< "" for a flag
  std::string where{};  ///< place for messages, "scene.json:3"; "": the command line
};

/// The contents of a scene file, in world coordinates. Values were checked, except those of
/// options.
struct SceneFile {
  std::filesystem::path file = {};
  std::filesystem::path obj = {};
  CameraRequest camera = {};
  std::vector<WorldPointLight> point_lights = {};
  std::vector<AreaLightSetting> area_lights = {};
  std::vector<DirectionalLight> directional_lights = {};
  EnvironmentSetting environment = {};
  std::optional<glm::vec3> background = {};  ///< radiance, scene-linear RGB, none negative
  std::vector<InstanceSetting> instances = {};
  std::vector<OptionValue> options = {};
  std::string settings = {};  ///< lights, background and instances as JSON, for digest_of()

  /// Returns "camera.up", which may be there without a camera.
  [[nodiscard]] const std::optional<glm::dvec3>& up() const {
    return camera.camera ? camera.camera->up : camera.up;
  }
};

/// Reads a scene file (.json). For a file with another ending, returns a SceneFile with that model
/// alone. Throws InputError, "file:line: what: found, expected ...", if the file cannot be read or
/// is not JSON, for unknown keys, and for values of a wrong type or out of range.
[[nodiscard]] SceneFile read_scene_file(const std::filesystem::path& file);

/// Loads the model of a scene file and adds the file's lights and instances. Each instance adds
/// all objects of its model, without the model's lights and cameras. Each area light adds two
/// triangles, an object and a material, "light 1" and so on. load_environment() loads the
/// environment. Throws InputError as load_scene(file) does, and if an instance or a light is beyond
/// the range of float or a light is too small for it.
[[nodiscard]] Scene load_scene(const SceneFile& file, const LoadOptions& options = {});

}  // namespace raygate
