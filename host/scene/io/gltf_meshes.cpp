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
  const int position = attribute("POSITION"), normal = attribute("NORMAL");
  const int color = attribute("COLOR_0");
  if (position < 0)
    return file_.warn_once("a primitive without positions is left out", scene_.warnings);
  const std::size_t vertices = file_.count(position);
  count(vertices);
  const std::vector<double> positions = file_.vectors(position, 3, "POSITION");
  std::vector<double> colors;
  if (color >= 0) {
    colors = file_.vectors(color, 3, "COLOR_0");
    if (colors.size() != positions.size()) file_.fail("not as many colours as positions");
    to.colors_are_linear();
  }
  const int set = materials_.texcoord_set(primitive.material);
  const int texcoord = set < 0 ? -1 : attribute("TEXCOORD_" + std::to_string(set));
  const std::vector<std::uint32_t> corners = corners_of(primitive, vertices);
  count(corners.size());
  if (corners.size() % 3 != 0)
    file_.fail("triangles of " + std::to_string(corners.size()) + " corners");

  const MeshBuilder::Counts before = to.counts();
  const double sign = glm::determinant(glm::dmat3(world)) < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < vertices; ++i) {
    const glm::dvec3 at(
        world * glm::dvec4(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2], 1.0));
    if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <=
          std::numeric_limits<float>::max())) {
      file_.fail("a vertex is beyond the range of float");
    }
    to.add_position(at);
    if (color >= 0) to.add_color({colors[3 * i], colors[3 * i + 1], colors[3 * i + 2]});
  }
  if (normal >= 0) add_normals(normal, glm::dmat3(world), sign, vertices, to);
  if (texcoord >= 0) add_texcoords(texcoord, vertices, to);

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
      face[k] = {number(before.positions), texcoord >= 0 ? number(before.texcoords) : 0,
                 normal >= 0 ? number(before.normals) : 0};
    }
    to.add_face(face, 0);
  }
  const std::uint32_t material = materials_.number_of(primitive.material);
  if (primitive.material < 0 && color >= 0) scene_.materials[material].diffuse = glm::vec3(1.0f);
  to.assign_faces(first_face, to.face_count(), material, object);
}

void GltfMeshes::add_normals(int accessor, const glm::dmat3& world, double sign,
                             std::size_t vertices, MeshBuilder& to) const {
  const std::vector<double> normals = file_.vectors(accessor, 3, "NORMAL");
  if (normals.size() != 3 * vertices) file_.fail("not as many normals as positions");
  // The inverse transpose but for a factor, which a flat matrix has, too.
  const glm::dmat3 cofactors(glm::cross(world[1], world[2]), glm::cross(world[2], world[0]),
                             glm::cross(world[0], world[1]));
  for (std::size_t i = 0; i < vertices; ++i) {
    const glm::dvec3 turned =
        cofactors * glm::dvec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
    to.add_normal(is_finite(turned) ? sign * turned : glm::dvec3(0.0));
  }
}

void GltfMeshes::add_texcoords(int accessor, std::size_t vertices, MeshBuilder& to) const {
  const std::vector<double> texcoords = file_.vectors(accessor, 2, "TEXCOORD");
  if (texcoords.size() != 2 * vertices) {
    file_.fail("not as many texture coordinates as positions");
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    to.add_texcoord({texcoords[2 * i], 1.0 - texcoords[2 * i + 1]});
  }
}

}  // namespace raygate
