#include "host/scene/io/scene_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "host/exact/exact_sign.h"
#include "host/scene/io/input_error.h"
#include "host/scene/io/located_json.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/words.h"

namespace raygate {
namespace {

using Kind = JsonValue::Kind;

/// What may stand in "render": the options that change the picture.
constexpr const char* kOptions[] = {"size",    "integrator", "spp",  "depth",    "threshold",
                                    "ambient", "filter",     "seed", "exposure", "tone"};

/// Values of one file, asked for by what they must be.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file.string()) {}

  [[noreturn]] void fail(const JsonValue& value, const std::string& name,
                         const std::string& expected) const {
    throw InputError(file_, value.line(), name + ": " + value.shown() + ", expected " + expected);
  }

  /// The value of a key of an object; nullptr if it is not there.
  [[nodiscard]] static const JsonValue* find(const JsonValue& object, const std::string& key) {
    const auto& keys = object.keys();
    const auto found = std::ranges::find(keys, key);
    if (found == keys.end()) return nullptr;
    return &object.elements()[static_cast<std::size_t>(found - keys.begin())];
  }

  void require_object(const JsonValue& value, const std::string& name,
                      std::span<const char* const> known) const {
    std::string names;
    for (const char* key : known) names.append(names.empty() ? "" : ", ").append(key);
    if (value.kind() != Kind::kObject) fail(value, name, "an object with " + names);
    const auto unknown = std::ranges::find_if(value.keys(), [&](const std::string& key) {
      return std::ranges::find(known, key) == known.end();
    });
    if (unknown == value.keys().end()) return;
    const auto index = static_cast<std::size_t>(unknown - value.keys().begin());
    throw InputError(file_, value.elements()[index].line(),
                     name + ": unknown key " + in_quotes(*unknown) + ", expected some of " + names);
  }

  /// The value of a key that must be there.
  [[nodiscard]] const JsonValue& need(const JsonValue& object, const std::string& name,
                                      const std::string& key) const {
    const JsonValue* const found = find(object, key);
    if (found == nullptr)
      throw InputError(file_, object.line(), name + ": '" + key + "' is missing");
    return *found;
  }

  [[nodiscard]] double number(const JsonValue& value, const std::string& name) const {
    if (value.kind() != Kind::kNumber || !(std::abs(value.number()) <= kLargest)) {
      fail(value, name, "a number within the range of float");
    }
    return value.number();
  }

  [[nodiscard]] glm::dvec3 vector(const JsonValue& value, const std::string& name) const {
    if (value.kind() != Kind::kArray || value.elements().size() != 3) {
      fail(value, name, "[x, y, z]");
    }
    glm::dvec3 xyz;
    for (int k = 0; k < 3; ++k) {
      xyz[k] = number(value.elements()[static_cast<std::size_t>(k)], name);
    }
    return xyz;
  }

  /// [r, g, b], or one number for all three.
  [[nodiscard]] glm::vec3 light(const JsonValue& value, const std::string& name) const {
    const bool is_grey = value.kind() == Kind::kNumber;
    if (!is_grey && (value.kind() != Kind::kArray || value.elements().size() != 3)) {
      fail(value, name, "[red, green, blue] or one number for all three");
    }
    const glm::dvec3 rgb = is_grey ? glm::dvec3(number(value, name)) : vector(value, name);
    if (glm::min(rgb.x, glm::min(rgb.y, rgb.z)) < 0.0) fail(value, name, "no negative number");
    return glm::vec3(rgb);
  }

  /// An array; no value is an empty one.
  [[nodiscard]] std::span<const JsonValue> array(const JsonValue* value,
                                                 const std::string& name) const {
    if (value == nullptr) return {};
    if (value->kind() != Kind::kArray) fail(*value, name, "an array");
    return value->elements();
  }

 private:
  static constexpr double kLargest = std::numeric_limits<float>::max();
  std::string file_;
};

std::optional<glm::dvec3> read_up(const Reader& reader, const JsonValue& camera,
                                  const std::string& name) {
  const JsonValue* const value = Reader::find(camera, "up");
  if (value == nullptr) return std::nullopt;
  const glm::dvec3 up = reader.vector(*value, name + ".up");
  if (up == glm::dvec3(0.0)) reader.fail(*value, name + ".up", "a direction across the view");
  return up;
}

std::optional<double> read_fov(const Reader& reader, const JsonValue& camera,
                               const std::string& name) {
  const JsonValue* const value = Reader::find(camera, "fov");
  if (value == nullptr) return std::nullopt;
  const double fov = reader.number(*value, name + ".fov");
  if (!(fov > 0.0 && fov < 180.0)) {
    reader.fail(*value, name + ".fov", "degrees above 0 and below 180");
  }
  return fov;
}

CameraSetting read_camera(const Reader& reader, const JsonValue& value, const std::string& name) {
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
      reader.fail(*Reader::find(value, "up"), name + ".up", "a direction across the view");
    }
  }
  camera.fov = read_fov(reader, value, name);
  return camera;
}

void read_cameras(const Reader& reader, const JsonValue& value, SceneFile& scene) {
  constexpr const char* kKeys[] = {"eye", "target", "up", "fov", "path"};
  reader.require_object(value, "camera", kKeys);
  const JsonValue* const path = Reader::find(value, "path");
  if (Reader::find(value, "eye") != nullptr || Reader::find(value, "target") != nullptr) {
    scene.camera = read_camera(reader, value, "camera");
  }
  scene.up = read_up(reader, value, "camera");
  scene.fov = read_fov(reader, value, "camera");
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

void read_lights(const Reader& reader, const JsonValue& root, SceneFile& scene) {
  for (const JsonValue& value : reader.array(Reader::find(root, "point_lights"), "point_lights")) {
    constexpr const char* kKeys[] = {"position", "intensity"};
    const std::string name = "point_lights[" + std::to_string(scene.point_lights.size()) + "]";
    reader.require_object(value, name, kKeys);
    scene.point_lights.push_back(
        {reader.vector(reader.need(value, name, "position"), name + ".position"),
         reader.light(reader.need(value, name, "intensity"), name + ".intensity")});
  }
  for (const JsonValue& value : reader.array(Reader::find(root, "area_lights"), "area_lights")) {
    constexpr const char* kKeys[] = {"corner", "edges", "radiance"};
    const std::string name = "area_lights[" + std::to_string(scene.area_lights.size()) + "]";
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
    scene.area_lights.push_back(light);
  }
}

void read_options(const Reader& reader, const JsonValue& value, SceneFile& scene) {
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

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

SceneFile read_scene_file(const std::filesystem::path& file) {
  const JsonValue root = JsonValue::read(file);
  const Reader reader(file);
  constexpr const char* kKeys[] = {"obj",         "camera",     "point_lights",
                                   "area_lights", "background", "render"};
  reader.require_object(root, "scene", kKeys);
  SceneFile scene;
  scene.file = file;
  scene.obj = scene_of_stem(std::filesystem::path(file).replace_extension());
  if (const JsonValue* obj = Reader::find(root, "obj")) {
    if (obj->kind() != Kind::kString || obj->string().empty()) {
      reader.fail(*obj, "obj", "the name of a scene");
    }
    scene.obj = file.parent_path() / obj->string();
  }
  if (const JsonValue* camera = Reader::find(root, "camera")) read_cameras(reader, *camera, scene);
  read_lights(reader, root, scene);
  if (const JsonValue* background = Reader::find(root, "background")) {
    scene.background = reader.light(*background, "background");
  }
  if (const JsonValue* render = Reader::find(root, "render")) read_options(reader, *render, scene);
  return scene;
}

void add_lights(const SceneFile& file, Scene& scene) {
  for (const PointLightSetting& light : file.point_lights) {
    const glm::vec3 position(light.position - scene.origin);
    if (!is_finite(position)) {
      throw InputError(file.file.string() + ": a point light is beyond the range of float");
    }
    scene.lights.push_back({position, light.intensity});
  }
  if (file.background) scene.background = *file.background;
  int number = 0;
  for (const AreaLightSetting& light : file.area_lights) {
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
      throw InputError(file.file.string() + ": area_lights[" + std::to_string(number - 1) +
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
