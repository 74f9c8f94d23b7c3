// The options that say which files are written and what they show.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/film/display.h"
#include "host/film/false_color.h"
#include "host/film/film.h"

namespace CLI {
class App;
}

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

/// As they were typed; empty where they were not given.
struct RawOutputOptions {
  std::string output, stats, channels, exposure, tone, frames, save_every;
  std::vector<std::string> false_colors;
};

/// Those of a picture, whoever made it.
void declare_picture_options(CLI::App& app, RawOutputOptions& raw);
/// All of them.
void declare_output_options(CLI::App& app, RawOutputOptions& raw);

/// Names that are not given come from `scene`'s, in the current folder. Throws InputError, one
/// line.
[[nodiscard]] OutputOptions parse_output_options(const RawOutputOptions& raw,
                                                 const std::filesystem::path& scene);

}  // namespace raygate
