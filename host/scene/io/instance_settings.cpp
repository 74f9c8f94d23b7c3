#include "host/scene/io/instance_settings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/base/input_error.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

TransformRows read_place(const JsonReader& reader, const JsonValue& value,
                         const std::string& name) {
  const auto numbers = reader.array(&value, name);
  TransformRows rows = {glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0)};
  const auto number = [&](std::size_t i) {
    return reader.number(numbers[i], name + "[" + std::to_string(i) + "]");
  };
  if (numbers.size() == 3) {
    for (std::size_t k = 0; k < 3; ++k) rows[k].w = number(k);
  } else if (numbers.size() == 12) {
    for (std::size_t i = 0; i < 12; ++i) rows[i / 4][static_cast<int>(i % 4)] = number(i);
  } else {
    reader.fail(value, name, "a place of 3 numbers, or the 12 of a matrix of 3 rows");
  }
  return rows;
}

}  // namespace

std::vector<InstanceSetting> read_instances(const JsonReader& reader,
                                            const std::filesystem::path& folder,
                                            const JsonValue* value) {
  std::vector<InstanceSetting> settings;
  for (const JsonValue& entry : reader.array(value, "instances")) {
    const std::string name = "instances[" + std::to_string(settings.size()) + "]";
    constexpr const char* kKeys[] = {"model", "places"};
    reader.require_object(entry, name, kKeys);
    const JsonValue& model = reader.need(entry, name, "model");
    if (model.kind() != JsonValue::Kind::kString || model.string().empty()) {
      reader.fail(model, name + ".model", "the name of a model");
    }
    InstanceSetting& setting = settings.emplace_back();
    setting.model = folder / model.string();
    setting.line = entry.line();
    for (const JsonValue& place :
         reader.array(&reader.need(entry, name, "places"), name + ".places")) {
      setting.places.push_back(read_place(
          reader, place, name + ".places[" + std::to_string(setting.places.size()) + "]"));
    }
  }
  return settings;
}

namespace {

/// From coordinates relative to `from` to those relative to `to`.
void set_rows(const TransformRows& rows, const glm::dvec3& from, const glm::dvec3& to,
              Instance& instance) {
  for (int k = 0; k < 3; ++k) {
    const glm::dvec4& row = rows[static_cast<std::size_t>(k)];
    for (int axis = 0; axis < 3; ++axis) instance.rows[k][axis] = row[axis];
    instance.rows[k][3] = row.w + glm::dot(glm::dvec3(row), from) - to[k];
  }
}

}  // namespace

Bounds3 transform_bounds(const TransformRows& rows, const glm::dvec3& origin, const Bounds3& box) {
  Instance instance;
  set_rows(rows, origin, glm::dvec3(0.0), instance);
  return transform_bounds(instance.rows, box);
}

PlacedMesh::PlacedMesh(Scene& scene, Scene&& part)
    : scene_(scene), origin_(part.origin), mesh_(add_mesh(scene, std::move(part))) {
  const Bounds3 box = bounds_of(scene.meshes[mesh_].positions);
  size_ = glm::max(glm::abs(box.low), glm::abs(box.high));
}

bool PlacedMesh::add(const TransformRows& rows, std::uint32_t object) {
  Instance instance{.mesh = mesh_, .object = object};
  set_rows(rows, origin_, scene_.origin, instance);
  for (const auto& row : instance.rows) {
    constexpr double kMost = 0x1p100;
    const double sum = std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]);
    const double most = std::abs(row[0]) * size_.x + std::abs(row[1]) * size_.y +
                        std::abs(row[2]) * size_.z + std::abs(row[3]);
    if (!(sum <= kMost && most <= kMost)) return false;
  }
  const glm::dvec3 x(rows[0]), y(rows[1]), z(rows[2]);
  if (glm::dot(glm::cross(x, y), z) < 0.0) {
    if (turned_ == kNoIndex) turned_ = add_mirrored(scene_, mesh_);
    instance.mesh = turned_;
  }
  scene_.instances.push_back(instance);
  return true;
}

void resolve_instances(Scene& scene, InstanceMode use, const std::filesystem::path& file) {
  if (!resolve_instances(scene, use)) {
    throw InputError(file.string() + ": found " + std::to_string(triangle_count(scene)) +
                     " triangles with all instances, expected fewer than 2^31");
  }
}

void add_instances(const std::vector<InstanceSetting>& settings, const std::filesystem::path& file,
                   const LoadOptions& options, Scene& scene) {
  for (const InstanceSetting& setting : settings) {
    LoadOptions written = options;
    written.keep_instances = false;
    Scene model = load_scene(setting.model, written);
    const std::vector<std::string> objects = std::move(model.objects);
    PlacedMesh mesh(scene, std::move(model));
    for (const TransformRows& rows : setting.places) {
      const auto object = static_cast<std::uint32_t>(scene.objects.size());
      if (!mesh.add(rows, object)) {
        throw InputError(
            file.string(), setting.line,
            "an instance of " + setting.model.string() + " is beyond the range of float");
      }
      scene.objects.insert(scene.objects.end(), objects.begin(), objects.end());
    }
  }
}

}  // namespace raygate
