#include "host/scene/io/scene_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/instances.h"
#include "host/scene/io/json_reader.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

struct Kind {
  const char* ending;
  Scene (*load)(const std::filesystem::path&, const LoadOptions&);
};
constexpr Kind kKinds[] = {{".obj", load_obj},
                           {".glb", load_gltf},
                           {".gltf", load_gltf},
                           {".ply", load_ply},
                           {".stl", load_stl}};

/// Returns the reader for the ending of `file`, OBJ's for none. Throws InputError for others.
auto loader_of(const std::filesystem::path& file) {
  const std::string ending = in_lower_case(file.extension().string());
  if (ending.empty()) return kKinds[0].load;
  for (const Kind& kind : kKinds) {
    if (ending == kind.ending) return kind.load;
  }
  throw InputError(file.string() + ": found a " + file.extension().string() +
                   " file, expected .obj, .glb, .gltf, .ply or .stl; Blender writes them by File > "
                   "Export > glTF 2.0 (with materials, lights and camera) or Wavefront (.obj)");
}

constexpr double kMost = std::numeric_limits<float>::max();
constexpr double kLeast = std::numeric_limits<float>::min();

CameraRequest read_camera(const JsonValue& value) {
  value.require_keys({"eye", "target", "up", "fov", "projection", "aperture", "focus"});
  CameraRequest request;
  const auto up = value.find("up");
  const std::string across = "a direction across the view";
  if (up) request.up = up->vector();
  if (request.up == glm::dvec3(0.0)) up->fail(across);
  request.fov =
      value.number_in("fov", kLeast, std::nextafter(180.0, 0.0), "degrees above 0 and below 180");
  if (const auto name = value.find("projection")) {
    const std::string expected = "perspective or orthographic", found = name->string(expected);
    for (const auto& [known, projection] : kProjections) {
      if (found == known) request.lens.projection = projection;
    }
    if (!request.lens.projection) name->fail(expected);
  }
  request.lens.aperture =
      value.number_in("aperture", 0.0, kMost, "the radius of a lens, 0 or more");
  request.lens.focus = value.number_in("focus", kLeast, kMost, "a distance, more than 0");
  if (!value.find("eye") && !value.find("target")) return request;
  const JsonValue target = value.at("target");
  const CameraSetting& camera = request.camera.emplace(
      CameraSetting{value.at("eye").vector(), target.vector(), std::exchange(request.up, {}),
                    std::exchange(request.fov, {}).value_or(Camera::kDefaultFov)});
  const glm::dvec3 view = camera.target - camera.eye;
  if (view == glm::dvec3(0.0)) target.fail("another point than the eye");
  if (!up) return request;
  const double sine_times_lengths = glm::length(glm::cross(view, *camera.up));
  if (!(sine_times_lengths > 1e-9 * glm::length(view) * glm::length(*camera.up))) up->fail(across);
  return request;
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
  cone.outer = light.number_in("outer", 1e-3, 90.0, "degrees from the axis, 0.001 to 90")
                   .value_or(cone.outer);
  cone.inner = light.number_in("inner", 0.0, cone.outer, "degrees from the axis, from 0 to 'outer'")
                   .value_or(cone.inner);
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

void read_lights(const JsonValue& root, const std::filesystem::path& folder, SceneFile& scene) {
  for (const JsonValue& value : root.elements("point_lights")) {
    value.require_keys({"position", "intensity"});
    scene.point_lights.push_back({value.at("position").vector(), value.at("intensity").light()});
  }
  for (const JsonValue& value : root.elements("spot_lights")) {
    value.require_keys({"position", "direction", "intensity", "inner", "outer"});
    const SpotCone cone = read_spot(value);
    scene.point_lights.push_back(
        {value.at("position").vector(), value.at("intensity").light(), cone});
  }
  for (const JsonValue& value : root.elements("directional_lights")) {
    value.require_keys({"direction", "irradiance"});
    scene.directional_lights.push_back(
        {value.at("direction").direction(), value.at("irradiance").light()});
  }
  for (const JsonValue& value : root.elements("area_lights")) {
    scene.area_lights.push_back(read_area(value));
  }
  if (const auto value = root.find("environment")) {
    value->require_keys({"file", "rotation", "strength"});
    scene.environment = {
        folder / value->at("file").string("the name of an EXR or HDR file"),
        value->number_in("rotation", -360.0, 360.0, "degrees from -360 to 360").value_or(0.0),
        value->number_in("strength", 0.0, 1e9, "a factor from 0 to 1e9").value_or(1.0)};
  }
  if (const auto value = root.find("background")) scene.background = value->light();
}

void add_lights(const SceneFile& file, Scene& scene) {
  for (const WorldPointLight& light : file.point_lights) {
    add_light(scene, light, file.file.string());
  }
  scene.directional_lights.insert(scene.directional_lights.end(), file.directional_lights.begin(),
                                  file.directional_lights.end());
  if (file.background) scene.background = *file.background;
  int number = 0;
  for (const AreaLightSetting& light : file.area_lights) {
    const glm::dvec3 corner = light.corner - scene.origin;
    const std::array<glm::vec3, 4> corners{corner, corner + light.edges[0],
                                           corner + light.edges[0] + light.edges[1],
                                           corner + light.edges[1]};
    const bool is_near = std::ranges::all_of(
        corners, [](const glm::vec3& at) { return largest(at) <= kMostCoordinate; });
    const auto is_flat = [](const FloatCorners& triangle) {
      return triangle_normal(widened(triangle)) == glm::dvec3(0.0);
    };
    if (!is_near || is_flat({corners[0], corners[1], corners[2]}) ||
        is_flat({corners[0], corners[2], corners[3]})) {
      throw InputError(file.file.string() + ": area_lights[" + std::to_string(number) +
                       "] is beyond the range of float, or too small for its place");
    }
    Material material;
    material.name = "light " + std::to_string(++number);
    material.diffuse = glm::vec3(0.0f);
    material.emission = light.radiance;
    add_quad(scene, corners, material);
  }
}

}  // namespace

void require_model_ending(const std::filesystem::path& file) { (void)loader_of(file); }

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
  return loader_of(file)(file, options);
}

std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                               std::string_view name, const std::string& place,
                                               std::vector<std::string>& warnings) {
  const bool is_quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
  std::string slashed(is_quoted ? name.substr(1, name.size() - 2) : name), plain(name);
  std::ranges::replace(slashed, '\\', '/');
  for (std::size_t at = 0; (at = plain.find("\\ ", at)) != plain.npos;) plain.erase(at, 1);
  std::error_code error;
  for (const std::string& spelling : {std::string(name), slashed, plain}) {
    std::filesystem::path file = folder / spelling;
    if (std::filesystem::is_regular_file(file, error)) return file;
  }
  const std::filesystem::path asked(slashed);
  const std::string wanted = in_lower_case(asked.filename().string());
  if (wanted.empty()) return std::nullopt;
  for (const std::filesystem::path& where : {folder / asked.parent_path(), folder}) {
    std::set<std::filesystem::path> found;
    for (std::filesystem::directory_iterator entry(where.empty() ? "." : where, error), end;
         !error && entry != end; entry.increment(error)) {
      const std::filesystem::path file = entry->path().filename();
      if (in_lower_case(file.string()) == wanted && entry->is_regular_file(error)) {
        found.insert(where / file);
      }
    }
    if (found.empty()) continue;
    warnings.push_back(place + in_quotes(name) + " is missing, " + found.begin()->string() +
                       " instead");
    return *found.begin();
  }
  return std::nullopt;
}

std::filesystem::path find_scene_file(const std::filesystem::path& stem) {
  std::filesystem::path file;
  for (const Kind& kind : kKinds) {
    std::error_code ignored;
    file = stem.string() + kind.ending;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
  }
  return stem.string() + kKinds[0].ending;
}

void load_textures(Scene& scene) {
  constexpr const char* kPlainInstead = ", its material is plain instead";
  std::map<std::pair<std::string, Texture::Content>, std::uint32_t> loaded;
  const auto load = [&](MaterialMap& map, Texture::Content content) {
    if (map.file.empty() || map.texture != kNoIndex) return;
    const auto [entry, is_new] = loaded.try_emplace(std::pair(map.file, content), kNoIndex);
    std::error_code ignored;
    if (is_new && !std::filesystem::is_regular_file(map.file, ignored)) {
      scene.warnings.push_back(map.file + ": the texture is missing" + kPlainInstead);
    } else if (is_new) {
      try {
        scene.textures.push_back(Texture::load(map.file, content));
        scene.files.emplace_back(map.file);
        entry->second = static_cast<std::uint32_t>(scene.textures.size() - 1);
      } catch (const InputError& error) {
        scene.warnings.push_back(std::string(error.what()) + kPlainInstead);
      }
    }
    map.texture = entry->second;
  };
  std::vector<bool> is_done(scene.materials.size());
  for (const Triangle& triangle : scene.triangles) {
    if (is_left_out(triangle) || is_done[triangle.material]) continue;
    is_done[triangle.material] = true;
    Material& material = scene.materials[triangle.material];
    MaterialMap& opacity = material.opacity_map;
    for_each_map(material, [&](MaterialMap& map) {
      load(map, &map == &opacity ? Texture::Content::kOpacity : Texture::Content::kColour);
    });
    if (opacity.texture != kNoIndex &&
        scene.textures[opacity.texture].min_code() >= material.opacity_cutoff) {
      opacity.texture = kNoIndex;  // hides nothing
    }
  }
}

SceneFile read_scene_file(const std::filesystem::path& file) {
  if (file.extension() != ".json") return {.file = file, .obj = file};
  const JsonFile json(file);
  const JsonValue root(json);
  const std::filesystem::path folder = file.parent_path();
  root.require_keys({"obj", "camera", "instances", "point_lights", "spot_lights",
                     "directional_lights", "area_lights", "environment", "background", "render"});
  SceneFile scene;
  scene.file = file;
  scene.obj = find_scene_file(std::filesystem::path(file).replace_extension());
  if (const auto obj = root.find("obj")) scene.obj = folder / obj->string("the name of a scene");
  if (const auto camera = root.find("camera")) scene.camera = read_camera(*camera);
  scene.instances = read_instances(root, folder);
  read_lights(root, folder, scene);
  if (const auto render = root.find("render")) {
    for (const auto& [key, value] : render->members()) {
      scene.options.push_back({key, value.word("a number or a string, as on the command line"),
                               file.string() + ":" + std::to_string(value.line())});
    }
  }
  return scene;
}

Scene load_scene(const SceneFile& file, const LoadOptions& options) {
  Scene scene = load_scene(file.obj, options);
  LoadOptions of_models = options;
  of_models.vertices = Vertices::kBinary32;
  for (const InstanceSetting& setting : file.instances) {
    Scene model = load_scene(setting.model, of_models);
    resolve_instances(model, InstanceMode::kFlatten, setting.model);
    const std::vector<std::string> objects = model.objects;
    MeshInstancer instancer(scene, std::move(model));
    for (const glm::dmat4& transform : setting.transforms) {
      if (!instancer.add(transform, static_cast<std::uint32_t>(scene.objects.size()))) {
        throw InputError(file.file.string() + ": an instance of " + setting.model.string() +
                         " is beyond the range of float");
      }
      scene.objects.insert(scene.objects.end(), objects.begin(), objects.end());
    }
  }
  add_lights(file, scene);
  return scene;
}

}  // namespace raygate
