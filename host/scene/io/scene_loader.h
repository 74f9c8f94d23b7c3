// load_scene: reads models of all supported formats, and scene files, into a Scene.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace raygate {

/// Which vertices keep the rest of their binary64 coordinates (Scene::rests).
enum class Vertices {
  kBinary64,  ///< all that do not fit binary32
  /// All, if rounding to binary32 would move a corner by more than a hundredth of the size of its
  /// face (other than a face without area); otherwise none. This is enough for pictures.
  kAsPictures,
  kBinary32,  ///< none
};

struct LoadOptions {
  bool textures = true;  ///< whether textures are decoded
  /// Largest angle, in degrees from 0 to 180, between two faces without vertex normals at which
  /// their edge is smoothed. By default the file's smoothing groups apply.
  std::optional<double> smooth = {};
  /// For glTF files kBinary64 acts as kAsPictures; meshes with instances use kBinary32.
  Vertices vertices = Vertices::kBinary64;
};

/// Loads a model. The ending of its name gives the format: .obj (or none), .gltf, .glb, .ply, .stl.
///
/// Triangles have the order of the file's faces. Polygons, which may be concave, are cut into
/// triangles of non-zero area. Faces of exactly zero area, as stored, are left out, and so are
/// vertices that no face uses. The scene is recentred; see Scene.
///
/// Throws InputError, with the line of a text file, for another ending, a file that cannot be read
/// or breaks its format, a vertex index out of range, a position that is not finite, and a file in
/// which no face has an area. Warns (Scene::warnings) about a material or texture that is missing
/// or damaged, a bad normal or texture coordinate, and all that is left out.
[[nodiscard]] Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

/// Returns the file that a model in `folder` names `name`, or nullopt. Tries `name` as it is, then
/// without quotes and with '/' for '\', then without the '\' before spaces. At last takes a file
/// whose name equals the last part of `name` in any letter case, in the folder of `name` or in
/// `folder`, and adds a warning that begins with `place`.
[[nodiscard]] std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder,
                                                             std::string_view name,
                                                             const std::string& place,
                                                             std::vector<std::string>& warnings);

/// Throws InputError if the ending of `file` is not that of a model format.
void require_model_ending(const std::filesystem::path& file);

/// Returns the first existing file of STEM.obj, .glb, .gltf, .ply and .stl, or else "STEM.obj".
[[nodiscard]] std::filesystem::path find_scene_file(const std::filesystem::path& stem);

// Scene files: a scene.json, with the camera, lights, instances and options of a scene. The format
// is described in host/docs/reference.md.

/// A parallelogram that emits light to both sides: a corner and the two edges from this corner.
struct AreaLightSetting {
  glm::dvec3 corner{0.0};
  glm::dvec3 edges[2]{};     ///< not parallel
  glm::vec3 radiance{0.0f};  ///< scene-linear RGB, none negative
};

/// A model and the transforms of its instances.
struct InstanceSetting {
  std::filesystem::path model;
  std::vector<glm::dmat4> transforms;  ///< from the model's coordinates to the world's
};

/// A value that was given to an option.
struct OptionValue {
  std::string name;     ///< of the option, without dashes
  std::string text;     ///< "" for a flag
  std::string where{};  ///< place for messages, "scene.json:3"; "": the command line
};

/// The contents of a scene file, in world coordinates. Option values are not checked yet.
struct SceneFile {
  std::filesystem::path file = {};
  std::filesystem::path obj = {};
  CameraRequest camera = {};
  std::vector<WorldPointLight> point_lights = {};
  std::vector<AreaLightSetting> area_lights = {};
  std::vector<DirectionalLight> directional_lights = {};
  EnvironmentSetting environment = {};
  std::optional<glm::vec3> background = {};  ///< radiance, scene-linear RGB, none negative
  std::vector<InstanceSetting> instances = {};
  std::vector<OptionValue> options = {};
};

/// Reads a scene file (.json). For a file with another ending, returns a SceneFile with that model
/// alone. Throws InputError, "file:line: what: found, expected ...", if the file cannot be read or
/// is not JSON, for unknown keys, and for values of a wrong type or out of range.
[[nodiscard]] SceneFile read_scene_file(const std::filesystem::path& file);

/// Loads the model of a scene file and adds the file's lights and instances, but no environment.
/// Each instance adds all objects of its model, without the model's lights and cameras. Each area
/// light adds two triangles, an object and a material, "light 1" and so on. Throws InputError as
/// load_scene(file) does, and for an instance or a light out of the range of float.
[[nodiscard]] Scene load_scene(const SceneFile& file, const LoadOptions& options = {});

// Readers of the formats of models, which load_scene() calls by the file's ending.

/// Loads a Wavefront OBJ file, with its MTL files (relative to its folder) and their textures.
[[nodiscard]] Scene load_obj(const std::filesystem::path& file, const LoadOptions& options = {});

/// Returns the materials of an MTL file in the file's order; of several with the same name, only
/// the first. Names textures relative to the file's folder, but loads none. Appends to `warnings`.
[[nodiscard]] std::vector<Material> read_mtl(const std::filesystem::path& file,
                                             std::vector<std::string>& warnings);

/// Loads a glTF 2.0 file (.gltf or .glb): the triangles, strips and fans of all nodes in order,
/// with an object for each node; materials (see GltfMaterials); the first camera; lights
/// (KHR_lights_punctual; 683 candela are 1 watt per steradian). +y is up. Positions are transformed
/// in double. Skins and morph targets are applied as posed by the nodes; animations are not read.
/// Meshes of several nodes become instances. Throws InputError also for a node with two parents,
/// and if vertices and corners exceed 12 million plus the number of bytes of the file.
[[nodiscard]] Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options = {});

/// Loads a PLY file, ASCII or binary: the polygons of the element "face", as one object of one
/// material. Vertices have x, y, z and may have nx, ny, nz, and red, green, blue. Warns about other
/// elements and properties, and about a texture ("comment TextureFile NAME").
[[nodiscard]] Scene load_ply(const std::filesystem::path& file, const LoadOptions& options = {});

/// Loads an STL file, binary or ASCII, as one object of a default material. +z is up, as in most
/// STL files. Ignores the normals, colours and attributes in the file.
[[nodiscard]] Scene load_stl(const std::filesystem::path& file, const LoadOptions& options = {});

/// Loads the texture files of all materials that triangles use into Scene::textures, a file used as
/// colour and as opacity once for each, and sets the materials' texture indices. Drops fully opaque
/// opacity maps. Warns about a file that is missing or cannot be read.
void load_textures(Scene& scene);

}  // namespace raygate
