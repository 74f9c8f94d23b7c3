#include "host/scene/instances.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace raygate {
namespace {

/// Appends `more` and gives the number that its first element has now.
template <class T>
std::uint32_t append(std::vector<T>& all, std::vector<T>&& more) {
  const auto first = static_cast<std::uint32_t>(all.size());
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return first;
}

void shift(std::array<std::uint32_t, 3>& indices, std::uint32_t by) {
  for (std::uint32_t& index : indices) {
    if (index != kNoIndex) index += by;
  }
}

void grow(Bounds3& box, const glm::dvec3& position) {
  box.low = glm::min(box.low, position);
  box.high = glm::max(box.high, position);
}

/// Drops positions of no triangle.
void compact(Mesh& mesh) {
  std::vector<std::uint32_t> renumbered(mesh.positions.size(), kNoIndex);
  std::vector<glm::vec3> kept;
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle.vertices) {
      if (renumbered[vertex] == kNoIndex) {
        renumbered[vertex] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(mesh.positions[vertex]);
      }
      vertex = renumbered[vertex];
    }
  }
  mesh.positions = std::move(kept);
}

/// The run of Scene::normals that a mesh's triangles name; empty where they name none.
struct Run {
  std::uint32_t begin = kNoIndex, end = 0;

  explicit Run(const Mesh& mesh) {
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t normal : triangle.normals) {
        if (normal == kNoIndex) continue;
        begin = std::min(begin, normal);
        end = std::max(end, normal + 1);
      }
    }
  }
};

}  // namespace

std::uint64_t triangle_count(const Scene& scene) {
  std::uint64_t count = scene.triangles.size();
  for (const Instance& instance : scene.instances) {
    count += scene.meshes[instance.mesh].triangles.size();
  }
  return count;
}

std::uint32_t add_mesh(Scene& scene, Scene&& part) {
  const bool has_materials = !part.materials.empty();
  const std::uint32_t normals = append(scene.normals, std::move(part.normals));
  const std::uint32_t texcoords = append(scene.texcoords, std::move(part.texcoords));
  const std::uint32_t textures = append(scene.textures, std::move(part.textures));
  for (Material& material : part.materials) {
    const auto shift = [&](std::uint32_t& texture) {
      if (texture != kNoIndex) texture += textures;
    };
    shift(material.diffuse_texture);
    shift(material.normal_map.texture);
    shift(material.opacity_map.texture);
    if (material.metallic_roughness) shift(material.metallic_roughness->map.texture);
  }
  const std::uint32_t materials = append(scene.materials, std::move(part.materials));
  (void)append(scene.files, std::move(part.files));
  (void)append(scene.warnings, std::move(part.warnings));
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = std::move(part.positions);
  mesh.triangles = std::move(part.triangles);
  for (Triangle& triangle : mesh.triangles) {
    shift(triangle.normals, normals);
    shift(triangle.texcoords, texcoords);
    if (has_materials) triangle.material += materials;
  }
  compact(mesh);
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

std::uint32_t add_mirrored(Scene& scene, std::uint32_t mesh) {
  Mesh turned = scene.meshes[mesh];
  // Normals point to the front, on whichever side that is.
  const Run normals(turned);
  const auto first = static_cast<std::uint32_t>(scene.normals.size());
  for (std::uint32_t i = normals.begin; i < normals.end; ++i) {
    scene.normals.push_back(-glm::vec3(scene.normals[i]));
  }
  for (Triangle& triangle : turned.triangles) {
    std::swap(triangle.vertices[0], triangle.vertices[2]);
    std::swap(triangle.texcoords[0], triangle.texcoords[2]);
    std::swap(triangle.normals[0], triangle.normals[2]);
    shift(triangle.normals, first - normals.begin);
  }
  scene.meshes.push_back(std::move(turned));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

namespace {

void write(Scene& scene, std::span<const Instance> instances) {
  std::size_t positions = scene.positions.size(), triangles = scene.triangles.size();
  for (const Instance& instance : instances) {
    positions += scene.meshes[instance.mesh].positions.size();
    triangles += scene.meshes[instance.mesh].triangles.size();
  }
  scene.positions.reserve(positions);
  scene.triangles.reserve(triangles);
  std::vector<Run> normals;
  normals.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) normals.emplace_back(mesh);
  for (const Instance& instance : instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::vec3& position : mesh.positions) {
      scene.positions.push_back(transform_point(instance.rows, position));
    }
    const Run& run = normals[instance.mesh];
    const auto first_normal = static_cast<std::uint32_t>(scene.normals.size());
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      scene.normals.push_back(transform_normal(instance, glm::vec3(scene.normals[i])));
    }
    for (Triangle triangle : mesh.triangles) {
      shift(triangle.vertices, first);
      shift(triangle.normals, first_normal - run.begin);
      triangle.object += instance.object;
      scene.triangles.push_back(triangle);
    }
  }
}

}  // namespace

void flatten_instances(Scene& scene) {
  const std::vector<Instance> instances = std::exchange(scene.instances, {});
  write(scene, instances);
  scene.meshes.clear();
}

namespace {

/// Before all others.
void flatten_emitters(Scene& scene) {
  std::vector<bool> emits;
  emits.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) {
    emits.push_back(std::ranges::any_of(mesh.triangles, [&](const Triangle& triangle) {
      return scene.materials[triangle.material].emission != glm::vec3(0.0f);
    }));
  }
  // Clang 14 doesn't compile the library's std::ranges::stable_partition.
  const auto others =
      std::stable_partition(scene.instances.begin(), scene.instances.end(),
                            [&](const Instance& instance) { return emits[instance.mesh]; });
  const std::vector<Instance> emitters(scene.instances.begin(), others);
  scene.instances.erase(scene.instances.begin(), others);
  write(scene, emitters);
  for (std::size_t i = 0; i < emits.size(); ++i) {
    if (emits[i]) scene.meshes[i] = {};
  }
}

}  // namespace

bool resolve_instances(Scene& scene, InstanceMode use) {
  if (scene.instances.empty()) return true;
  const std::uint64_t triangles = triangle_count(scene);
  if (triangles + scene.instances.size() >= (std::uint64_t{1} << 31) - 1) return false;
  flatten_emitters(scene);
  const bool is_many = triangles - scene.triangles.size() > kFlattenLimit;
  if (use == InstanceMode::kFlatten || (use == InstanceMode::kAutomatic && !is_many)) {
    flatten_instances(scene);
  }
  return true;
}

Bounds3 bounds_of(std::span<const glm::vec3> positions) {
  const glm::dvec3 first(positions[0]);
  Bounds3 box{first, first};
  for (const glm::vec3& position : positions) grow(box, position);
  return box;
}

// The largest of a coordinate is at one of the box's corners, in the very operations of
// transform_coordinate, too: each of them is monotonic in its operands, rounding included.
Bounds3 transform_bounds(const double (&rows)[3][4], const Bounds3& box) {
  Bounds3 result{};
  for (int k = 0; k < 3; ++k) {
    const auto& row = rows[k];
    double low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_turned = row[axis] < 0.0;
      low[axis] = is_turned ? box.high[axis] : box.low[axis];
      high[axis] = is_turned ? box.low[axis] : box.high[axis];
    }
    transform_coordinate(row, low, result.low[k]);
    transform_coordinate(row, high, result.high[k]);
  }
  return result;
}

void expand_by_instances(const Scene& scene, Bounds3& box) {
  std::vector<Bounds3> boxes;
  boxes.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) {
    boxes.push_back(mesh.positions.empty() ? Bounds3{} : bounds_of(mesh.positions));
  }
  for (const Instance& instance : scene.instances) {
    const Bounds3 whole = transform_bounds(instance.rows, boxes[instance.mesh]);
    // Rounding to float keeps order: the middle of the scene need not be looked at.
    if (glm::all(glm::lessThanEqual(box.low, glm::dvec3(glm::vec3(whole.low)))) &&
        glm::all(glm::lessThanEqual(glm::dvec3(glm::vec3(whole.high)), box.high))) {
      continue;
    }
    for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
      grow(box, transform_point(instance.rows, position));
    }
  }
}

namespace {

/// A box to begin with: around `position`, or around a position of an instance.
Bounds3 first_box(const Scene& scene, const glm::vec3* position) {
  glm::dvec3 first;
  if (position != nullptr) {
    first = *position;
  } else {
    const Instance& instance = scene.instances.at(0);
    first = transform_point(instance.rows, scene.meshes[instance.mesh].positions[0]);
  }
  return {first, first};
}

}  // namespace

Bounds3 triangle_bounds(const Scene& scene) {
  Bounds3 box = first_box(
      scene, scene.triangles.empty() ? nullptr : &scene.positions[scene.triangles[0].vertices[0]]);
  for (const Triangle& triangle : scene.triangles) {
    for (const std::uint32_t vertex : triangle.vertices) grow(box, scene.positions[vertex]);
  }
  expand_by_instances(scene, box);
  return box;
}

Bounds3 position_bounds(const Scene& scene) {
  Bounds3 box = first_box(scene, scene.positions.empty() ? nullptr : &scene.positions[0]);
  for (const glm::vec3& position : scene.positions) grow(box, position);
  expand_by_instances(scene, box);
  return box;
}

}  // namespace raygate
