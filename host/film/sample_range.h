// Which of a picture's samples a file has.
#pragma once

#include <optional>
#include <string>

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

/// What a film file says that it holds: that attribute, or all of "spp".
[[nodiscard]] SampleRange samples_of(const ExrMetadata& metadata);
/// The attribute says so from now on; it is not there where that is all of "spp".
void set_samples(ExrMetadata& metadata, const SampleRange& range);

}  // namespace raygate
