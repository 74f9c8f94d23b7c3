// scene.json: what an OBJ file cannot say of a scene; host/docs/reference.md has its format.
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

/// A parallelogram that emits to both sides: corner, corner + edges[0], ...
struct AreaLightSetting {
  glm::dvec3 corner{0.0};
  glm::dvec3 edges[2]{};     ///< not parallel
  glm::vec3 radiance{0.0f};  ///< scene-linear RGB, none negative
};

struct PointLightSetting {
  glm::dvec3 position{0.0};
  glm::vec3 intensity{0.0f};  ///< radiant intensity, scene-linear RGB, none negative
  std::optional<SpotCone> spot = {};
};

/// Lights in world coordinates.
struct LightSettings {
  std::vector<PointLightSetting> points;
  std::vector<AreaLightSetting> areas;
  std::vector<DirectionalLight> directions;
  std::optional<EnvironmentSetting> environment;
  std::optional<glm::vec3> background;  ///< radiance, scene-linear RGB, none negative
};

/// A model, and where it stands.
struct InstanceSetting {
  std::filesystem::path model;
  std::vector<glm::dmat4> transforms;  ///< from the model's coordinates to the world's
  std::size_t line = 0;
};

/// A command-line option that the file sets, unless the command line does.
struct OptionSetting {
  std::string name;   ///< "size": --size
  std::string value;  ///< as it would be typed
  std::size_t line = 0;
};

/// A scene file as it stands; every value is possible, but options are not looked into.
struct SceneFile {
  std::filesystem::path file = {};
  std::filesystem::path obj = {};
  std::optional<CameraSetting> camera = {};
  std::optional<glm::dvec3> up = {};  ///< "camera.up", also without a camera: of views
  std::optional<double> fov = {};     ///< the same of "camera.fov"
  LensSetting lens = {};              ///< and of what the camera looks through
  std::vector<CameraSetting> path =
      {};  ///< what the camera passes, in order; at least two, or none
  LightSettings lights = {};
  std::vector<InstanceSetting> instances = {};
  std::vector<OptionSetting> options = {};
};

/// Reads a scene file (.json); a file of any other ending is a model, with nothing to add. Throws
/// InputError, "file:line: what: found, expected ...": what cannot be read or is not JSON, unknown
/// keys, values of a wrong type or out of range.
[[nodiscard]] SceneFile read_scene_file(const std::filesystem::path& file);

/// Loads the scene that the file is about and adds the file's lights and instances of its models:
/// an object for each of a model's in each place; lights and cameras of models are left out. Area
/// lights become two triangles each of an object and a material of their own, "light 1" and on. The
/// environment is left for load_environment. Throws InputError as load_scene does, and where an
/// instance or a light is beyond the range of float, or a light too small for it.
[[nodiscard]] Scene load_scene(const SceneFile& file, const LoadOptions& options = {});

}  // namespace raygate
