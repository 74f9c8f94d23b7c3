#include "host/scene/io/gltf_places.h"

#include <cstddef>
#include <glm/gtc/quaternion.hpp>

namespace raygate {

glm::dmat4 local_matrix(const tinygltf::Node& node) {
  glm::dmat4 matrix(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  if (const auto& t = node.translation; t.size() == 3) {
    matrix[3] = glm::dvec4(t[0], t[1], t[2], 1.0);
  }
  if (const auto& r = node.rotation; r.size() == 4) {
    const glm::dquat turn(r[3], r[0], r[1], r[2]);
    const double length = glm::length(turn);
    if (length > 0.0) matrix = matrix * glm::mat4_cast(turn / length);
  }
  if (const auto& s = node.scale; s.size() == 3) {
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= s[static_cast<std::size_t>(axis)];
  }
  return matrix;
}

std::vector<glm::dmat4> places_in(const GltfFile& file, const tinygltf::Node& node) {
  const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == node.extensions.end() || !extension->second.Has("attributes")) {
    return {glm::dmat4(1.0)};
  }
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  std::size_t places = 0;
  const auto numbers = [&](const char* name, int width) {
    if (!attributes.Has(name) || !attributes.Get(name).IsInt()) return std::vector<double>();
    std::vector<double> all = file.vectors(attributes.Get(name).GetNumberAsInt(), width, name);
    const std::size_t given = all.size() / static_cast<std::size_t>(width);
    if (places != 0 && given != places) file.fail("instances: not as many of each attribute");
    places = given;
    return all;
  };
  const std::vector<double> move = numbers("TRANSLATION", 3), turn = numbers("ROTATION", 4),
                            stretch = numbers("SCALE", 3);
  std::vector<glm::dmat4> all;
  all.reserve(places);
  for (std::size_t i = 0; i < places; ++i) {
    tinygltf::Node one;
    const auto part = [&](const std::vector<double>& from, std::size_t width) {
      if (from.empty()) return from;
      return std::vector<double>(from.begin() + static_cast<std::ptrdiff_t>(width * i),
                                 from.begin() + static_cast<std::ptrdiff_t>(width * (i + 1)));
    };
    one.translation = part(move, 3);
    one.rotation = part(turn, 4);
    one.scale = part(stretch, 3);
    all.push_back(local_matrix(one));
  }
  return all;
}

TransformRows rows_of(const glm::dmat4& matrix) {
  TransformRows rows;
  for (int k = 0; k < 3; ++k) {
    rows[static_cast<std::size_t>(k)] = {matrix[0][k], matrix[1][k], matrix[2][k], matrix[3][k]};
  }
  return rows;
}

}  // namespace raygate
