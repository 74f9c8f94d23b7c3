// The picture to measure: OpenEXR with every value the renderer left behind.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>

#include "host/render/film.h"

namespace raygate {

/// What an EXR file says of itself. Only facts of the scene and the camera belong here: what
/// changes from run to run or from engine to engine (times, engine, threads) would make equal
/// pictures different files, and is for `render --stats`.
struct ExrMetadata {
  std::string software;             ///< attribute "software": name and version
  std::string scene;                ///< attribute "scene": file name without folders
  std::uint64_t seed = 0;           ///< attribute "seed", in decimal
  glm::mat4 world_to_camera{1.0f};  ///< column vectors; attribute "worldToCamera"
  glm::mat4 world_to_ndc{1.0f};     ///< column vectors; attribute "worldToNDC"
};

/// The bytes of an OpenEXR scan-line file of `film`, ZIP compressed (without loss):
///   R G B A        float   scene-linear, premultiplied
///   Z              float   distance along the camera's axis, +infinity for a miss
///   N.X N.Y N.Z    float   unit normal in world axes, 0 for a miss
///   id             uint    triangle index, 4294967295 for a miss
/// The display window is the frame, the data window the film's window within it. The two matrices
/// are stored as OpenEXR wants them, for row vectors. Equal arguments give equal bytes.
/// Throws std::runtime_error if the library fails.
[[nodiscard]] std::string encode_exr(const Film& film, const ExrMetadata& metadata);

}  // namespace raygate
