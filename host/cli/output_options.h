// Output options: which files are written, and what they show.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/film/display.h"
#include "host/film/false_color.h"
#include "host/film/film.h"
#include "host/options/option_table.h"

namespace raygate {

/// One channel as a picture in false colours.
struct FalseColorOutput {
  std::string channel;         ///< as in the EXR file: "Z", "N.X", "tests"
  std::optional<Scale> scale;  ///< none: from the least to the greatest number
  std::filesystem::path path;
};

/// The files of a run; all values are possible.
struct OutputOptions {
  std::optional<std::filesystem::path> exr;  ///< at least one of the two pictures is there
  std::optional<std::filesystem::path> png;
  std::vector<FalseColorOutput> false_colors;
  std::optional<std::filesystem::path> stats;  ///< run statistics as JSON
  ExtraChannels channels;                      ///< that the EXR shall have
  DisplayOptions display;                      ///< of the PNG
  int frames = 0;                              ///< of an animation, 1 to 9999; 0: a single picture
  double save_seconds = 0.0;                   ///< between saves of what there is; 0: only the end

  /// All files, statistics last.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
  /// What a film must hold for them.
  [[nodiscard]] ExtraChannels needed_channels() const;
  /// The same for one frame, from 1: "name-0001.png".
  [[nodiscard]] OutputOptions numbered(int frame) const;
};

/// Adds to a table what sets `options`, of a picture, whoever made it.
void add_picture_options(OptionTable& table, OutputOptions& options);
/// And of a run that renders pictures.
void add_run_output_options(OptionTable& table, OutputOptions& options);

/// Names the pictures: what was not typed comes from `scene`'s name, in the current folder. Throws
/// InputError, one line, also where --channels has no EXR to go into.
void name_outputs(const OptionTable& table, const std::filesystem::path& scene,
                  OutputOptions& options);

}  // namespace raygate
