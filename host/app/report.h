// Report: the statistics of a run as text and as JSON.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/app/options.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"

namespace raygate {

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
