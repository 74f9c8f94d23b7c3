// Parts of a picture: the samples of a file, and merging of files.
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
  friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

/// Parses "A:B"; returns an empty range unless 0 <= A < B.
[[nodiscard]] SampleRange parse_sample_range(const std::string& text);
[[nodiscard]] std::string to_string(const SampleRange& range);

/// Attribute with the range "A:B" of a file's samples, if the file lacks some of 0 to "spp".
inline constexpr const char* kSamplesAttribute = "samples";

/// Attribute with the digest of the scene (digest_of).
inline constexpr const char* kSceneAttribute = "sceneDigest";

/// Returns the samples of a film file: kSamplesAttribute or, without it, 0 to "spp".
[[nodiscard]] SampleRange samples_of(const ExrMetadata& metadata);
/// Sets kSamplesAttribute, or removes it if `range` is 0 to "spp".
void set_samples(ExrMetadata& metadata, const SampleRange& range);

/// Returns why a file is not part of a picture of `width` x `height` pixels with the metadata
/// `expected`: "spp 8, expected spp 16" or "another camera, expected that"; nullopt if it matches.
[[nodiscard]] std::optional<std::string> different_picture(const FilmFile& found,
                                                           const ExrMetadata& expected, int width,
                                                           int height);

/// The name of a file, for messages, and its film.
using NamedFilm = std::pair<std::string, FilmFile>;

/// Merges parts of a picture: ranges of samples, crops or both. The result has the bits of a single
/// render, and keeps its sums if samples are missing. Together, the parts must cover a rectangle,
/// in which all pixels have the same consecutive samples. Throws InputError, one line, for parts of
/// different pictures, unfinished parts, gaps and overlaps.
[[nodiscard]] FilmFile merge(std::vector<NamedFilm> parts);

}  // namespace raygate
