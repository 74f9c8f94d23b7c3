#include "host/scene/io/light_settings.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "host/base/input_error.h"
#include "host/exact/exact_sign.h"

namespace raygate {
namespace {

using Kind = JsonValue::Kind;

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// "point_lights[2]"
std::string numbered(const char* name, std::size_t number) {
  return std::string(name) + "[" + std::to_string(number) + "]";
}

void read_points(const JsonReader& reader, const JsonValue* array, LightSettings& lights) {
  std::size_t number = 0;
  for (const JsonValue& value : reader.array(array, "point_lights")) {
    constexpr const char* kKeys[] = {"position", "intensity"};
    const std::string name = numbered("point_lights", number++);
    reader.require_object(value, name, kKeys);
    lights.points.push_back(
        {reader.vector(reader.need(value, name, "position"), name + ".position"),
         reader.light(reader.need(value, name, "intensity"), name + ".intensity")});
  }
}

void read_spots(const JsonReader& reader, const JsonValue* array, LightSettings& lights) {
  std::size_t number = 0;
  for (const JsonValue& value : reader.array(array, "spot_lights")) {
    constexpr const char* kKeys[] = {"position", "direction", "intensity", "inner", "outer"};
    const std::string name = numbered("spot_lights", number++);
    reader.require_object(value, name, kKeys);
    SpotCone cone;
    cone.axis = reader.direction(reader.need(value, name, "direction"), name + ".direction");
    cone.outer = reader.number_in(value, name, "outer", 1e-3, 90.0,
                                  "degrees from the axis, 0.001 to 90", cone.outer);
    cone.inner = reader.number_in(value, name, "inner", 0.0, cone.outer,
                                  "degrees from the axis, from 0 to 'outer'", cone.inner);
    lights.points.push_back(
        {reader.vector(reader.need(value, name, "position"), name + ".position"),
         reader.light(reader.need(value, name, "intensity"), name + ".intensity"), cone});
  }
}

void read_directions(const JsonReader& reader, const JsonValue* array, LightSettings& lights) {
  for (const JsonValue& value : reader.array(array, "directional_lights")) {
    constexpr const char* kKeys[] = {"direction", "irradiance"};
    const std::string name = numbered("directional_lights", lights.directions.size());
    reader.require_object(value, name, kKeys);
    lights.directions.push_back(
        {reader.direction(reader.need(value, name, "direction"), name + ".direction"),
         reader.light(reader.need(value, name, "irradiance"), name + ".irradiance")});
  }
}

void read_areas(const JsonReader& reader, const JsonValue* array,
                std::vector<AreaLightSetting>& areas) {
  for (const JsonValue& value : reader.array(array, "area_lights")) {
    constexpr const char* kKeys[] = {"corner", "edges", "radiance"};
    const std::string name = "area_lights[" + std::to_string(areas.size()) + "]";
    reader.require_object(value, name, kKeys);
    AreaLightSetting light;
    light.corner = reader.vector(reader.need(value, name, "corner"), name + ".corner");
    light.radiance = reader.light(reader.need(value, name, "radiance"), name + ".radiance");
    const JsonValue& edges = reader.need(value, name, "edges");
    if (edges.kind() != Kind::kArray || edges.elements().size() != 2) {
      reader.fail(edges, name + ".edges", "two vectors, [[x, y, z], [x, y, z]]");
    }
    for (std::size_t i = 0; i < 2; ++i) {
      light.edges[i] = reader.vector(edges.elements()[i], name + ".edges");
    }
    const double area = glm::length(glm::cross(light.edges[0], light.edges[1]));
    if (!(area > 1e-9 * glm::length(light.edges[0]) * glm::length(light.edges[1]))) {
      reader.fail(edges, name + ".edges", "two that are not parallel");
    }
    areas.push_back(light);
  }
}

EnvironmentSetting read_environment(const JsonReader& reader, const JsonValue& value,
                                    const std::filesystem::path& folder) {
  constexpr const char* kKeys[] = {"file", "rotation", "strength"};
  const std::string name = "environment";
  reader.require_object(value, name, kKeys);
  const JsonValue& file = reader.need(value, name, "file");
  if (file.kind() != Kind::kString || file.string().empty()) {
    reader.fail(file, name + ".file", "the name of an EXR or HDR file");
  }
  return {folder / file.string(),
          reader.number_in(value, name, "rotation", -360.0, 360.0, "degrees from -360 to 360", 0.0),
          reader.number_in(value, name, "strength", 0.0, 1e9, "a factor from 0 to 1e9", 1.0)};
}

}  // namespace

LightSettings read_lights(const JsonReader& reader, const JsonValue& scene,
                          const std::filesystem::path& folder) {
  LightSettings lights;
  read_points(reader, JsonReader::find(scene, "point_lights"), lights);
  read_spots(reader, JsonReader::find(scene, "spot_lights"), lights);
  read_directions(reader, JsonReader::find(scene, "directional_lights"), lights);
  read_areas(reader, JsonReader::find(scene, "area_lights"), lights.areas);
  if (const JsonValue* const environment = JsonReader::find(scene, "environment")) {
    lights.environment = read_environment(reader, *environment, folder);
  }
  if (const JsonValue* const background = JsonReader::find(scene, "background")) {
    lights.background = reader.light(*background, "background");
  }
  return lights;
}

void add_lights(const LightSettings& lights, const std::filesystem::path& file, Scene& scene) {
  for (const PointLightSetting& light : lights.points) {
    const glm::vec3 position(light.position - scene.origin);
    if (!is_finite(position)) {
      throw InputError(file.string() + ": a point light is beyond the range of float");
    }
    scene.lights.push_back({position, light.intensity, light.spot});
  }
  scene.directional_lights.insert(scene.directional_lights.end(), lights.directions.begin(),
                                  lights.directions.end());
  if (lights.background) scene.background = *lights.background;
  int number = 0;
  for (const AreaLightSetting& light : lights.areas) {
    const std::string name = "light " + std::to_string(++number);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const glm::dvec3 corner = light.corner - scene.origin;
    scene.positions.emplace_back(corner);
    scene.positions.emplace_back(corner + light.edges[0]);
    scene.positions.emplace_back(corner + light.edges[0] + light.edges[1]);
    scene.positions.emplace_back(corner + light.edges[1]);
    const glm::vec3* const corners = &scene.positions[first];
    if (!std::all_of(corners, corners + 4, is_finite) ||
        collinear(corners[0], corners[1], corners[2]) ||
        collinear(corners[0], corners[2], corners[3])) {
      throw InputError(file.string() + ": area_lights[" + std::to_string(number - 1) +
                       "] is beyond the range of float, or too small for its place");
    }
    Triangle triangle;
    triangle.material = static_cast<std::uint32_t>(scene.materials.size());
    triangle.object = static_cast<std::uint32_t>(scene.objects.size());
    Material& material = scene.materials.emplace_back();
    material.name = name;
    material.diffuse = glm::vec3(0.0f);
    material.emission = light.radiance;
    scene.objects.push_back(name);
    triangle.vertices = {first, first + 1, first + 2};
    scene.triangles.push_back(triangle);
    triangle.vertices = {first, first + 2, first + 3};
    scene.triangles.push_back(triangle);
  }
}

}  // namespace raygate
