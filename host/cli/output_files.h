// The files of a picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/cli/output_options.h"
#include "host/film/atomic_file.h"
#include "host/film/exr.h"
#include "host/film/film.h"

namespace raygate {

/// The pictures of one film, written and not yet named.
struct StagedFiles {
  std::vector<AtomicFile> files;
  std::vector<std::filesystem::path> paths;
  std::vector<std::string> legends;  ///< of the false-colour pictures
};

/// Encodes and writes; all or nothing. A picture of which only a part was rendered says so in its
/// metadata (see ExrMetadata::partial). Throws InputError as AtomicFile does.
[[nodiscard]] StagedFiles stage_files(const OutputOptions& options, const Film& film,
                                      const ExrMetadata& metadata, int threads = 1);

}  // namespace raygate
