// Output options: the files that are written.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/app/option_table.h"
#include "host/film/display.h"
#include "host/film/false_color.h"
#include "host/film/film.h"

namespace raygate {

/// A picture of one channel in false colours.
struct FalseColorOutput {
  std::string channel;         ///< name in the EXR: "Z", "N.X", "tests"
  std::optional<Scale> scale;  ///< none: from the smallest to the largest value
  std::filesystem::path path;
};

/// The output files of a run.
struct OutputOptions {
  std::optional<std::filesystem::path> exr;  ///< at least one of exr and png is set
  std::optional<std::filesystem::path> png;
  std::vector<FalseColorOutput> false_colors;
  std::optional<std::filesystem::path> stats;  ///< run statistics as JSON
  ExtraChannels channels;                      ///< extra channels of the EXR
  DisplayOptions display;                      ///< of the PNG
  double save_seconds = 0.0;                   ///< between saves of the unfinished picture; 0: none

  /// All files, statistics last.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
  /// The channels that a film needs for these files.
  [[nodiscard]] ExtraChannels needed_channels() const;
};

/// Adds the options of picture files to a table, for ./render and ./merge.
void add_picture_options(OptionTable& table, OutputOptions& options);
/// Adds the other output options of ./render.
void add_run_output_options(OptionTable& table, OutputOptions& options);

/// Sets the names of the pictures, by default `scene`'s name in the current folder. Throws
/// InputError, also for --channels without an EXR.
void name_outputs(const OptionTable& table, const std::filesystem::path& scene,
                  OutputOptions& options);

}  // namespace raygate
