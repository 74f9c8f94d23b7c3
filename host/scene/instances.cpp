#include "host/scene/instances.h"

#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/base/input_error.h"

namespace raygate {
namespace {

/// Appends `more` and returns the new index of its first element.
template <class T>
std::uint32_t append(std::vector<T>& all, std::vector<T>&& more) {
  const auto first = static_cast<std::uint32_t>(all.size());
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  return first;
}

/// Unless `more` is empty: pads `all` with `missing` to `count` elements, then appends `more`.
template <class T>
void append_parallel(std::vector<T>& all, std::size_t count, std::vector<T>&& more,
                     const T& missing = T(0.0f)) {
  if (more.empty()) return;
  all.resize(count, missing);
  (void)append(all, std::move(more));
}

void shift(std::array<std::uint32_t, 3>& indices, std::uint32_t by) {
  for (std::uint32_t& index : indices) {
    if (index != kNoIndex) index += by;
  }
}

/// Removes unreferenced positions.
void compact(Mesh& mesh) {
  std::vector<std::uint32_t> renumbered(mesh.positions.size(), kNoIndex);
  std::vector<glm::vec3> kept, kept_colors;
  mesh.colors.resize(mesh.colors.empty() ? 0 : mesh.positions.size(), glm::vec3(1.0f));
  for (Triangle& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle.vertices) {
      if (renumbered[vertex] == kNoIndex) {
        renumbered[vertex] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(mesh.positions[vertex]);
        if (!mesh.colors.empty()) kept_colors.push_back(mesh.colors[vertex]);
      }
      vertex = renumbered[vertex];
    }
  }
  mesh.positions = std::move(kept);
  mesh.colors = std::move(kept_colors);
}

/// The range of Scene::normals that a mesh's triangles use; empty if they use none.
struct NormalRange {
  std::uint32_t begin = kNoIndex, end = 0;

  explicit NormalRange(const Mesh& mesh) {
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

void set_rows(const glm::dmat4& world, const glm::dvec3& from, const glm::dvec3& to,
              Instance& instance) {
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 row(world[0][k], world[1][k], world[2][k]);
    for (int axis = 0; axis < 3; ++axis) instance.rows[k][axis] = row[axis];
    instance.rows[k][3] = world[3][k] + glm::dot(row, from) - to[k];
  }
}

std::uint32_t add_mesh(Scene& scene, Scene&& part) {
  const bool has_materials = !part.materials.empty();
  append_parallel(scene.tangents, scene.normals.size(), std::move(part.tangents));
  append_parallel(scene.second_texcoords, scene.texcoords.size(), std::move(part.second_texcoords));
  append_parallel(scene.opacities, scene.texcoords.size(), std::move(part.opacities), 1.0f);
  const std::uint32_t normals = append(scene.normals, std::move(part.normals));
  const std::uint32_t texcoords = append(scene.texcoords, std::move(part.texcoords));
  const std::uint32_t textures = append(scene.textures, std::move(part.textures));
  for (Material& material : part.materials) {
    for_each_map(material, [&](MaterialMap& map) {
      if (map.texture != kNoIndex) map.texture += textures;
    });
  }
  const std::uint32_t materials = append(scene.materials, std::move(part.materials));
  scene.rounding.add(part.rounding);
  (void)append(scene.files, std::move(part.files));
  (void)append(scene.warnings, std::move(part.warnings));
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = std::move(part.positions);
  mesh.colors = std::move(part.colors);
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
  Mesh mirrored = scene.meshes[mesh];
  // Normals point to the front side, which reversed winding exchanges with the back.
  const NormalRange normals(mirrored);
  const auto first = static_cast<std::uint32_t>(scene.normals.size());
  for (std::uint32_t i = normals.begin; i < normals.end; ++i) {
    scene.normals.push_back(-glm::vec3(scene.normals[i]));
    if (i < scene.tangents.size()) {
      const glm::vec4 tangent(glm::vec3(scene.tangents[i]), -scene.tangents[i].w);
      set_last(scene.tangents, scene.normals.size(), tangent, glm::vec4(0.0f));
    }
  }
  for (Triangle& triangle : mirrored.triangles) {
    std::swap(triangle.vertices[0], triangle.vertices[2]);
    std::swap(triangle.texcoords[0], triangle.texcoords[2]);
    std::swap(triangle.normals[0], triangle.normals[2]);
    shift(triangle.normals, first - normals.begin);
  }
  scene.meshes.push_back(std::move(mirrored));
  return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

MeshInstancer::MeshInstancer(Scene& scene, Scene&& part)
    : scene_(scene), origin_(part.origin), mesh_(add_mesh(scene, std::move(part))) {
  for (const glm::vec3& position : scene.meshes[mesh_].positions) {
    size_ = glm::max(size_, glm::dvec3(glm::abs(position)));
  }
}

bool MeshInstancer::add(const glm::dmat4& world, std::uint32_t object) {
  Instance instance{.mesh = mesh_, .object = object};
  set_rows(world, origin_, scene_.origin, instance);
  for (const auto& row : instance.rows) {
    constexpr double kMost = 0x1p100;
    const double sum = std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]);
    const double most = std::abs(row[0]) * size_.x + std::abs(row[1]) * size_.y +
                        std::abs(row[2]) * size_.z + std::abs(row[3]);
    if (!(sum <= kMost && most <= kMost)) return false;
  }
  const auto& m = instance.rows;
  const glm::dvec3 x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]),
      z(m[2][0], m[2][1], m[2][2]);
  if (glm::dot(glm::cross(x, y), z) < 0.0) {
    if (mirrored_ == kNoIndex) mirrored_ = add_mirrored(scene_, mesh_);
    instance.mesh = mirrored_;
  }
  scene_.instances.push_back(instance);
  return true;
}

namespace {

void flatten(Scene& scene, std::span<const Instance> instances) {
  std::size_t positions = scene.positions.size(), triangles = scene.triangles.size();
  for (const Instance& instance : instances) {
    positions += scene.meshes[instance.mesh].positions.size();
    triangles += scene.meshes[instance.mesh].triangles.size();
  }
  scene.positions.reserve(positions);
  scene.triangles.reserve(triangles);
  std::vector<NormalRange> normals;
  normals.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) normals.emplace_back(mesh);
  for (const Instance& instance : instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    if (!mesh.colors.empty()) {
      scene.colors.resize(first, glm::vec3(1.0f));
      scene.colors.insert(scene.colors.end(), mesh.colors.begin(), mesh.colors.end());
    }
    for (const glm::vec3& position : mesh.positions) {
      scene.positions.push_back(transform_point(instance.rows, position));
    }
    const NormalRange& range = normals[instance.mesh];
    const auto first_normal = static_cast<std::uint32_t>(scene.normals.size());
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      scene.normals.push_back(transform_normal(instance, glm::vec3(scene.normals[i])));
      if (i < scene.tangents.size()) {
        set_last(scene.tangents, scene.normals.size(),
                 transform_tangent(instance, scene.tangents[i]), glm::vec4(0.0f));
      }
    }
    for (Triangle triangle : mesh.triangles) {
      shift(triangle.vertices, first);
      shift(triangle.normals, first_normal - range.begin);
      triangle.object += instance.object;
      scene.triangles.push_back(triangle);
    }
  }
}

/// Flattens the emissive instances, so that their triangles precede those of all other instances.
void flatten_emitters(Scene& scene) {
  std::vector<bool> emits;
  emits.reserve(scene.meshes.size());
  for (const Mesh& mesh : scene.meshes) {
    emits.push_back(std::ranges::any_of(mesh.triangles, [&](const Triangle& triangle) {
      return !is_left_out(triangle) &&
             scene.materials[triangle.material].emission != glm::vec3(0.0f);
    }));
  }
  // Clang 14 cannot compile the library's std::ranges::stable_partition.
  const auto others =
      std::stable_partition(scene.instances.begin(), scene.instances.end(),
                            [&](const Instance& instance) { return emits[instance.mesh]; });
  const std::vector<Instance> emitters(scene.instances.begin(), others);
  scene.instances.erase(scene.instances.begin(), others);
  flatten(scene, emitters);
  for (std::size_t i = 0; i < emits.size(); ++i) {
    if (emits[i]) scene.meshes[i] = {};
  }
}

}  // namespace

void require_numbers(const Scene& scene, const std::filesystem::path& file) {
  const std::uint64_t triangles = triangle_count(scene);
  if (triangles + scene.instances.size() >= (std::uint64_t{1} << 31) - 1) {
    throw InputError(file.string() + ": found " + std::to_string(triangles) +
                     " triangles with all instances, expected fewer than 2^31");
  }
}

void resolve_instances(Scene& scene, InstanceMode mode, const std::filesystem::path& file) {
  if (scene.instances.empty()) return;
  require_numbers(scene, file);
  flatten_emitters(scene);
  const bool is_many = triangle_count(scene) - scene.triangles.size() > kFlattenLimit;
  if (mode == InstanceMode::kFlatten || (mode == InstanceMode::kAutomatic && !is_many)) {
    flatten(scene, std::exchange(scene.instances, {}));
    scene.meshes.clear();
  }
}

}  // namespace raygate
