// scene.json: what an OBJ file cannot say of a scene. scenes/README.md has the format for users.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/io/instance_settings.h"
#include "host/scene/io/light_settings.h"
#include "host/scene/scene.h"

namespace raygate {

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
  LensSetting lens;                 ///< and of what the camera looks through
  std::vector<CameraSetting> path;  ///< what the camera passes, in order; at least two, or none
  LightSettings lights;
  std::vector<InstanceSetting> instances;
  std::vector<OptionSetting> options;
};

/// Reads a scene file. Throws InputError, "file:line: what: found, expected ...": what cannot be
/// read or is not JSON, unknown keys, values of a wrong type or out of range.
[[nodiscard]] SceneFile read_scene_file(const std::filesystem::path& file);

/// Loads the scene that the file is about, with its instances, and without its lights.
[[nodiscard]] Scene load_scene(const SceneFile& file, const LoadOptions& options = {});

/// Adds the file's lights to its scene.
void add_lights(const SceneFile& file, Scene& scene);

}  // namespace raygate
