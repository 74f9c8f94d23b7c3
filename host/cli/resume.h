// Resuming: an unfinished picture or animation on disk, checked and read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/cli/options.h"
#include "host/film/exr.h"
#include "host/film/film.h"

namespace raygate {

/// What is in `file`, with the channels that this run's outputs need and no others. `metadata` is
/// what this run's picture says of itself. Throws InputError: a file that cannot be read, keeps no
/// sums, or is not of the picture that this run renders; only --spp may have grown.
[[nodiscard]] Film read_unfinished(const Options& options, const std::filesystem::path& file,
                                   const ExrMetadata& metadata);

/// What --resume finds of one frame of an animation.
struct FoundFrame {
  bool is_finished = false;          ///< all its files are there
  std::optional<Film> unfinished{};  ///< if not, and there is something to resume
  std::string damage{};              ///< else, where a file is damaged: which, and what is wrong
};

/// Looks at all bytes of a frame's files, `outputs`. One that was broken off without sums, and one
/// with a file that is damaged, count as none. Throws InputError as read_unfinished does.
[[nodiscard]] FoundFrame find_frame(const Options& options, const OutputOptions& outputs,
                                    const ExrMetadata& metadata);

}  // namespace raygate
