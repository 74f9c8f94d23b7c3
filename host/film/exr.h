// OpenEXR files: writing a film with all of its channels, reading films and other pictures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/film/film.h"

namespace raygate {

/// What an EXR file says of itself. Only facts of the scene and the camera belong here: what
/// changes from run to run or from engine to engine (times, engine, threads) would make equal
/// pictures different files, and is for `render --stats`.
struct ExrMetadata {
  std::string software;    ///< attribute "software": name and version
  std::string scene;       ///< attribute "scene": file name without folders
  std::uint64_t seed = 0;  ///< attribute "seed", in decimal
  /// More attributes, by name: the options of `render` that the picture depends on.
  std::vector<std::pair<std::string, std::string>> options{};
  /// Attribute "worldToCamera", as OpenEXR defines it: +x to the right of the picture, +y up,
  /// +z along the view. Here for column vectors; the file has it for row vectors.
  glm::mat4 world_to_camera{1.0f};
  /// Attribute "screenWindowWidth": width of the frame in the plane at distance 1.
  float screen_window_width = 1.0f;
  /// The render was not finished: pixels without a sample are like misses, others may have fewer
  /// samples than asked for. Attribute "partial", with the words of kPartial; else it is not there.
  bool partial = false;
};

inline constexpr const char* kPartial = "not finished when it was saved";

/// The bytes of an OpenEXR scan-line file of `film`, ZIP compressed (without loss):
///   R G B A        float   scene-linear, premultiplied
///   Z              float   distance along the camera's axis, +infinity for a miss
///   N.X N.Y N.Z    float   unit normal in world axes, 0 for a miss
///   id             uint    triangle index, 4294967295 for a miss
/// and, where the film has them,
///   P.X P.Y P.Z    float   the point that is seen, in world axes, 0 for a miss
///   Albedo.R .G .B float   diffuse colour, 0 for a miss
///   objectId       uint    object index, 4294967295 for a miss
///   tests doubts   uint    counts
///   samples error  uint, float    how many samples, and the error that is left (FilmSums)
/// The display window is the frame, the data window the film's window within it. Equal arguments
/// give equal bytes, whatever the number of threads. They are read back, as the library does not
/// always say that it had no memory left. Throws std::bad_alloc where they do not hold every bit of
/// the film.
[[nodiscard]] std::string encode_exr(const Film& film, const ExrMetadata& metadata,
                                     int threads = 1);

/// Some channels of a picture file, as numbers; exact, as float and uint fit into double.
struct ChannelPicture {
  int width = 0, height = 0;  ///< of the frame (the display window)
  PixelRect window;           ///< what the file holds (the data window), in the frame's coordinates
  std::vector<std::string> names;
  std::vector<std::vector<double>> channels;  ///< names[i]'s numbers, row by row from the top
};

/// Reads the channels `names` of a scan-line or tiled file's first part. Throws InputError: what
/// cannot be read or is not OpenEXR, is damaged, lacks a channel, or is larger than 2^26 pixels.
[[nodiscard]] ChannelPicture read_exr(const std::filesystem::path& file,
                                      std::span<const std::string> names);

/// A film as encode_exr left it.
struct FilmFile {
  Film film;
  ExrMetadata metadata;
};

/// What a picture file says of itself, without its numbers.
struct ExrSummary {
  int width = 0, height = 0;
  PixelRect window;
  std::vector<std::string> channels;  ///< in the order of their letters
  ExrMetadata metadata;
  bool is_complete = false;  ///< the file has all of its rows
};

/// Throws InputError: what cannot be read, is not OpenEXR, or is larger than 2^26 pixels.
[[nodiscard]] ExrSummary read_summary(const std::filesystem::path& file);

/// Reads a film that keeps its sums. Throws InputError: what cannot be read, is not OpenEXR or not
/// such a film, is damaged, or is larger than 2^26 pixels.
[[nodiscard]] FilmFile read_film(const std::filesystem::path& file);

/// Whether the file begins as OpenEXR files do.
[[nodiscard]] bool is_exr(const std::filesystem::path& file);

/// Throws InputError, one line that begins with the file's name: for what cannot be read or is no
/// OpenEXR file, and for a header for which the library would take memory that the file does not
/// fill. What passes may still be damaged.
void require_exr(const std::filesystem::path& file);

}  // namespace raygate
