#include "host/scene/io/scene_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "host/base/input_error.h"
#include "host/scene/io/json_reader.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

using Kind = JsonValue::Kind;

/// What may stand in "render": the options that change the picture.
constexpr const char* kOptions[] = {"size",      "integrator", "spp",     "depth",
                                    "threshold", "error",      "ambient", "filter",
                                    "seed",      "exposure",   "tone"};

std::optional<glm::dvec3> read_up(const JsonReader& reader, const JsonValue& camera,
                                  const std::string& name) {
  const JsonValue* const value = JsonReader::find(camera, "up");
  if (value == nullptr) return std::nullopt;
  const glm::dvec3 up = reader.vector(*value, name + ".up");
  if (up == glm::dvec3(0.0)) reader.fail(*value, name + ".up", "a direction across the view");
  return up;
}

std::optional<double> read_fov(const JsonReader& reader, const JsonValue& camera,
                               const std::string& name) {
  const JsonValue* const value = JsonReader::find(camera, "fov");
  if (value == nullptr) return std::nullopt;
  const double fov = reader.number(*value, name + ".fov");
  if (!(fov > 0.0 && fov < 180.0)) {
    reader.fail(*value, name + ".fov", "degrees above 0 and below 180");
  }
  return fov;
}

LensSetting read_lens(const JsonReader& reader, const JsonValue& camera, const std::string& name) {
  LensSetting lens;
  if (const JsonValue* const projection = JsonReader::find(camera, "projection")) {
    const auto found =
        projection->kind() == Kind::kString ? projection_named(projection->string()) : std::nullopt;
    if (!found) {
      reader.fail(*projection, name + ".projection", "perspective, orthographic or panorama");
    }
    lens.projection = found;
  }
  const auto length = [&](const char* key, double low, const char* expected) {
    std::optional<double> found;
    if (JsonReader::find(camera, key) != nullptr) {
      found = reader.number_in(camera, name, key, low, std::numeric_limits<float>::max(), expected,
                               0.0);
    }
    return found;
  };
  lens.aperture = length("aperture", 0.0, "the radius of a lens, 0 or more");
  lens.focus = length("focus", std::numeric_limits<float>::min(), "a distance, more than 0");
  return lens;
}

CameraSetting read_camera(const JsonReader& reader, const JsonValue& value,
                          const std::string& name) {
  CameraSetting camera;
  const JsonValue& target = reader.need(value, name, "target");
  camera.eye = reader.vector(reader.need(value, name, "eye"), name + ".eye");
  camera.target = reader.vector(target, name + ".target");
  if (camera.eye == camera.target) {
    reader.fail(target, name + ".target", "another point than the eye");
  }
  camera.up = read_up(reader, value, name);
  if (camera.up) {
    const glm::dvec3 view = camera.target - camera.eye;
    const double sine_times_lengths = glm::length(glm::cross(view, *camera.up));
    if (!(sine_times_lengths > 1e-9 * glm::length(view) * glm::length(*camera.up))) {
      reader.fail(*JsonReader::find(value, "up"), name + ".up", "a direction across the view");
    }
  }
  camera.fov = read_fov(reader, value, name);
  camera.lens = read_lens(reader, value, name);
  return camera;
}

void read_cameras(const JsonReader& reader, const JsonValue& value, SceneFile& scene) {
  constexpr const char* kKeys[] = {"eye",        "target",   "up",    "fov",
                                   "projection", "aperture", "focus", "path"};
  reader.require_object(value, "camera", kKeys);
  const JsonValue* const path = JsonReader::find(value, "path");
  if (JsonReader::find(value, "eye") != nullptr || JsonReader::find(value, "target") != nullptr) {
    scene.camera = read_camera(reader, value, "camera");
  }
  scene.up = read_up(reader, value, "camera");
  scene.fov = read_fov(reader, value, "camera");
  scene.lens = read_lens(reader, value, "camera");
  if (path == nullptr) return;
  for (const JsonValue& place : reader.array(path, "camera.path")) {
    constexpr const char* kPlaceKeys[] = {"eye", "target", "up", "fov"};
    const std::string name = "camera.path[" + std::to_string(scene.path.size()) + "]";
    reader.require_object(place, name, kPlaceKeys);
    scene.path.push_back(read_camera(reader, place, name));
  }
  for (CameraSetting& place : scene.path) {
    if (scene.camera) break;
    if (!place.up) place.up = scene.up;
    if (!place.fov) place.fov = scene.fov;
  }
  if (scene.path.size() < 2) reader.fail(*path, "camera.path", "at least two places");
  if (!scene.camera) scene.camera = scene.path.front();
}

void read_options(const JsonReader& reader, const JsonValue& value, SceneFile& scene) {
  reader.require_object(value, "render", kOptions);
  for (std::size_t i = 0; i < value.keys().size(); ++i) {
    const JsonValue& option = value.elements()[i];
    const std::string name = "render." + value.keys()[i];
    if (option.kind() != Kind::kString && option.kind() != Kind::kNumber) {
      reader.fail(option, name, "a number or a string, as on the command line");
    }
    scene.options.push_back({value.keys()[i],
                             option.kind() == Kind::kString ? option.string() : option.shown(),
                             option.line()});
  }
}

}  // namespace

SceneFile read_scene_file(const std::filesystem::path& file) {
  const JsonValue root = JsonValue::read(file);
  const JsonReader reader(file);
  std::vector<const char*> known = {"obj", "camera", "instances"};
  known.insert(known.end(), std::begin(kLightKeys), std::end(kLightKeys));
  known.push_back("render");
  reader.require_object(root, "scene", known);
  SceneFile scene;
  scene.file = file;
  scene.obj = find_scene_file(std::filesystem::path(file).replace_extension());
  if (const JsonValue* obj = JsonReader::find(root, "obj")) {
    if (obj->kind() != Kind::kString || obj->string().empty()) {
      reader.fail(*obj, "obj", "the name of a scene");
    }
    scene.obj = file.parent_path() / obj->string();
  }
  if (const JsonValue* camera = JsonReader::find(root, "camera"))
    read_cameras(reader, *camera, scene);
  scene.instances = read_instances(reader, file.parent_path(), JsonReader::find(root, "instances"));
  scene.lights = read_lights(reader, root, file.parent_path());
  if (const JsonValue* render = JsonReader::find(root, "render"))
    read_options(reader, *render, scene);
  return scene;
}

Scene load_scene(const SceneFile& file, const LoadOptions& options) {
  LoadOptions kept = options;
  kept.keep_instances = true;
  Scene scene = load_scene(file.obj, kept);
  add_instances(file.instances, file.file, options, scene);
  if (!options.keep_instances) resolve_instances(scene, InstanceMode::kFlatten, file.file);
  return scene;
}

void add_lights(const SceneFile& file, Scene& scene) { add_lights(file.lights, file.file, scene); }

}  // namespace raygate
