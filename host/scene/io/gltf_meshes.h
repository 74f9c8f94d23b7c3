// GltfMeshes: passes the meshes of a glTF file to a MeshBuilder.
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

/// The transform and the shape of a node's mesh.
struct GltfPlacement {
  glm::dmat4 world;                    ///< from the mesh's coordinates to the world's
  const std::vector<double>* weights;  ///< of the mesh's morph targets
  std::vector<glm::dmat4> joints;      ///< transforms of a skin, which replace `world`; or empty
};

/// Reads meshes with their materials, and limits the number of their vertices and corners.
class GltfMeshes {
 public:
  /// `file` and `scene` must outlive this object.
  GltfMeshes(GltfFile& file, Scene& scene, bool textures)
      : file_(file), scene_(scene), materials_(file, scene, textures) {}

  /// Appends the faces of a mesh, which belong to object number `object`. Leaves out points, lines
  /// and primitives without positions, with a warning. Throws InputError for invalid geometry and
  /// as count() does.
  void read(const Json& mesh, const GltfPlacement& placement, std::uint32_t object,
            MeshBuilder& to);

  /// Adds `more` vertices and corners to the count. Throws InputError if there are too many for a
  /// file of this size, before flattened instances exhaust the memory.
  void count(std::size_t more);

 private:
  void read_primitive(const Json& primitive, const GltfPlacement& placement, std::uint32_t object,
                      MeshBuilder& to);
  /// Returns the numbers of an attribute plus the weighted sum of its morph targets; an empty list
  /// if there is no such attribute.
  [[nodiscard]] std::vector<double> attribute(const Json& primitive, const std::string& name,
                                              int width, std::size_t vertices,
                                              const std::vector<double>& weights = {});
  /// Returns the transform of each vertex to the world: the weighted mean of its joints.
  [[nodiscard]] std::vector<glm::dmat4> skinned(const Json& primitive,
                                                const GltfPlacement& placement,
                                                std::size_t vertices);
  /// Returns the corners of the triangles as indices into the primitive's vertices.
  [[nodiscard]] std::vector<std::uint32_t> corners_of(const Json& primitive, std::size_t vertices);

  GltfFile& file_;
  Scene& scene_;
  GltfMaterials materials_;
  std::size_t vertices_ = 0;  // vertices and corners counted so far
};

}  // namespace raygate
