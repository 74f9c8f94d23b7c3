#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/scene/bounds.h"
#include "host/scene/instances.h"
#include "host/scene/io/gltf_file.h"
#include "host/scene/io/gltf_materials.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kLumensPerWatt = 683.0;
constexpr double kMostFloat = std::numeric_limits<float>::max();
constexpr int kTriangles = 4, kTriangleFan = 6;    // modes of primitives
constexpr std::size_t kMostVertices = 12'000'000;  // limit, to which the file's bytes are added

/// The index of a mesh, and the weights of its morph targets.
using Shape = std::pair<int, std::vector<double>>;

/// A mesh with several instances.
struct SharedMesh {
  Scene part;   ///< moved to `instancer` at the first instance
  Bounds3 box;  ///< bounds of the part's positions
  std::optional<MeshInstancer> instancer;
};

/// An instance of a mesh.
struct MeshInstance {
  Shape shape;
  glm::dmat4 world;
  std::uint32_t object;
};

/// Transform, morph weights and skin that a node gives its mesh.
struct Placement {
  glm::dmat4 world;                    ///< from the mesh's coordinates to the world's
  const std::vector<double>* weights;  ///< of the mesh's morph targets
  std::vector<glm::dmat4> joints;      ///< transforms of a skin, which replace `world`; or empty
};

/// A node, and its transform to the world.
using PlacedNode = std::pair<const Json*, glm::dmat4>;

class GltfReader {
 public:
  GltfReader(const std::filesystem::path& path, const LoadOptions& options)
      : file_(path, scene_.warnings),
        options_(options),
        builder_(file_.name),
        materials_(file_, scene_, options.textures) {
    // Coordinates of the file are in binary32, and their transforms are rounded in any case.
    options_.vertices = std::max(options.vertices, Vertices::kAsPictures);
  }

  Scene read() {
    walk(roots());
    for (const auto& [node, world] : nodes_) {
      if (index_in(*node, "mesh") >= 0 && index_in(*node, "skin") < 0) ++uses_[shape_of(*node)];
    }
    for (const auto& [node, world] : nodes_) read_node(*node, world);
    for (const MeshInstance& instance : instances_) expand_extent(instance);
    if (!instances_.empty()) builder_.allow_empty();
    builder_.build(options_, scene_);
    for (const MeshInstance& instance : instances_) add_instance(instance);
    if (is_empty(scene_)) throw InputError(file_.name + ": no face has an area");
    for (const WorldPointLight& light : lights_) add_light(scene_, light, file_.name);
    aim_camera();
    scene_.files = file_.files;
    if (!file_.list("animations").empty()) file_.warn_once("animations are not read");
    return std::move(scene_);
  }

 private:
  [[nodiscard]] const Json& node(int index) const {
    return file_.at(file_.list("nodes"), index, "node");
  }

  [[nodiscard]] std::vector<int> roots() const {
    if (!file_.list("scenes").empty()) {
      const int scene = std::max(index_in(file_.json, "scene"), 0);
      return indices_in(file_.at(file_.list("scenes"), scene, "scene"), "nodes");
    }
    const Json& nodes = file_.list("nodes");
    std::set<int> children;
    for (const Json& parent : nodes) {
      for (const int child : indices_in(parent, "children")) children.insert(child);
    }
    std::vector<int> found;
    for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
      if (!children.contains(i)) found.push_back(i);
    }
    return found;
  }

  /// Collects the nodes from `roots` down, depth first, with their transforms to the world.
  void walk(const std::vector<int>& roots) {
    std::vector<std::pair<int, glm::dmat4>> steps;  // nodes, and the transforms of their parents
    const auto add = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
      for (std::size_t i = nodes.size(); i-- > 0;) steps.emplace_back(nodes[i], parent);
    };
    std::set<int> seen;
    add(roots, glm::dmat4(1.0));
    while (!steps.empty()) {
      const auto [number, parent] = steps.back();
      steps.pop_back();
      const Json& node = this->node(number);
      if (!seen.insert(number).second) {
        file_.fail("node " + std::to_string(number) + " has two parents, expected one");
      }
      const glm::dmat4 world = parent * local_matrix(node);
      const std::span elements(glm::value_ptr(world), 16);
      if (!std::ranges::all_of(elements, [](double x) { return std::isfinite(x); })) {
        file_.fail("node " + std::to_string(number) + ": its place is not finite");
      }
      nodes_.emplace_back(&node, world);
      add(indices_in(node, "children"), world);
    }
  }

  [[nodiscard]] const Json& mesh(int index) const {
    return file_.at(file_.list("meshes"), index, "mesh");
  }

  [[nodiscard]] Shape shape_of(const Json& node) const {
    const int number = index_in(node, "mesh");
    const std::vector<double> weights = numbers_in(node, "weights");
    return {number, weights.empty() ? numbers_in(mesh(number), "weights") : weights};
  }

  /// Returns the transforms of a skin's joints, from the mesh's coordinates to the world's.
  [[nodiscard]] std::vector<glm::dmat4> joints_of(int number) {
    const Json& skin = file_.at(file_.list("skins"), number, "skin");
    std::vector<glm::dmat4> joints;
    for (const int joint : indices_in(skin, "joints")) {
      const auto placed = std::ranges::find(nodes_, &node(joint), &PlacedNode::first);
      joints.push_back(placed == nodes_.end() ? glm::dmat4(1.0) : placed->second);
    }
    if (joints.empty()) file_.warn_once("a skin without joints is left out");
    const std::vector<double> inverse = file_.optional_numbers(
        index_in(skin, "inverseBindMatrices"), 16, "inverseBindMatrices", joints.size());
    for (std::size_t i = 0; i < inverse.size() / 16; ++i) {
      joints[i] *= glm::make_mat4(&inverse[16 * i]);
    }
    return joints;
  }

  void read_node(const Json& node, const glm::dmat4& world) {
    if (const int number = index_in(node, "mesh"); number >= 0) {
      const auto object = static_cast<std::uint32_t>(scene_.objects.size());
      const std::string name = text_in(node, "name"), other = text_in(mesh(number), "name");
      scene_.objects.push_back(!name.empty()    ? name
                               : !other.empty() ? other
                                                : "object " + std::to_string(object));
      const Shape shape = shape_of(node);
      const int skin = index_in(node, "skin");
      if (skin < 0 && uses_[shape] > 1) {
        instances_.push_back({shape, world * glm::dmat4(1.0), object});  // removes negative zeros
      } else {
        Placement placement{world, &shape.second, {}};
        if (skin >= 0) file_.optionally("left out", [&] { placement.joints = joints_of(skin); });
        read_mesh(mesh(number), placement, object, builder_);
      }
    }
    if (const int camera = index_in(node, "camera"); camera >= 0) {
      file_.optionally("left out", [&] {
        read_camera(file_.at(file_.list("cameras"), camera, "camera"), world);
      });
    }
    constexpr const char* kLights = "KHR_lights_punctual";
    if (const int light = index_in(extension(node, kLights), "light"); light >= 0) {
      file_.optionally("left out", [&] {
        const Json& lights = member(extension(file_.json, kLights), "lights");
        read_light(file_.at(lights, light, "light"), world);
      });
    }
  }

  /// Returns the mesh of an instance, in the mesh's own coordinates. Reads it at the first call.
  SharedMesh& shared(const Shape& shape) {
    const auto [at, is_new] = shared_.try_emplace(shape);
    if (!is_new) return at->second;
    MeshBuilder builder(file_.name);
    builder.allow_empty();
    read_mesh(mesh(shape.first), {glm::dmat4(1.0), &shape.second, {}}, 0, builder);
    Scene& part = at->second.part;
    LoadOptions options = options_;
    options.vertices = Vertices::kBinary32;
    builder.build(options, part);
    at->second.box = bounds_of(part.positions);
    return at->second;
  }

  /// Includes an instance in the bounds by which the scene is recentred.
  void expand_extent(const MeshInstance& instance) {
    const auto& [part, own_box, ignored] = shared(instance.shape);
    if (is_empty(part)) return;
    Instance placed;
    set_rows(instance.world, part.origin, glm::dvec3(0.0), placed);
    const Bounds3 box = transform_bounds(placed.rows, own_box);
    if (!(largest(box.low) <= kMostFloat && largest(box.high) <= kMostFloat)) {
      file_.fail("a vertex is beyond the range of float");
    }
    builder_.expand_extent(box);
  }

  void add_instance(const MeshInstance& instance) {
    SharedMesh& mesh = shared(instance.shape);
    if (!mesh.instancer) {
      if (is_empty(mesh.part)) {
        std::ranges::move(std::exchange(mesh.part.warnings, {}),
                          std::back_inserter(scene_.warnings));
        return;
      }
      mesh.instancer.emplace(scene_, std::move(mesh.part));
    }
    if (!mesh.instancer->add(instance.world, instance.object)) {
      file_.fail("an instance is beyond the range of float");
    }
  }

  /// Sets the scene's camera, with a target ahead of it, unless the scene already has a camera.
  void read_camera(const Json& camera, const glm::dmat4& world) {
    const bool is_orthographic = text_in(camera, "type") == "orthographic";
    // With 90 degrees and a target at distance ymag, half the image's height is ymag.
    const double fov =
        is_orthographic ? 90.0 : number_in(member(camera, "perspective"), "yfov", 0.0) * kDegrees;
    const double distance =
        is_orthographic ? number_in(member(camera, "orthographic"), "ymag", 0.0) : 1.0;
    if (!(fov > 0.0 && fov < 180.0)) {
      file_.fail("a camera's yfov: expected more than 0 and less than pi");
    }
    if (!(distance > 0.0 && distance <= kMostFloat)) {
      file_.fail("a camera's ymag: expected a positive number within the range of float");
    }
    if (scene_.camera) return file_.warn_once("of several cameras the first one is taken");
    const glm::dvec3 eye(world[3]), back(world[2]), up(world[1]);
    if (glm::length(back) == 0.0 || glm::length(glm::cross(back, up)) == 0.0) {
      return file_.warn_once("a camera without a direction is left out");
    }
    scene_.camera = {eye, eye - distance * glm::normalize(back), up, fov};
    if (is_orthographic) scene_.camera->lens.projection = Projection::kOrthographic;
  }

  /// Moves the camera's target along the view to the depth of the scene's centre, without changing
  /// the size of the picture. The scene must be complete.
  void aim_camera() {
    if (!scene_.camera) return;
    CameraSetting& camera = *scene_.camera;
    glm::dvec3 forward = camera.target - camera.eye;
    double fov = *camera.fov;
    const bool is_orthographic = camera.lens.projection == Projection::kOrthographic;
    const double size = glm::length(forward);
    if (is_orthographic) forward /= size;
    const glm::dvec3 middle = position_bounds(scene_).middle();
    const double depth = glm::dot(middle + scene_.origin - camera.eye, forward);
    if (is_orthographic) fov = 2.0 * std::atan(size / depth) * kDegrees;
    if (!(depth > 0.0 && fov > 0.0 && fov < 180.0)) return;
    camera.target = camera.eye + depth * forward;
    camera.fov = fov;
  }

  void read_light(const Json& light, const glm::dmat4& world) {
    glm::dvec3 intensity(number_in(light, "intensity", 1.0) / kLumensPerWatt);
    const std::vector<double> color = numbers_in(light, "color");
    const std::string type = text_in(light, "type");
    for (int k = 0; k < 3; ++k) {
      if (color.size() == 3) intensity[k] *= color[static_cast<std::size_t>(k)];
      if (!(intensity[k] >= 0.0 && intensity[k] <= kMostFloat)) {
        file_.fail("a light's intensity: expected no negative number within the range of float");
      }
    }
    if (number_in(light, "range", 0.0) > 0.0) {
      file_.warn_once("a light's range is not read: light goes on by the square of the distance");
    }
    const double length = glm::length(glm::dvec3(world[2]));
    const bool is_directional = type == "directional", is_spot = type == "spot";
    if (!is_directional && !is_spot && type != "point") {
      file_.fail("found a light of the type " + in_quotes(type) +
                 ", expected directional, point or spot");
    }
    if ((is_directional || is_spot) && !(length > 0.0 && std::isfinite(length))) {
      return file_.warn_once("a light without a direction is left out");
    }
    const glm::dvec3 direction = -glm::dvec3(world[2]) / length;
    if (is_directional) {
      scene_.directional_lights.push_back({direction, glm::vec3(intensity)});
      return;
    }
    WorldPointLight& placed = lights_.emplace_back();
    placed.position = glm::dvec3(world[3]);
    placed.intensity = intensity;
    if (!is_spot) return;
    const Json& spot = member(light, "spot");
    if (!spot.is_object()) file_.warn_once("a spot light without 'spot' has the usual cone");
    const double inner = number_in(spot, "innerConeAngle", 0.0) * kDegrees,
                 outer = number_in(spot, "outerConeAngle", std::numbers::pi / 4.0) * kDegrees;
    // pi / 2 may be rounded to more than 90 degrees.
    if (!(inner >= 0.0 && inner <= outer && outer <= 90.0 + 1e-9)) {
      file_.warn_once("a spot light's angles are limited to 0 <= inner <= outer <= pi / 2");
    }
    SpotCone& cone = placed.spot.emplace(SpotCone{direction});
    cone.outer = outer >= 0.0 ? std::min(outer, 90.0) : 0.0;
    cone.inner = inner >= 0.0 ? std::min(inner, cone.outer) : 0.0;
  }

  /// Appends the faces of a mesh, which belong to object number `object`. Leaves out points, lines
  /// and primitives without positions, with a warning.
  void read_mesh(const Json& mesh, const Placement& placement, std::uint32_t object,
                 MeshBuilder& to) {
    for (const Json& primitive : member(mesh, "primitives")) {
      read_primitive(primitive, placement, object, to);
    }
  }

  /// Adds `more` to the number of vertices and corners. Throws InputError if that is too large for
  /// the file's size: nodes with skins repeat their mesh, so a small file could fill the memory.
  void count(std::size_t more) {
    vertices_ += more;
    if (more > kMostVertices + file_.bytes || vertices_ > kMostVertices + file_.bytes) {
      file_.fail("more than " + std::to_string(kMostVertices + file_.bytes) +
                 " vertices and corners, expected fewer");
    }
  }

  /// Returns the corners of the triangles as indices into the primitive's vertices.
  std::vector<std::uint32_t> corners_of(const Json& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> order;
    if (const int indices = index_in(primitive, "indices"); indices >= 0) {
      count(file_.count(indices));
      const std::vector<double> numbers = file_.numbers(indices, 1, "indices", true);
      order.assign(numbers.begin(), numbers.end());
    } else {
      order.resize(vertices);
      std::iota(order.begin(), order.end(), 0u);
    }
    const int mode = index_in(primitive, "mode");
    if (mode == kTriangles || mode == -1) return order;
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 2; i < order.size(); ++i) {
      std::uint32_t first = order[mode == kTriangleFan ? 0 : i - 2], second = order[i - 1];
      if (mode != kTriangleFan && i % 2 == 1) std::swap(first, second);
      corners.insert(corners.end(), {first, second, order[i]});
    }
    return corners;
  }

  /// Returns an attribute's numbers plus the weighted sum of its morph targets; empty if missing.
  std::vector<double> attribute(const Json& primitive, const std::string& name, std::size_t width,
                                std::size_t vertices, const std::vector<double>& weights = {}) {
    const int accessor = index_in(member(primitive, "attributes"), name.c_str());
    const auto optional = [&](int number, std::size_t components) {
      return file_.optional_numbers(number, components, name.c_str(), vertices);
    };
    std::vector<double> all =
        name == "POSITION" ? file_.numbers(accessor, width, "POSITION") : optional(accessor, width);
    const auto moved = std::min<std::size_t>(width, 3);  // not the sign of a tangent
    std::size_t target = 0;
    for (const Json& targets : member(primitive, "targets")) {
      const double weight = target < weights.size() ? weights[target++] : 0.0;
      if (weight == 0.0 || all.empty()) continue;
      const std::vector<double> by = optional(index_in(targets, name.c_str()), moved);
      for (std::size_t i = 0; i < by.size(); ++i) {
        all[i / moved * width + i % moved] += weight * by[i];
      }
    }
    return all;
  }

  /// Returns each vertex's transform to the world: the weighted mean of its joints' transforms.
  std::vector<glm::dmat4> skinned(const Json& primitive, const Placement& placement,
                                  std::size_t vertices) {
    std::vector<glm::dmat4> all(vertices, glm::dmat4(0.0));
    std::vector<double> sums(vertices);
    for (int set = 0;; ++set) {
      const std::string number = std::to_string(set);
      if (!member(primitive, "attributes").contains("JOINTS_" + number)) break;
      const std::vector<double> joints = attribute(primitive, "JOINTS_" + number, 4, vertices),
                                weights = attribute(primitive, "WEIGHTS_" + number, 4, vertices);
      for (std::size_t i = 0; i < std::min(joints.size(), weights.size()); ++i) {
        const bool is_joint =
            joints[i] >= 0.0 && joints[i] < static_cast<double>(placement.joints.size());
        if (!(weights[i] > 0.0) || !is_joint) continue;
        all[i / 4] += weights[i] * placement.joints[static_cast<std::size_t>(joints[i])];
        sums[i / 4] += weights[i];
      }
    }
    for (std::size_t i = 0; i < vertices; ++i) {
      all[i] = sums[i] > 0.0 ? all[i] / sums[i] : placement.world;
    }
    return all;
  }

  void read_primitive(const Json& primitive, const Placement& placement, std::uint32_t object,
                      MeshBuilder& to) {
    const int mode = index_in(primitive, "mode"), number = index_in(primitive, "material");
    if (mode >= 0 && mode < kTriangles) {
      return file_.warn_once("points and lines are ignored: only polygons are rendered");
    }
    const Json& attributes = member(primitive, "attributes");
    if (!attributes.contains("POSITION")) {
      return file_.warn_once("a primitive without positions is left out");
    }
    // No warning for unused texture coordinates and joints without a skin: they change no picture.
    static const std::regex kRead(
        "^(POSITION$|NORMAL$|TANGENT$|COLOR_0$|(TEXCOORD|JOINTS|WEIGHTS)_)");
    for (const auto& [name, accessor] : attributes.items()) {
      if (!std::regex_search(name, kRead)) {
        file_.warn_once("the attribute " + in_quotes(name) + " is not read");
      }
    }
    const std::size_t vertices = file_.count(index_in(attributes, "POSITION"));
    count(vertices);
    const auto read = [&](const std::string& name, std::size_t width) {
      return attribute(primitive, name, width, vertices, *placement.weights);
    };
    const std::vector<double> positions = read("POSITION", 3), normals = read("NORMAL", 3);
    std::vector<double> tangents;
    if (!normals.empty()) tangents = read("TANGENT", 4);
    const int color = index_in(attributes, "COLOR_0");
    const bool has_alpha = color >= 0 && text_in(file_.accessor(color), "type") == "VEC4";
    const std::size_t channels = has_alpha ? 4 : 3;
    const std::vector<double> colors = read("COLOR_0", channels);
    const std::vector<std::uint32_t> corners = corners_of(primitive, vertices);
    count(corners.size());
    if (corners.size() % 3 != 0) {
      file_.fail("triangles of " + std::to_string(corners.size()) + " corners");
    }
    const auto [material, sets] = materials_.convert(number);
    const auto read_set = [&](int set) {
      return set < 0 ? std::vector<double>() : read("TEXCOORD_" + std::to_string(set), 2);
    };
    std::vector<double> texcoords = read_set(sets[0]);
    const std::vector<double> seconds = read_set(sets[1]);
    const bool is_clear = has_alpha && !colors.empty() && materials_.use_vertex_opacity(number);
    if (is_clear && sets[0] < 0) texcoords.resize(2 * vertices);  // opacities need them
    if (!colors.empty()) to.colors_are_linear();
    if (number < 0 && !colors.empty()) scene_.materials[material].diffuse = glm::vec3(1.0f);

    std::vector<glm::dmat4> places;
    if (!placement.joints.empty()) places = skinned(primitive, placement, vertices);
    const auto place_of = [&](std::size_t vertex) -> const glm::dmat4& {
      return places.empty() ? placement.world : places[vertex];
    };
    const MeshBuilder::Counts before = to.counts();
    const double sign = glm::determinant(glm::dmat3(place_of(0))) < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < vertices; ++i) {
      const glm::dmat4& place = place_of(i);
      const glm::dmat3 turn(place);
      const glm::dvec3 at(place * glm::dvec4(glm::make_vec3(&positions[3 * i]), 1.0));
      if (!(is_finite(at) && largest(at) <= kMostFloat)) {
        file_.fail("a vertex is beyond the range of float");
      }
      to.add_position(at);
      const std::size_t own_color = channels * i;
      if (!colors.empty()) to.add_color(glm::vec3(glm::make_vec3(&colors[own_color])));
      if (!normals.empty()) {
        // The inverse transpose up to a factor; cofactors also exist for a singular matrix.
        const glm::dmat3 cofactors(glm::cross(turn[1], turn[2]), glm::cross(turn[2], turn[0]),
                                   glm::cross(turn[0], turn[1]));
        to.add_normal(sign * (cofactors * glm::make_vec3(&normals[3 * i])));
      }
      if (!tangents.empty()) {
        const glm::dvec3 along = turn * glm::make_vec3(&tangents[4 * i]);
        const double side = tangents[4 * i + 3] < 0.0 ? -sign : sign, size = glm::length(along);
        const bool is_direction = size > 0.0 && std::isfinite(size);
        to.add_tangent(is_direction ? glm::vec4(along / size, side) : glm::vec4(0.0f));
      }
      if (texcoords.empty()) continue;
      to.add_texcoord({texcoords[2 * i], 1.0 - texcoords[2 * i + 1]});
      if (!seconds.empty()) to.add_second_texcoord({seconds[2 * i], 1.0 - seconds[2 * i + 1]});
      if (is_clear) {
        const double alpha = colors[own_color + 3];
        to.add_opacity(std::isfinite(alpha) ? static_cast<float>(std::clamp(alpha, 0.0, 1.0))
                                            : 1.0f);
      }
    }

    for (std::size_t i = 0; i < corners.size(); i += 3) {
      std::array<FaceCorner, 3> face;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = corners[i + (sign < 0.0 ? 2 - k : k)];
        if (vertex >= vertices) {
          file_.fail("index " + std::to_string(vertex) + " in a primitive of " +
                     std::to_string(vertices) + " vertices");
        }
        const auto index = [&](std::size_t earlier) {
          return static_cast<std::uint32_t>(earlier + vertex);
        };
        face[k] = {index(before.positions), texcoords.empty() ? kNoIndex : index(before.texcoords),
                   normals.empty() ? kNoIndex : index(before.normals)};
      }
      to.add_face(face, 0, {material, object});
    }
  }

  Scene scene_;
  GltfFile file_;
  LoadOptions options_;
  MeshBuilder builder_;  // of meshes with one instance
  GltfMaterials materials_;
  std::size_t vertices_ = 0;       // vertices and corners counted so far
  std::vector<PlacedNode> nodes_;  // depth first
  std::map<Shape, int> uses_;
  std::map<Shape, SharedMesh> shared_;
  std::vector<MeshInstance> instances_;
  std::vector<WorldPointLight> lights_;
};

}  // namespace

Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options) {
  return GltfReader(file, options).read();
}

}  // namespace raygate
