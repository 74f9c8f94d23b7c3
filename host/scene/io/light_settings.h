// The lights of scene.json. scenes/README.md has their format for users.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "host/scene/io/json_reader.h"
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
  std::optional<SpotCone> spot = {};
};

/// An environment map that is still in its file.
struct EnvironmentSetting {
  std::filesystem::path file;  ///< OpenEXR or Radiance HDR, latitude-longitude
  double rotation = 0.0;       ///< in degrees around what is up, counter-clockwise seen from above
  double strength = 1.0;       ///< times what the file has; 0 or more
};

/// Lights in world coordinates.
struct LightSettings {
  std::vector<PointLightSetting> points;
  std::vector<AreaLightSetting> areas;
  std::vector<DirectionalLight> directions;
  std::optional<EnvironmentSetting> environment;
  std::optional<glm::vec3> background;  ///< radiance, scene-linear RGB, none negative
};

/// The keys of a scene file that say what shines.
inline constexpr const char* kLightKeys[] = {"point_lights", "spot_lights", "directional_lights",
                                             "area_lights",  "environment", "background"};

/// `folder` is where the scene file is. Throws InputError: values of a wrong type or out of range.
[[nodiscard]] LightSettings read_lights(const JsonReader& reader, const JsonValue& scene,
                                        const std::filesystem::path& folder);

/// Adds the lights to a scene; area lights as two triangles each of an object and a material of
/// their own, "light 1" and on. Throws InputError, beginning with `file`, if a light is too far
/// away or too small for float. The environment is left for load_environment.
void add_lights(const LightSettings& lights, const std::filesystem::path& file, Scene& scene);

}  // namespace raygate
