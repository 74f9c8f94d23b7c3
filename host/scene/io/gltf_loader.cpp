#include "host/scene/io/gltf_loader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "host/base/input_error.h"
#include "host/scene/io/gltf_camera.h"
#include "host/scene/io/gltf_file.h"
#include "host/scene/io/gltf_lights.h"
#include "host/scene/io/gltf_meshes.h"
#include "host/scene/io/gltf_places.h"
#include "host/scene/io/instance_settings.h"
#include "host/scene/io/mesh_builder.h"

namespace raygate {
namespace {

/// A mesh that stands in several places.
struct SharedMesh {
  Scene part;                      // until it is the scene's
  Bounds3 box;                     // around its positions
  std::optional<PlacedMesh> mesh;  // then
};

/// One of these places.
struct Place {
  int mesh;
  glm::dmat4 world;
  std::uint32_t object;
};

bool is_finite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(m[column][row])) return false;
    }
  }
  return true;
}

class GltfReader {
 public:
  GltfReader(const std::filesystem::path& path, const LoadOptions& options)
      : file_(path),
        options_(options),
        own_{MeshBuilder(file_.name())},
        meshes_(file_, scene_, options.textures),
        lights_(file_, scene_) {}

  Scene read() {
    walk(roots());
    for (const auto& [node, world] : nodes_) count_uses(*node);
    for (const auto& [node, world] : nodes_) read_node(*node, world);
    for (const Place& place : places_) expand_extent(place);
    if (!places_.empty()) own_.builder.allow_empty();
    own_.builder.build(options_, scene_);
    for (const Place& place : places_) add_instance(place);
    if (is_empty(scene_)) throw InputError(file_.name() + ": no face has an area");
    lights_.place();
    aim_camera(scene_);
    if (!options_.keep_instances) resolve_instances(scene_, InstanceMode::kFlatten, file_.name());
    scene_.up = glm::dvec3(0.0, 1.0, 0.0);
    scene_.files = file_.files();
    if (!file_.model().animations.empty() || !file_.model().skins.empty()) {
      file_.warn_once("animations and skins are not read", scene_.warnings);
    }
    return std::move(scene_);
  }

 private:
  [[nodiscard]] std::vector<int> roots() const {
    const tinygltf::Model& model = file_.model();
    if (!model.scenes.empty()) {
      return file_.at(model.scenes, std::max(model.defaultScene, 0), "scene").nodes;
    }
    std::vector<bool> is_child(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes) {
      for (const int child : node.children) {
        (void)file_.at(model.nodes, child, "node");
        is_child[static_cast<std::size_t>(child)] = true;
      }
    }
    std::vector<int> found;
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
      if (!is_child[i]) found.push_back(static_cast<int>(i));
    }
    return found;
  }

  void walk(const std::vector<int>& roots) {
    struct Step {
      int node;
      glm::dmat4 parent;
    };
    std::vector<Step> steps;
    const auto add = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
      for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
        steps.push_back({*node, parent});
    };
    std::vector<bool> seen(file_.model().nodes.size());
    add(roots, glm::dmat4(1.0));
    while (!steps.empty()) {
      const Step step = steps.back();
      steps.pop_back();
      const tinygltf::Node& node = file_.at(file_.model().nodes, step.node, "node");
      if (seen[static_cast<std::size_t>(step.node)]) {
        file_.fail("node " + std::to_string(step.node) + " has two parents, expected one");
      }
      seen[static_cast<std::size_t>(step.node)] = true;
      const glm::dmat4 world = step.parent * local_matrix(node);
      if (!is_finite(world)) {
        file_.fail("node " + std::to_string(step.node) + ": its place is not finite");
      }
      nodes_.emplace_back(&node, world);
      add(node.children, world);
    }
  }

  void read_node(const tinygltf::Node& node, const glm::dmat4& world) {
    if (node.mesh >= 0) {
      const tinygltf::Mesh& mesh = file_.at(file_.model().meshes, node.mesh, "mesh");
      const auto object = static_cast<std::uint32_t>(scene_.objects.size());
      scene_.objects.push_back(!node.name.empty()   ? node.name
                               : !mesh.name.empty() ? mesh.name
                                                    : "object " + std::to_string(object));
      if (uses_[node.mesh] > 1) {
        for (const glm::dmat4& own : places_in(file_, node)) {
          places_.push_back({node.mesh, world * own, object});
        }
      } else {
        meshes_.read(mesh, world, object, own_);
      }
    }
    if (node.camera >= 0) {
      read_camera(file_, file_.at(file_.model().cameras, node.camera, "camera"), world, scene_);
    }
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end() && light->second.Has("light") &&
        light->second.Get("light").IsInt()) {
      lights_.add(
          file_.at(file_.model().lights, light->second.Get("light").GetNumberAsInt(), "light"),
          world);
    }
  }

  void count_uses(const tinygltf::Node& node) {
    if (node.mesh < 0) return;
    const bool many = node.extensions.contains("EXT_mesh_gpu_instancing");
    uses_[node.mesh] += many ? 2 : 1;
  }

  /// The mesh of a place, read when it is first asked for: in its own coordinates.
  SharedMesh& shared(int number) {
    const auto [at, is_new] = shared_.try_emplace(number);
    if (!is_new) return at->second;
    GltfGeometry geometry{MeshBuilder(file_.name())};
    geometry.builder.allow_empty();
    meshes_.read(file_.model().meshes[static_cast<std::size_t>(number)], glm::dmat4(1.0), 0,
                 geometry);
    Scene& part = at->second.part;
    geometry.builder.build(options_, part);
    if (!part.triangles.empty()) at->second.box = bounds_of(part.positions);
    return at->second;
  }

  /// The whole scene is recentred. And what will be written out is counted.
  void expand_extent(const Place& place) {
    const auto& [part, own_box, ignored] = shared(place.mesh);
    if (part.triangles.empty()) return;
    if (!options_.keep_instances) meshes_.count(part.positions.size() + 3 * part.triangles.size());
    const Bounds3 box = transform_bounds(rows_of(place.world), part.origin, own_box);
    constexpr double kMost = std::numeric_limits<float>::max();
    if (!(largest(box.low) <= kMost && largest(box.high) <= kMost)) {
      file_.fail("a vertex is beyond the range of float");
    }
    own_.builder.expand_extent(box);
  }

  void add_instance(const Place& place) {
    SharedMesh& shared_mesh = shared(place.mesh);
    if (!shared_mesh.mesh) {
      if (shared_mesh.part.triangles.empty()) return;
      shared_mesh.mesh.emplace(scene_, std::move(shared_mesh.part));
    }
    if (!shared_mesh.mesh->add(rows_of(place.world), place.object)) {
      file_.fail("an instance is beyond the range of float");
    }
  }

  const GltfFile file_;
  const LoadOptions& options_;
  Scene scene_;
  GltfGeometry own_;  // of meshes that stand in one place
  GltfMeshes meshes_;
  GltfLights lights_;
  std::vector<std::pair<const tinygltf::Node*, glm::dmat4>> nodes_;  // in their order
  std::map<int, int> uses_;                                          // of meshes, by number
  std::map<int, SharedMesh> shared_;
  std::vector<Place> places_;
};

}  // namespace

Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options) {
  return GltfReader(file, options).read();
}

}  // namespace raygate
