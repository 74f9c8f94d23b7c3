#include "host/scene/io/gltf_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <string_view>
#include <utility>

#include "host/exact/exact.h"
#include "host/scene/io/text.h"

namespace raygate {
namespace {

constexpr int kTriangles = 4, kTriangleFan = 6;    // modes of primitives
constexpr std::size_t kMostVertices = 12'000'000;  // plus the number of bytes of the file

/// Returns whether an attribute may be missed. Texture coordinates that no texture uses, and joints
/// without a skin, change no picture.
bool is_unread(std::string_view name) {
  return name != "POSITION" && name != "NORMAL" && name != "TANGENT" && name != "COLOR_0" &&
         !name.starts_with("TEXCOORD_") && !name.starts_with("JOINTS_") &&
         !name.starts_with("WEIGHTS_");
}

}  // namespace

void GltfMeshes::read(const Json& mesh, const GltfPlacement& placement, std::uint32_t object,
                      MeshBuilder& to) {
  for (const Json& primitive : member(mesh, "primitives")) {
    read_primitive(primitive, placement, object, to);
  }
}

void GltfMeshes::count(std::size_t more) {
  vertices_ += more;
  if (more > kMostVertices + file_.bytes() || vertices_ > kMostVertices + file_.bytes()) {
    file_.fail("more than " + std::to_string(kMostVertices + file_.bytes()) +
               " vertices and corners with all instances written out, expected fewer");
  }
}

std::vector<std::uint32_t> GltfMeshes::corners_of(const Json& primitive, std::size_t vertices) {
  std::vector<std::uint32_t> order;
  if (const int indices = index_in(primitive, "indices"); indices >= 0) {
    count(file_.count(indices));
    order = file_.indices(indices);
  } else {
    for (std::size_t i = 0; i < vertices; ++i) order.push_back(static_cast<std::uint32_t>(i));
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

std::vector<double> GltfMeshes::attribute(const Json& primitive, const std::string& name, int width,
                                          std::size_t vertices,
                                          const std::vector<double>& weights) {
  const int accessor = index_in(member(primitive, "attributes"), name.c_str());
  const auto optional = [&](int number, int components) {
    return file_.optional_numbers(number, components, name.c_str(), vertices);
  };
  std::vector<double> all =
      name == "POSITION" ? file_.numbers(accessor, width, "POSITION") : optional(accessor, width);
  const int moved = std::min(width, 3);  // targets move a tangent's direction, not its sign
  std::size_t target = 0;
  for (const Json& targets : member(primitive, "targets")) {
    const double weight = target < weights.size() ? weights[target++] : 0.0;
    if (weight == 0.0 || all.empty()) continue;
    const std::vector<double> by = optional(index_in(targets, name.c_str()), moved);
    for (std::size_t i = 0; i < by.size(); ++i) {
      const std::size_t vertex = i / static_cast<std::size_t>(moved),
                        k = i % static_cast<std::size_t>(moved);
      all[vertex * static_cast<std::size_t>(width) + k] += weight * by[i];
    }
  }
  return all;
}

std::vector<glm::dmat4> GltfMeshes::skinned(const Json& primitive, const GltfPlacement& placement,
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

void GltfMeshes::read_primitive(const Json& primitive, const GltfPlacement& placement,
                                std::uint32_t object, MeshBuilder& to) {
  const int mode = index_in(primitive, "mode"), number = index_in(primitive, "material");
  if (mode >= 0 && mode < kTriangles) {
    return file_.warn_once("points and lines are ignored: only polygons are rendered");
  }
  const Json& attributes = member(primitive, "attributes");
  if (!attributes.contains("POSITION")) {
    return file_.warn_once("a primitive without positions is left out");
  }
  for (const auto& [name, accessor] : attributes.items()) {
    if (is_unread(name)) file_.warn_once("the attribute " + in_quotes(name) + " is not read");
  }
  const std::size_t vertices = file_.count(index_in(attributes, "POSITION"));
  count(vertices);
  const auto read = [&](const std::string& name, int width) {
    return attribute(primitive, name, width, vertices, *placement.weights);
  };
  const std::vector<double> positions = read("POSITION", 3), normals = read("NORMAL", 3);
  std::vector<double> tangents;
  if (!normals.empty()) tangents = read("TANGENT", 4);
  const int color = index_in(attributes, "COLOR_0");
  const bool has_alpha = color >= 0 && text_in(file_.accessor(color), "type") == "VEC4";
  const int channels = has_alpha ? 4 : 3;
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
  const bool is_clear = has_alpha && !colors.empty() && materials_.has_opacity(number);
  if (is_clear && sets[0] < 0) texcoords.resize(2 * vertices);  // opacities need them
  if (is_clear) materials_.use_vertex_opacity(number);
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
    if (!(is_finite(at) && largest(at) <= std::numeric_limits<float>::max())) {
      file_.fail("a vertex is beyond the range of float");
    }
    to.add_position(at);
    const std::size_t own_color = static_cast<std::size_t>(channels) * i;
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
      to.add_opacity(std::isfinite(alpha) ? static_cast<float>(std::clamp(alpha, 0.0, 1.0)) : 1.0f);
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

}  // namespace raygate
