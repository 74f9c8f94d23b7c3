#include "host/scene/io/scene_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/instances.h"
#include "host/scene/io/json_reader.h"

namespace raygate {
namespace {

std::optional<glm::dvec3> read_up(const JsonValue& camera) {
  const auto value = camera.find("up");
  if (!value) return std::nullopt;
  const glm::dvec3 up = value->vector();
  if (up == glm::dvec3(0.0)) value->fail("a direction across the view");
  return up;
}

std::optional<double> read_fov(const JsonValue& camera) {
  const auto value = camera.find("fov");
  if (!value) return std::nullopt;
  const double fov = value->number();
  if (!(fov > 0.0 && fov < 180.0)) value->fail("degrees above 0 and below 180");
  return fov;
}

LensSetting read_lens(const JsonValue& camera) {
  LensSetting lens;
  if (const auto value = camera.find("projection")) {
    const std::string expected = "perspective, orthographic or panorama";
    lens.projection = projection_named(value->string(expected));
    if (!lens.projection) value->fail(expected);
  }
  constexpr double kMost = std::numeric_limits<float>::max();
  constexpr double kLeast = std::numeric_limits<float>::min();
  if (camera.find("aperture")) {
    lens.aperture =
        camera.number_in("aperture", 0.0, kMost, "the radius of a lens, 0 or more", 0.0);
  }
  if (camera.find("focus")) {
    lens.focus = camera.number_in("focus", kLeast, kMost, "a distance, more than 0", 0.0);
  }
  return lens;
}

CameraSetting read_camera(const JsonValue& value) {
  CameraSetting camera;
  const JsonValue target = value.at("target");
  camera.eye = value.at("eye").vector();
  camera.target = target.vector();
  if (camera.eye == camera.target) target.fail("another point than the eye");
  camera.up = read_up(value);
  if (camera.up) {
    const glm::dvec3 view = camera.target - camera.eye;
    const double sine_times_lengths = glm::length(glm::cross(view, *camera.up));
    if (!(sine_times_lengths > 1e-9 * glm::length(view) * glm::length(*camera.up))) {
      value.at("up").fail("a direction across the view");
    }
  }
  camera.fov = read_fov(value);
  camera.lens = read_lens(value);
  return camera;
}

void read_cameras(const JsonValue& value, SceneFile& scene) {
  value.require_keys({"eye", "target", "up", "fov", "projection", "aperture", "focus"});
  if (value.find("eye") || value.find("target")) scene.camera = read_camera(value);
  scene.up = read_up(value);
  scene.fov = read_fov(value);
  scene.lens = read_lens(value);
}

std::vector<InstanceSetting> read_instances(const JsonValue& scene,
                                            const std::filesystem::path& folder) {
  std::vector<InstanceSetting> settings;
  for (const JsonValue& value : scene.elements("instances")) {
    value.require_keys({"model", "places"});
    InstanceSetting& setting = settings.emplace_back();
    setting.model = folder / value.at("model").string("the name of a model");
    for (const JsonValue& place : value.at("places").elements()) {
      const std::vector<JsonValue> numbers = place.elements();
      glm::dmat4& transform = setting.transforms.emplace_back(1.0);
      if (numbers.size() == 3) {
        for (int k = 0; k < 3; ++k) transform[3][k] = numbers[std::size_t(k)].number();
      } else if (numbers.size() == 12) {
        for (int i = 0; i < 12; ++i) transform[i % 4][i / 4] = numbers[std::size_t(i)].number();
      } else {
        place.fail("a place of 3 numbers, or the 12 of a matrix of 3 rows");
      }
    }
  }
  return settings;
}

SpotCone read_spot(const JsonValue& light) {
  SpotCone cone;
  cone.axis = light.at("direction").direction();
  cone.outer =
      light.number_in("outer", 1e-3, 90.0, "degrees from the axis, 0.001 to 90", cone.outer);
  cone.inner = light.number_in("inner", 0.0, cone.outer, "degrees from the axis, from 0 to 'outer'",
                               cone.inner);
  return cone;
}

AreaLightSetting read_area(const JsonValue& value) {
  value.require_keys({"corner", "edges", "radiance"});
  AreaLightSetting light;
  light.corner = value.at("corner").vector();
  light.radiance = value.at("radiance").light();
  const JsonValue edges = value.at("edges");
  const std::vector<JsonValue> both = edges.elements();
  if (both.size() != 2) edges.fail("two vectors, [[x, y, z], [x, y, z]]");
  for (std::size_t i = 0; i < 2; ++i) light.edges[i] = both[i].vector();
  const double area = glm::length(glm::cross(light.edges[0], light.edges[1]));
  if (!(area > 1e-9 * glm::length(light.edges[0]) * glm::length(light.edges[1]))) {
    edges.fail("two that are not parallel");
  }
  return light;
}

LightSettings read_lights(const JsonValue& scene, const std::filesystem::path& folder) {
  LightSettings lights;
  for (const JsonValue& value : scene.elements("point_lights")) {
    value.require_keys({"position", "intensity"});
    lights.points.push_back({value.at("position").vector(), value.at("intensity").light()});
  }
  for (const JsonValue& value : scene.elements("spot_lights")) {
    value.require_keys({"position", "direction", "intensity", "inner", "outer"});
    const SpotCone cone = read_spot(value);
    lights.points.push_back({value.at("position").vector(), value.at("intensity").light(), cone});
  }
  for (const JsonValue& value : scene.elements("directional_lights")) {
    value.require_keys({"direction", "irradiance"});
    lights.directions.push_back(
        {value.at("direction").direction(), value.at("irradiance").light()});
  }
  for (const JsonValue& value : scene.elements("area_lights")) {
    lights.areas.push_back(read_area(value));
  }
  if (const auto value = scene.find("environment")) {
    value->require_keys({"file", "rotation", "strength"});
    lights.environment = {
        folder / value->at("file").string("the name of an EXR or HDR file"),
        value->number_in("rotation", -360.0, 360.0, "degrees from -360 to 360", 0.0),
        value->number_in("strength", 0.0, 1e9, "a factor from 0 to 1e9", 1.0)};
  }
  if (const auto value = scene.find("background")) lights.background = value->light();
  return lights;
}

std::vector<OptionSetting> read_options(const JsonValue& render) {
  std::vector<OptionSetting> options;
  for (const auto& [key, value] : render.members()) {
    options.push_back(
        {key, value.word("a number or a string, as on the command line"), value.line()});
  }
  return options;
}

void add_lights(const SceneFile& file, Scene& scene) {
  const LightSettings& lights = file.lights;
  for (const PointLightSetting& light : lights.points) {
    const glm::vec3 position(light.position - scene.origin);
    if (!is_finite(position)) {
      throw InputError(file.file.string() + ": a point light is beyond the range of float");
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
    const auto is_near = [](const glm::vec3& at) { return largest(at) <= kMostCoordinate; };
    if (!std::all_of(corners, corners + 4, is_near) ||
        collinear(corners[0], corners[1], corners[2]) ||
        collinear(corners[0], corners[2], corners[3])) {
      throw InputError(file.file.string() + ": area_lights[" + std::to_string(number - 1) +
                       "] is beyond the range of float, or too small for its place");
    }
    for (const std::uint32_t second : {1u, 2u}) {
      Triangle& triangle = scene.triangles.emplace_back();
      triangle.vertices = {first, first + second, first + second + 1};
      triangle.material = static_cast<std::uint32_t>(scene.materials.size());
      triangle.object = static_cast<std::uint32_t>(scene.objects.size());
    }
    Material& material = scene.materials.emplace_back();
    material.name = name;
    material.diffuse = glm::vec3(0.0f);
    material.emission = light.radiance;
    scene.objects.push_back(name);
  }
}

}  // namespace

SceneFile read_scene_file(const std::filesystem::path& file) {
  if (file.extension() != ".json") return {.file = file, .obj = file};
  const JsonFile json(file);
  const JsonValue root = json.root();
  const std::filesystem::path folder = file.parent_path();
  root.require_keys({"obj", "camera", "instances", "point_lights", "spot_lights",
                     "directional_lights", "area_lights", "environment", "background", "render"});
  SceneFile scene;
  scene.file = file;
  scene.obj = find_scene_file(std::filesystem::path(file).replace_extension());
  if (const auto obj = root.find("obj")) scene.obj = folder / obj->string("the name of a scene");
  if (const auto camera = root.find("camera")) read_cameras(*camera, scene);
  scene.instances = read_instances(root, folder);
  scene.lights = read_lights(root, folder);
  if (const auto render = root.find("render")) scene.options = read_options(*render);
  return scene;
}

Scene load_scene(const SceneFile& file, const LoadOptions& options) {
  LoadOptions kept = options, flat = options;
  kept.keep_instances = true;
  flat.keep_instances = false;
  Scene scene = load_scene(file.obj, kept);
  for (const InstanceSetting& setting : file.instances) {
    Scene model = load_scene(setting.model, flat);
    const NameList objects = std::move(model.objects);
    MeshInstancer instancer(scene, std::move(model));
    std::size_t object = scene.objects.size();
    scene.objects.append(objects, setting.transforms.size());
    for (const glm::dmat4& transform : setting.transforms) {
      if (!instancer.add(transform, static_cast<std::uint32_t>(object))) {
        throw InputError(file.file.string() + ": an instance of " + setting.model.string() +
                         " is beyond the range of float");
      }
      object += objects.size();
    }
  }
  add_lights(file, scene);
  if (!options.keep_instances) resolve_instances(scene, InstanceMode::kFlatten, file.file);
  return scene;
}

}  // namespace raygate
