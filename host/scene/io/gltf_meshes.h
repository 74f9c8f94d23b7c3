// The meshes of a glTF file as vertices and faces of a MeshBuilder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/io/gltf_file.h"
#include "host/scene/io/gltf_materials.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/scene.h"

namespace raygate {

/// Reads meshes, with their materials, and counts what they have of vertices and corners.
class GltfMeshes {
 public:
  /// Both must outlive this.
  GltfMeshes(const GltfFile& file, Scene& scene, bool textures)
      : file_(file), scene_(scene), materials_(file, scene, textures) {}

  /// Appends a mesh as `world` places it, faces of an object. Warns and leaves out points, lines
  /// and what has no positions. Throws InputError: what is no geometry, or too much of it.
  void read(const tinygltf::Mesh& mesh, const glm::dmat4& world, std::uint32_t object,
            MeshBuilder& to);

  /// Counts vertices and corners, so that what is written out does not fill the memory. Throws
  /// InputError where there are too many for a file of this size.
  void count(std::size_t more);

 private:
  void read(const tinygltf::Primitive& primitive, const glm::dmat4& world, std::uint32_t object,
            MeshBuilder& to);
  /// The triangles' corners, as numbers of the primitive's vertices.
  [[nodiscard]] std::vector<std::uint32_t> corners_of(const tinygltf::Primitive& primitive,
                                                      std::size_t vertices);

  const GltfFile& file_;
  Scene& scene_;
  GltfMaterials materials_;
  std::size_t vertices_ = 0;  // and corners, so far
};

}  // namespace raygate
