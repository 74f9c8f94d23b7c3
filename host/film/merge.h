// One film from several that have a part of its samples, or of its pixels.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/film/exr_reader.h"

namespace raygate {

/// In what two files are not of the same picture, whatever samples and pixels of it they have:
/// "spp 8, expected spp 16", or nothing.
[[nodiscard]] std::optional<std::string> different_picture(const ExrMetadata& found,
                                                           const ExrMetadata& expected);

/// A film and the name of its file, for messages.
using NamedFilm = std::pair<std::string, FilmFile>;

/// What `parts` are together, which is bit for bit what one render would have given: parts of one
/// window have ranges of samples that follow each other, and windows have the same samples and
/// make up a rectangle. Throws InputError, one line: parts of different pictures, unfinished
/// ones, gaps and overlaps.
[[nodiscard]] FilmFile merge(std::vector<NamedFilm> parts);

}  // namespace raygate
