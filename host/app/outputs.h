// Outputs of a run: the pictures of a film, finished or not, and the statistics.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/app/console.h"
#include "host/app/options.h"
#include "host/film/atomic_file.h"
#include "host/film/exr.h"
#include "host/film/film.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"

namespace raygate {

/// Pictures of a film under temporary names.
struct StagedFiles {
  std::vector<AtomicFile> files;
  std::vector<std::filesystem::path> paths;
  std::vector<std::string> legends;  ///< of the false-colour pictures
};

/// Encodes and writes all pictures. Partial ones say so (ExrMetadata::partial). Throws InputError
/// as AtomicFile does; then no file is left.
[[nodiscard]] StagedFiles stage_files(const OutputOptions& options, const Film& film,
                                      const ExrMetadata& metadata, int threads = 1);

/// Returns a channel of the film in false colours. Throws InputError if the film lacks it.
[[nodiscard]] Image8 false_color_picture(const Film& film, const FalseColorOutput& output);

/// "a.exr, a.png".
[[nodiscard]] std::string listed(const std::vector<std::filesystem::path>& paths);

/// Saves an unfinished picture periodically and when a signal ends the run. The files are marked as
/// partial.
class Checkpointer {
 public:
  /// The references must outlive this.
  Checkpointer(const OutputOptions& outputs, const ExrMetadata& metadata, int threads,
               ProgressLine& line);

  /// Writes the unfinished pictures. Failures cost a warning; the next save tries again. `film` is
  /// null if there was no memory for a copy of it.
  void save(const Film* film);

  /// Writes the unfinished pictures, unless nothing was rendered, and throws Interrupted.
  [[noreturn]] void end_interrupted(const Film& film) const;

 private:
  void write(const Film& film) const;

  OutputOptions outputs_;  // without statistics
  ExrMetadata metadata_;
  int threads_;
  ProgressLine& line_;
  std::string last_trouble_;
};

/// Reads a film to resume, with the channels that this run's outputs need. `metadata`: of this
/// run's picture. Throws InputError if the file cannot be read, has no sums, or is of another
/// picture; only --spp may be larger.
[[nodiscard]] Film read_unfinished(const Options& options, const ExrMetadata& metadata);

/// Statistics of a finished run. Times are elapsed seconds.
struct Report {
  std::size_t triangles = 0;
  CornerRounding rounding;
  RenderStats render;
  double load_seconds = 0.0;   ///< reading the scene
  double tree_seconds = 0.0;   ///< building the tree
  double write_seconds = 0.0;  ///< encoding and writing the pictures
  double total_seconds = 0.0;
  std::vector<std::filesystem::path> pictures;
  std::string view;                  ///< Framing::text
  std::vector<std::string> legends;  ///< scales of the false-colour pictures
};

/// Returns the summary of a run: four lines, more for --engine check, --error, legends, views and
/// rounded corners; all statistics with --verbose. Ends with a newline.
[[nodiscard]] std::string to_text(const Report& report, const Options& options);

/// Returns all statistics as a JSON object, for --stats.
[[nodiscard]] std::string to_json(const Report& report, const Options& options);

}  // namespace raygate
