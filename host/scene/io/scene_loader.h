// Scene files of every format that is read, into a Scene.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "host/scene/scene.h"

namespace raygate {

struct LoadOptions {
  /// A face of exactly zero area (after rounding to float) is an error; false: it is left out, and
  /// one warning counts them.
  bool strict = false;
  bool keep_instances = false;  ///< false: they are flattened (see host/scene/instances.h)
  bool textures = true;         ///< false: none is decoded
  /// Faces without normals are smooth over edges at which they are at most so far apart, in degrees
  /// from 0 to 180; none: as the file's smoothing groups say, where it can have any.
  std::optional<double> smooth = {};
  /// Without `smooth`, of an OBJ, PLY or STL file that has no normals and says nothing of
  /// smoothing: faces that bend are smooth as by kSmoothAngle.
  bool smooth_if_unsaid = false;
  static constexpr double kSmoothAngle = 30.0;
  int threads = 1;                    ///< that read an OBJ file; the scene does not depend on them
  std::size_t chunk_size = 1u << 18;  ///< least bytes of the file that are worth a thread
};

/// Loads `file` as what its name ends in: .obj (or nothing), .gltf, .glb, .ply or .stl, in small or
/// capital letters.
///
/// Triangles keep the order of the file's faces; polygons, also concave ones, are cut into
/// triangles of non-zero area; only vertices that some face uses are kept; the scene is recentred
/// as scene.h says. Numbers are read as in the C locale, to the nearest double.
///
/// Throws InputError, with a line of what is text, for any other ending, with what to do about it;
/// for what cannot be read or breaks its format; an index of no vertex, a number that is not
/// finite in a position; no face with an area. Warns (Scene::warnings) and goes on where a material
/// or texture is missing or damaged, a normal or texture coordinate is bad, or something is left
/// out.
[[nodiscard]] Scene load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

/// The file of this stem that is there, by the first of those endings: "room" gives "room.obj",
/// also where there is none.
[[nodiscard]] std::filesystem::path find_scene_file(const std::filesystem::path& stem);

/// Wavefront OBJ, with the MTL files that it names (relative to its own folder) and their textures.
[[nodiscard]] Scene load_obj(const std::filesystem::path& file, const LoadOptions& options = {});

/// glTF 2.0 (.gltf and .glb): triangles, strips and fans of all nodes, in their order, an object
/// for each; materials as GltfMaterials says; the first camera; lights (KHR_lights_punctual: 683
/// candela are 1 watt per steradian). +y is up. Positions are transformed in double. Skins and
/// morph targets are as their nodes have them; animations are not read.
/// Refuses, too: a node with two parents, more than 12 million vertices and corners of faces, and
/// as many again as there are bytes, once instances are flattened.
[[nodiscard]] Scene load_gltf(const std::filesystem::path& file, const LoadOptions& options = {});

/// PLY, ASCII and binary: the polygons of the element "face", as one object of a default material.
/// Of vertices x, y, z count, and where they are there nx, ny, nz and red, green, blue. All other
/// elements and properties are skipped with a warning.
///
/// (No library that Debian 12 has reads PLY: assimp 5.2 crashed on damaged files, and keeps
/// positions as float alone, with which a scene far from its origin is lost.)
[[nodiscard]] Scene load_ply(const std::filesystem::path& file, const LoadOptions& options = {});

/// STL, binary and ASCII: one object of a default material; +z is up, as STL files mostly have it.
/// Normals, colours and attributes in the file are ignored.
[[nodiscard]] Scene load_stl(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace raygate
