#include "host/scene/io/gltf_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raygate {
namespace {

constexpr std::size_t kMostVertices = 12'000'000;  // besides one for each byte

}  // namespace

void GltfMeshes::read(const tinygltf::Mesh& mesh, const glm::dmat4& world, std::uint32_t object,
                      MeshBuilder& to) {
  for (const tinygltf::Primitive& primitive : mesh.primitives) read(primitive, world, object, to);
}

void GltfMeshes::count(std::size_t more) {
  vertices_ += more;
  if (more > kMostVertices + file_.bytes() || vertices_ > kMostVertices + file_.bytes()) {
    file_.fail("more than " + std::to_string(kMostVertices + file_.bytes()) +
               " vertices and corners with all instances written out, expected fewer");
  }
}

std::vector<std::uint32_t> GltfMeshes::corners_of(const tinygltf::Primitive& primitive,
                                                  std::size_t vertices) {
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

void GltfMeshes::read(const tinygltf::Primitive& primitive, const glm::dmat4& world,
                      std::uint32_t object, MeshBuilder& to) {
  if (primitive.mode >= 0 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    return file_.warn_once("points and lines are ignored: only polygons are rendered",
                           scene_.warnings);
  }
  const auto attribute = [&](const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
  };
  const int position = attribute("POSITION");
  if (position < 0)
    return file_.warn_once("a primitive without positions is left out", scene_.warnings);
  const std::size_t vertices = file_.count(position);
  count(vertices);
  const std::vector<double> positions = file_.vectors(position, 3, "POSITION");
  const auto optional = [&](const std::string& name, int width) {
    return file_.optional_vectors(attribute(name), width, name.c_str(), vertices, scene_.warnings);
  };
  const std::vector<double> normals = optional("NORMAL", 3), colors = optional("COLOR_0", 3);
  if (!colors.empty()) to.colors_are_linear();
  const int set = materials_.texcoord_set(primitive.material);
  std::vector<double> texcoords;
  if (set >= 0) texcoords = optional("TEXCOORD_" + std::to_string(set), 2);
  const std::vector<std::uint32_t> corners = corners_of(primitive, vertices);
  count(corners.size());
  if (corners.size() % 3 != 0)
    file_.fail("triangles of " + std::to_string(corners.size()) + " corners");

  const MeshBuilder::Counts before = to.counts();
  const glm::dmat3 turn(world);
  const double sign = glm::determinant(turn) < 0.0 ? -1.0 : 1.0;
  // The inverse transpose but for a factor, which a flat matrix has, too.
  const glm::dmat3 cofactors(glm::cross(turn[1], turn[2]), glm::cross(turn[2], turn[0]),
                             glm::cross(turn[0], turn[1]));
  for (std::size_t i = 0; i < vertices; ++i) {
    const glm::dvec3 at(
        world * glm::dvec4(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2], 1.0));
    if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <=
          std::numeric_limits<float>::max())) {
      file_.fail("a vertex is beyond the range of float");
    }
    to.add_position(at);
    if (!colors.empty()) to.add_color({colors[3 * i], colors[3 * i + 1], colors[3 * i + 2]});
    if (!normals.empty()) {
      to.add_normal(
          sign * (cofactors * glm::dvec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2])));
    }
    if (!texcoords.empty()) to.add_texcoord({texcoords[2 * i], 1.0 - texcoords[2 * i + 1]});
  }

  const std::size_t first_face = to.face_count();
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    std::array<FileCorner, 3> face;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = corners[i + (sign < 0.0 ? 2 - k : k)];
      if (vertex >= vertices) {
        file_.fail("index " + std::to_string(vertex) + " in a primitive of " +
                   std::to_string(vertices) + " vertices");
      }
      const auto number = [&](std::size_t earlier) {
        return static_cast<std::int32_t>(earlier + vertex + 1);
      };
      face[k] = {number(before.positions), texcoords.empty() ? 0 : number(before.texcoords),
                 normals.empty() ? 0 : number(before.normals)};
    }
    to.add_face(face, 0);
  }
  const std::uint32_t material = materials_.number_of(primitive.material);
  if (primitive.material < 0 && !colors.empty())
    scene_.materials[material].diffuse = glm::vec3(1.0f);
  to.assign_faces(first_face, to.face_count(), material, object);
}

}  // namespace raygate
