// One row of the benchmark: a picture, who computes it, and how often.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "host/lab/variants/variant_table.h"

namespace raygate {

/// What is asked for. As JSON: an object of these names; all but `scene` may be left out.
struct BenchRun {
  std::filesystem::path scene;  ///< an OBJ file
  int width = 320, height = 240;
  std::string variant = "binary32";  ///< a name of variants.txt
  /// The renderer's own, of binary32: "cpu" or "rtl". The variant's: "twin" (in C++, bit-true) or
  /// "unit" (Verilated, one lane, which runs empty after each batch).
  std::string engine = "cpu";
  int lanes = 1;  ///< of the pipelined rtl: 1, 2, 4 or 8
  int threads = 1;
  std::string integrator = "primary";  ///< or "whitted", "path"
  int samples = 1;                     ///< of each pixel
  int depth = 4;                       ///< reflections and refractions in a row
  std::uint64_t seed = 0;
  int repeats = 1;      ///< timed ones; with more than one, another warms up
  bool audit = false;   ///< judge every hit test of the camera's rays exactly (not timed)
  std::string picture;  ///< where to write PICTURE.exr and PICTURE.png; empty: nowhere
};

/// Reads a run. Throws InputError: no object, an unknown name, a value of the wrong kind or out of
/// range, or an engine that cannot be had with this variant.
[[nodiscard]] BenchRun parse_run(const nlohmann::json& object);

/// Carries out all runs and gives an object for each, in their order: the run's own names with
/// their values, `command` to repeat it, and
///
///   triangles, records, rays, shadow_rays, tests, edge_doubts, exact_inside, exact_depth, clocks,
///   idle_clocks, output_stalls                                    as `render --stats` has them
///   seconds      of render alone, one for each repeat; thread_seconds of the last one
///   processor_seconds                                the same without what others computed then
///   yardstick_seconds                                of a fixed piece of work after each repeat
///   decisions    with `audit`: see DecisionAudit
///
/// The repeats of all runs are interleaved: first each run once, then each again. Pictures of one
/// run must be equal each time; throws std::logic_error where they are not. `progress` gets a line
/// before each picture.
[[nodiscard]] nlohmann::json measure(const std::vector<BenchRun>& runs,
                                     void (*progress)(const std::string& line));

}  // namespace raygate
