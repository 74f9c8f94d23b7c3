// The meshes of a glTF file as vertices and faces of a MeshBuilder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/scene/io/gltf_file.h"
#include "host/scene/io/gltf_materials.h"
#include "host/scene/io/mesh_builder.h"
#include "host/scene/scene.h"

namespace raygate {

/// Where a node has its mesh, and in what shape.
struct GltfPlacement {
  glm::dmat4 world;
  const std::vector<double>* weights;  ///< of the mesh's morph targets
  std::vector<glm::dmat4> joints;  ///< of its skin, which take the place of `world`; none: empty
};

/// Reads meshes, with their materials, and counts what they have of vertices and corners.
class GltfMeshes {
 public:
  /// Both must outlive this.
  GltfMeshes(const GltfFile& file, Scene& scene, bool textures)
      : file_(file), scene_(scene), materials_(file, scene, textures) {}

  /// Appends a mesh in a place, faces of an object. Warns and leaves out points, lines
  /// and what has no positions. Throws InputError: what is no geometry, or too much of it.
  void read(const tinygltf::Mesh& mesh, const GltfPlacement& placement, std::uint32_t object,
            MeshBuilder& to);

  /// Counts vertices and corners, so that what is written out does not fill the memory. Throws
  /// InputError where there are too many for a file of this size.
  void count(std::size_t more);

 private:
  void read(const tinygltf::Primitive& primitive, const GltfPlacement& placement,
            std::uint32_t object, MeshBuilder& to);
  void warn_of_attributes(const tinygltf::Primitive& primitive);
  /// Returns the numbers of an attribute with its morph targets, times their weights, added.
  [[nodiscard]] std::vector<double> attribute(const tinygltf::Primitive& primitive,
                                              const std::string& name, int width,
                                              std::size_t vertices,
                                              const std::vector<double>& weights);
  /// Returns the transform of each vertex to the world by the joints of its skin.
  [[nodiscard]] std::vector<glm::dmat4> skinned(const tinygltf::Primitive& primitive,
                                                const GltfPlacement& placement,
                                                std::size_t vertices);
  /// The triangles' corners, as numbers of the primitive's vertices.
  [[nodiscard]] std::vector<std::uint32_t> corners_of(const tinygltf::Primitive& primitive,
                                                      std::size_t vertices);

  const GltfFile& file_;
  Scene& scene_;
  GltfMaterials materials_;
  std::size_t vertices_ = 0;  // and corners, so far
};

}  // namespace raygate
