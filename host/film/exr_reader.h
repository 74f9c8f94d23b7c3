// OpenEXR files of any program, for comparing; and of ours, to go on with.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/film/exr.h"
#include "host/film/film.h"

namespace raygate {

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

}  // namespace raygate
