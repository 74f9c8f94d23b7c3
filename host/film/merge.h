// Parts of a picture: which samples a file has, and one film made of several.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/film/exr.h"

namespace raygate {

/// Samples [first, end) of each pixel.
struct SampleRange {
  int first = 0, end = 0;
};

/// "A:B"; none if it is no such range with 0 <= A < B.
[[nodiscard]] std::optional<SampleRange> parse_sample_range(const std::string& text);
[[nodiscard]] std::string to_string(const SampleRange& range);

/// The attribute of a file that does not have all of "spp".
inline constexpr const char* kSamplesAttribute = "samples";

/// The attribute of the digest of all geometry, materials and lights that were read
/// (host/scene/digest.h).
inline constexpr const char* kSceneAttribute = "sceneDigest";

/// What a film file says that it holds: that attribute, or all of "spp".
[[nodiscard]] SampleRange samples_of(const ExrMetadata& metadata);
/// The attribute says so from now on; it is not there where that is all of "spp".
void set_samples(ExrMetadata& metadata, const SampleRange& range);

/// In what two files are not of the same picture, whatever samples and pixels of it they have:
/// "spp 8, expected spp 16", or "another geometry, material or light"; or nothing.
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
