// The instances of scene.json. scenes/README.md has their format for users.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/scene/instances.h"
#include "host/scene/io/json_reader.h"
#include "host/scene/io/obj_loader.h"
#include "host/scene/scene.h"

namespace raygate {

/// Three rows of a matrix, from a model's coordinates to the world's.
using TransformRows = std::array<glm::dvec4, 3>;

/// A model, and where it stands.
struct InstanceSetting {
  std::filesystem::path model;
  std::vector<TransformRows> places;
  std::size_t line = 0;
};

/// The value of the key "instances". Throws InputError: values of a wrong type or out of range.
[[nodiscard]] std::vector<InstanceSetting> read_instances(const JsonReader& reader,
                                                          const std::filesystem::path& folder,
                                                          const JsonValue* value);

/// Loads the models and adds their instances to a scene, kept, an object for each of the model's in
/// each place. Lights and cameras of models are left out. Throws InputError as load_scene does, and
/// where an instance is beyond the range of float; messages begin with `file`.
void add_instances(const std::vector<InstanceSetting>& settings, const std::filesystem::path& file,
                   const LoadOptions& options, Scene& scene);

/// Makes the triangles of a part into a mesh of a scene, as add_mesh does, and adds instances of
/// it.
class PlacedMesh {
 public:
  /// The scene must outlive this.
  PlacedMesh(Scene& scene, Scene&& part);

  /// Adds one where `rows` put it in the world, by the scene's origin at this time. Mirrored ones
  /// have a mesh of their own. False, and none is added, where it is beyond the range of float.
  [[nodiscard]] bool add(const TransformRows& rows, std::uint32_t object);

 private:
  Scene& scene_;
  glm::dvec3 origin_;  // of the mesh's coordinates
  std::uint32_t mesh_;
  std::uint32_t turned_ = kNoIndex;  // none so far
  glm::dvec3 size_{0.0};             // the largest magnitudes of its coordinates
};

/// Around where `rows` put in the world what is in a box of coordinates relative to `origin`.
[[nodiscard]] Bounds3 transform_bounds(const TransformRows& rows, const glm::dvec3& origin,
                                       const Bounds3& box);

/// As resolve_instances does (host/scene/instances.h). Throws InputError, beginning with `file`,
/// where there are too many triangles.
void resolve_instances(Scene& scene, InstanceMode use, const std::filesystem::path& file);

}  // namespace raygate
