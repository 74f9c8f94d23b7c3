// The statistics of a run, for people and for programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/app/options.h"
#include "host/render/renderer.h"
#include "host/scene/scene.h"

namespace raygate {

/// Everything there is to say of a finished run. Times are seconds on the wall.
struct Report {
  Options options;
  int ranks = 1;  ///< that shared the run
  std::size_t triangles = 0;
  CornerRounding rounding;  ///< of the scene's corners
  RenderStats render;
  double load_seconds = 0.0;   ///< reading OBJ and MTL
  double tree_seconds = 0.0;   ///< building the tree of boxes
  double write_seconds = 0.0;  ///< encoding the pictures and bringing them to disk
  double total_seconds = 0.0;
  std::vector<std::filesystem::path> pictures;
  std::string view;                  ///< what to type for the view, where none was asked for
  std::vector<std::string> legends;  ///< what the colours of false-colour pictures mean
};

/// Simulated clocks for each test that the unit did; 0 where nothing is simulated.
[[nodiscard]] double clocks_per_test(const HitCounters& counters);

/// The summary at the end of a run: four lines, one more for --engine check, for --error, for each
/// legend, for a view and for rounded corners, and with --verbose all there is to say. Every line
/// is ended.
[[nodiscard]] std::string to_text(const Report& report);

/// The same and some more as a JSON object, for --stats. statistics.csv lists the keys.
[[nodiscard]] std::string to_json(const Report& report);

}  // namespace raygate
