#include "host/scene/io/gltf_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "host/scene/io/gltf_file.h"
#include "host/scene/io/gltf_materials.h"
#include "host/scene/io/gltf_places.h"
#include "host/scene/io/input_error.h"
#include "host/scene/io/instance_settings.h"
#include "host/scene/io/mesh_builder.h"

namespace raygate {
namespace {

constexpr double kLumensPerWatt = 683.0;
constexpr std::size_t kMostVertices = 12'000'000;  // besides one for each byte

/// A light of a point, where its node puts it.
struct PlacedLight {
  glm::dvec3 position;
  glm::dvec3 intensity;
  std::optional<SpotCone> spot;
};

/// What becomes of the vertices and faces of meshes, and how many it has so far.
struct Geometry {
  MeshBuilder builder;
  std::int32_t positions = 0, normals = 0, texcoords = 0;
};

/// A mesh that stands in several places.
struct SharedMesh {
  Scene part;                      // until it is the scene's
  PositionBox box;                 // around its positions
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
        materials_(file_, scene_) {}

  Scene read() {
    walk(roots());
    for (const auto& [node, world] : nodes_) count_uses(*node);
    for (const auto& [node, world] : nodes_) read_node(*node, world);
    for (const Place& place : places_) make_room(place);
    if (!places_.empty()) own_.builder.allow_nothing();
    own_.builder.build(options_, scene_);
    for (const Place& place : places_) add_instance(place);
    if (is_empty(scene_)) throw InputError(file_.name() + ": no face has an area");
    place_lights();
    if (!options_.keep_instances) settle_instances(scene_, InstanceUse::kWritten, file_.name());
    scene_.up = glm::dvec3(0.0, 1.0, 0.0);
    scene_.files = file_.files();
    if (!file_.model().animations.empty() || !file_.model().skins.empty()) {
      warn("animations and skins are not read");
    }
    return std::move(scene_);
  }

 private:
  void warn(const std::string& what) {
    const std::string warning = file_.name() + ": " + what;
    if (std::ranges::find(scene_.warnings, warning) == scene_.warnings.end()) {
      scene_.warnings.push_back(warning);
    }
  }

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
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
          read_primitive(primitive, world, object, own_);
        }
      }
    }
    if (node.camera >= 0)
      read_camera(file_.at(file_.model().cameras, node.camera, "camera"), world);
    const auto light = node.extensions.find("KHR_lights_punctual");
    if (light != node.extensions.end() && light->second.Has("light") &&
        light->second.Get("light").IsInt()) {
      read_light(
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
    Geometry geometry{MeshBuilder(file_.name())};
    geometry.builder.allow_nothing();
    for (const tinygltf::Primitive& primitive :
         file_.model().meshes[static_cast<std::size_t>(number)].primitives) {
      read_primitive(primitive, glm::dmat4(1.0), 0, geometry);
    }
    Scene& part = at->second.part;
    geometry.builder.build(options_, part);
    if (!part.triangles.empty()) at->second.box = box_around(part.positions);
    return at->second;
  }

  /// The whole scene is recentred. And what will be written out is counted.
  void make_room(const Place& place) {
    const auto& [part, own_box, ignored] = shared(place.mesh);
    if (part.triangles.empty()) return;
    if (!options_.keep_instances) count(part.positions.size() + 3 * part.triangles.size());
    const PositionBox box = placed(rows_of(place.world), part.origin, own_box);
    constexpr double kMost = std::numeric_limits<float>::max();
    if (!(largest(box.low) <= kMost && largest(box.high) <= kMost)) {
      file_.fail("a vertex is beyond the range of float");
    }
    own_.builder.make_room(box);
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

  /// The triangles' corners, as numbers of the primitive's vertices.
  [[nodiscard]] std::vector<std::uint32_t> corners_of(const tinygltf::Primitive& primitive,
                                                      std::size_t vertices) const {
    std::vector<std::uint32_t> order;
    if (primitive.indices >= 0) {
      count(file_.count(primitive.indices));
      order = file_.indices(primitive.indices);
    } else {
      for (std::size_t i = 0; i < vertices; ++i) order.push_back(static_cast<std::uint32_t>(i));
    }
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == -1) return order;
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 2; i < order.size(); ++i) {
      const bool is_fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
      const std::size_t first = is_fan ? 0 : i - 2, second = i - 1;
      const bool is_turned = !is_fan && i % 2 == 1;
      corners.insert(corners.end(), {order[is_turned ? second : first],
                                     order[is_turned ? first : second], order[i]});
    }
    return corners;
  }

  /// Counts vertices and corners, so that what is written out does not fill the memory.
  void count(std::size_t more) const {
    vertices_ += more;
    if (more > kMostVertices + file_.bytes() || vertices_ > kMostVertices + file_.bytes()) {
      file_.fail("more than " + std::to_string(kMostVertices + file_.bytes()) +
                 " vertices and corners with all instances written out, expected fewer");
    }
  }

  void read_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& world,
                      std::uint32_t object, Geometry& to) {
    if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      return warn("points and lines are ignored: only polygons are rendered");
    }
    const auto attribute = [&](const std::string& name) {
      const auto found = primitive.attributes.find(name);
      return found == primitive.attributes.end() ? -1 : found->second;
    };
    const int position = attribute("POSITION"), normal = attribute("NORMAL");
    if (position < 0) return warn("a primitive without positions is left out");
    const std::size_t vertices = file_.count(position);
    count(vertices);
    const std::vector<double> positions = file_.vectors(position, 3, "POSITION");
    const int set = materials_.texcoord_set(primitive.material);
    const int texcoord = set < 0 ? -1 : attribute("TEXCOORD_" + std::to_string(set));
    const std::vector<std::uint32_t> corners = corners_of(primitive, vertices);
    count(corners.size());
    if (corners.size() % 3 != 0)
      file_.fail("triangles of " + std::to_string(corners.size()) + " corners");

    const std::int32_t first_position = to.positions, first_normal = to.normals,
                       first_texcoord = to.texcoords;
    const double sign = glm::determinant(glm::dmat3(world)) < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < vertices; ++i) {
      const glm::dvec3 at(
          world * glm::dvec4(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2], 1.0));
      if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <=
            std::numeric_limits<float>::max())) {
        file_.fail("a vertex is beyond the range of float");
      }
      to.builder.add_position(at);
    }
    to.positions += static_cast<std::int32_t>(vertices);
    if (normal >= 0) add_normals(normal, glm::dmat3(world), sign, vertices, to);
    if (texcoord >= 0) add_texcoords(texcoord, vertices, to);

    const std::size_t first_face = to.builder.face_count();
    for (std::size_t i = 0; i < corners.size(); i += 3) {
      std::array<FileCorner, 3> face;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = corners[i + (sign < 0.0 ? 2 - k : k)];
        if (vertex >= vertices) {
          file_.fail("index " + std::to_string(vertex) + " in a primitive of " +
                     std::to_string(vertices) + " vertices");
        }
        const auto number = static_cast<std::int32_t>(vertex) + 1;
        face[k] = {first_position + number, texcoord >= 0 ? first_texcoord + number : 0,
                   normal >= 0 ? first_normal + number : 0};
      }
      to.builder.add_face(face, 0);
    }
    to.builder.assign_faces(first_face, to.builder.face_count(),
                            materials_.number_of(primitive.material), object);
  }

  void add_normals(int accessor, const glm::dmat3& world, double sign, std::size_t vertices,
                   Geometry& to) {
    const std::vector<double> normals = file_.vectors(accessor, 3, "NORMAL");
    if (normals.size() != 3 * vertices) file_.fail("not as many normals as positions");
    // The inverse transpose but for a factor, which a flat matrix has, too.
    const glm::dmat3 cofactors(glm::cross(world[1], world[2]), glm::cross(world[2], world[0]),
                               glm::cross(world[0], world[1]));
    for (std::size_t i = 0; i < vertices; ++i) {
      const glm::dvec3 turned =
          cofactors * glm::dvec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
      const bool is_finite =
          std::isfinite(turned.x) && std::isfinite(turned.y) && std::isfinite(turned.z);
      to.builder.add_normal(is_finite ? sign * turned : glm::dvec3(0.0));
    }
    to.normals += static_cast<std::int32_t>(vertices);
  }

  void add_texcoords(int accessor, std::size_t vertices, Geometry& to) {
    const std::vector<double> texcoords = file_.vectors(accessor, 2, "TEXCOORD");
    if (texcoords.size() != 2 * vertices) {
      file_.fail("not as many texture coordinates as positions");
    }
    for (std::size_t i = 0; i < vertices; ++i) {
      to.builder.add_texcoord({texcoords[2 * i], 1.0 - texcoords[2 * i + 1]});
    }
    to.texcoords += static_cast<std::int32_t>(vertices);
  }

  void read_camera(const tinygltf::Camera& camera, const glm::dmat4& world) {
    if (camera.type != "perspective") return warn("orthographic cameras are not read");
    const double fov = camera.perspective.yfov * 180.0 / std::numbers::pi;
    if (!(fov > 0.0 && fov < 180.0)) {
      file_.fail("a camera's yfov: expected more than 0 and less than pi");
    }
    if (scene_.camera) return warn("of several cameras the first one is taken");
    const glm::dvec3 eye(world[3]), back(world[2]), up(world[1]);
    if (glm::length(back) == 0.0 || glm::length(glm::cross(back, up)) == 0.0) {
      return warn("a camera without a direction is left out");
    }
    scene_.camera = {eye, eye - glm::normalize(back), up, fov};
  }

  void read_light(const tinygltf::Light& light, const glm::dmat4& world) {
    glm::dvec3 intensity(light.intensity / kLumensPerWatt);
    for (int k = 0; k < 3 && light.color.size() == 3; ++k) {
      intensity[k] *= light.color[static_cast<std::size_t>(k)];
    }
    for (int k = 0; k < 3; ++k) {
      if (!(intensity[k] >= 0.0 && intensity[k] <= std::numeric_limits<float>::max())) {
        file_.fail("a light's intensity: expected no negative number within the range of float");
      }
    }
    const double length = glm::length(glm::dvec3(world[2]));
    const bool is_directional = light.type == "directional", is_spot = light.type == "spot";
    if ((is_directional || is_spot) && !(length > 0.0 && std::isfinite(length))) {
      return warn("a light without a direction is left out");
    }
    const glm::dvec3 direction = -glm::dvec3(world[2]) / length;
    if (is_directional) {
      scene_.directional_lights.push_back({direction, glm::vec3(intensity)});
      return;
    }
    PlacedLight& placed = lights_.emplace_back(PlacedLight{glm::dvec3(world[3]), intensity, {}});
    if (!is_spot) return;
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    const double inner = light.spot.innerConeAngle * kDegrees,
                 outer = light.spot.outerConeAngle * kDegrees;
    // 90 degrees are pi / 2 but for rounding.
    if (!(inner >= 0.0 && inner < outer && outer <= 90.0 + 1e-9)) {
      file_.fail("a spot light's angles: expected 0 <= inner < outer <= pi / 2");
    }
    placed.spot = SpotCone{direction, inner, std::min(outer, 90.0)};
  }

  /// In the scene's coordinates, now that these are known; and the camera's target among the scene.
  void place_lights() {
    const auto [low, high] = position_box(scene_);
    const glm::dvec3 middle = 0.5 * (low + high);
    for (const PlacedLight& light : lights_) {
      const glm::vec3 rounded(light.position - scene_.origin);
      if (!std::isfinite(rounded.x + rounded.y + rounded.z)) {
        file_.fail("a light is beyond the range of float");
      }
      scene_.lights.push_back({rounded, light.intensity, light.spot});
    }
    if (!scene_.camera) return;
    CameraSetting& camera = *scene_.camera;
    const glm::dvec3 forward = camera.target - camera.eye;
    const double depth = glm::dot(middle + scene_.origin - camera.eye, forward);
    if (depth > 0.0) camera.target = camera.eye + depth * forward;
  }

  const GltfFile file_;
  const LoadOptions& options_;
  Scene scene_;
  Geometry own_;  // of meshes that stand in one place
  GltfMaterials materials_;
  std::vector<std::pair<const tinygltf::Node*, glm::dmat4>> nodes_;  // in their order
  std::map<int, int> uses_;                                          // of meshes, by number
  std::map<int, SharedMesh> shared_;
  std::vector<Place> places_;
  std::vector<PlacedLight> lights_;
  mutable std::size_t vertices_ = 0;
};

}  // namespace

Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options) {
  return GltfReader(file, options).read();
}

}  // namespace raygate
