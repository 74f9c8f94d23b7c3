// Outputs of a run: the pictures of a film, finished or not, and the statistics.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/app/options.h"
#include "host/film/atomic_file.h"
#include "host/film/exr.h"
#include "host/film/film.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"

namespace raygate {

/// Pictures of a film, written under temporary names.
struct StagedFiles {
  std::vector<AtomicFile> files;
  std::vector<std::string> legends;  ///< of the false-colour pictures
};

/// Encodes all pictures and writes them under temporary names; the caller commits them. Unfinished
/// PNGs have a comment. Throws InputError as AtomicFile does; then no file remains.
[[nodiscard]] StagedFiles stage_files(const OutputOptions& options, const Film& film,
                                      const ExrMetadata& metadata, int threads = 1);

/// Returns "a.exr, a.png".
[[nodiscard]] std::string listed(const std::vector<std::filesystem::path>& paths);

/// Statistics of a finished run. Times are elapsed seconds.
struct Report {
  std::size_t triangles = 0;
  CornerRounding rounding;
  RenderStats render;
  double load_seconds = 0.0;   ///< reading the scene
  double tree_seconds = 0.0;   ///< building the tree
  double write_seconds = 0.0;  ///< encoding and writing the pictures
  double total_seconds = 0.0;
  std::string view;                  ///< Framing::text
  std::vector<std::string> legends;  ///< scales of the false-colour pictures
};

/// Returns the summary of a run: four lines, and one more for each of --engine check, --error,
/// legend, view and rounded corners. With --verbose, adds all statistics. Ends with a newline.
[[nodiscard]] std::string to_text(const Report& report, const Options& options);

/// Returns all statistics as a JSON object, for --stats.
[[nodiscard]] std::string to_json(const Report& report, const Options& options);

}  // namespace raygate
