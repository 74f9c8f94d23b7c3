// Wavefront OBJ and MTL files into a Scene: every valid file right, every other one refused.
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
  bool keep_instances = false;  ///< false: they are written out (see host/scene/instances.h)
  bool textures = true;         ///< false: nobody will ask for them
  /// Faces without normals are smooth over edges at which they are at most so far apart, in degrees
  /// from 0 to 180; none: as the file's smoothing groups say, where it can have any.
  std::optional<double> smooth = {};
  int threads = 1;                    ///< that read the file; they change nothing of the scene
  std::size_t chunk_size = 1u << 18;  ///< bytes of the file that are worth a thread's while
};

/// Loads `file`, the MTL files that it names (relative to its own folder), and their textures.
///
/// The triangles keep the order of the file's faces. Polygons, also concave ones, are cut into
/// triangles of non-zero area. Only vertices that some face uses are kept, in the file's order;
/// the scene is recentred as scene.h says. Numbers are read as in the C locale, to the nearest
/// double.
///
/// Throws InputError with file and line: what cannot be read, what is not OBJ, an index that no
/// vertex answers to, a number that is not finite, no face with an area,
/// a texture that is damaged.
/// Warns (Scene::warnings) and goes on: a missing MTL file, material or texture, statements that
/// say nothing to a ray tracer of polygons (points, lines, curves).
[[nodiscard]] Scene load_obj(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace raygate
