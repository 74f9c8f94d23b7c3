// Output files: the pictures of a film, finished or not.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/cli/options.h"
#include "host/cli/output_options.h"
#include "host/cli/progress_bar.h"
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

/// "a.exr, a.png".
[[nodiscard]] std::string listed(const std::vector<std::filesystem::path>& paths);

/// Saves what there is of a picture now and then, and when a signal ends the run. The files say
/// that they are partial.
class Checkpointer {
 public:
  /// The references must outlive this.
  /// `outputs` are of the picture, `all` of the run: the same, but for an animation.
  Checkpointer(const OutputOptions& outputs, const OutputOptions& all, const ExrMetadata& metadata,
               int threads, ProgressBar& bar)
      : outputs_(outputs), all_(all), metadata_(metadata), threads_(threads), bar_(bar) {}

  /// What goes wrong is said once and tried again. nullptr: there was no memory for a film.
  void save(const Film* film) { save(film, outputs_); }

  /// What a rank that has died has not brought down, without pictures that nothing goes on from.
  void save_urgently(const Film* film);

  /// Writes what had been rendered when a signal came, if that is anything, and throws Interrupted.
  [[noreturn]] void end_interrupted(const Film& film) const;

 private:
  void save(const Film* film, const OutputOptions& outputs);
  void write(const Film& film, const OutputOptions& outputs) const;

  const OutputOptions &outputs_, &all_;
  const ExrMetadata& metadata_;
  int threads_;
  ProgressBar& bar_;
  std::string last_trouble_;
};

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
