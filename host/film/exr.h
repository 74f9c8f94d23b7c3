// OpenEXR files: writes films with all channels; reads films and other images.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>

#include "host/film/film.h"
#include "host/scene/scene.h"

namespace raygate {

/// Attributes of an EXR file. They describe the scene, camera and options of the picture only.
/// Times, engine and threads belong in `render --stats`, so that equal pictures have equal files.
struct ExrMetadata {
  /// Texts: "software" (name and version), "scene" (file name without folders), "seed", and the
  /// options of `render` that the picture depends on. kPartialAttribute if the render is
  /// unfinished: pixels without a sample are misses, and other pixels may have too few samples.
  std::map<std::string, std::string> attributes{};
  /// Attribute "worldToCamera", as OpenEXR defines it: +x to the right of the picture, +y up,
  /// +z along the view. The matrix here is for column vectors, the file's for row vectors.
  glm::mat4 world_to_camera{1.0f};
  /// Attribute "screenWindowWidth": width of the frame in the plane at distance 1.
  float screen_window_width = 1.0f;
};

inline constexpr const char *kPartialAttribute = "partial",
                            *kPartial = "not finished when it was saved";

/// Returns an OpenEXR scan-line file of `film`, ZIP compressed (lossless), with the channels of
/// channels_of(). The display window is the frame; the data window is film.window. Equal arguments
/// give equal bytes, for any number of threads. The bytes are read back and checked, because the
/// library does not report all failures to allocate memory. Throws std::bad_alloc for these.
[[nodiscard]] std::string encode_exr(const Film& film, const ExrMetadata& metadata,
                                     int threads = 1);

/// Reads the channels R, G and B of the first part of a scan-line or tiled file: the unchanged
/// texels of the data window. Throws InputError if the file cannot be read, is not OpenEXR, is
/// damaged, lacks a channel, or has more than 2^26 pixels.
[[nodiscard]] EnvironmentMap read_exr(const std::filesystem::path& file);

/// A film with its attributes, as read from a file.
struct FilmFile {
  Film film;
  ExrMetadata metadata;
};

/// Reads a film with its sums. Throws InputError if the file cannot be read, is not OpenEXR, has no
/// sums, is damaged, or has more than 2^26 pixels.
[[nodiscard]] FilmFile read_film(const std::filesystem::path& file);

/// Returns whether the file starts with OpenEXR's magic number.
[[nodiscard]] bool is_exr(const std::filesystem::path& file);

}  // namespace raygate
