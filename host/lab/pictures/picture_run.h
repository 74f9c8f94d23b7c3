// One row of the benchmark: a picture, who computes it, and how often.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/lab/results.h"
#include "host/render/renderer.h"
#include "host/variants/variant_table.h"

namespace raygate::lab {

/// What is asked for. As JSON: an object of these names; all but `scene` may be left out.
struct PictureRun {
  std::string scene;                 ///< an OBJ file
  std::string section;               ///< of the report
  int width = 320, height = 240;     ///< 1 to 65536
  std::string variant = "binary32";  ///< a name of variants.json
  /// The renderer's own, of binary32: "cpu" or "rtl". The variant's: "model" (in C++, bit-true) or
  /// "unit" (Verilated, one lane, which runs empty after each batch).
  std::string engine = "cpu";
  int lanes = 1;                       ///< of the pipelined rtl: 1, 2, 4 or 8
  int threads = 1;                     ///< 1 to 256
  std::string integrator = "primary";  ///< or "whitted", "path"
  int samples = 1;                     ///< per pixel, 1 to 2^20
  int depth = 4;                       ///< reflections and refractions in a row, 0 to 1000
  std::uint64_t seed = 0;
  /// The part of itself that P may be off by before the host computes it: 0 for always; -1: never.
  double point_error = kPointError;
  int repeats = 1;      ///< timed ones, 1 to 1000; with more than one, another warms up
  bool audit = false;   ///< judge every hit test of the camera's rays exactly (not timed)
  std::string picture;  ///< where to write PICTURE.png; empty: nowhere
  std::string against;  ///< the `picture` of another run, that this one is compared with
};

/// Reads a run. Throws InputError: no object, an unknown name, a value of the wrong kind or out of
/// range, or an engine that cannot be had with this variant.
[[nodiscard]] PictureRun parse_run(const Row& object);

/// Carries out all runs and gives a row for each, in their order: the run's own columns, and
///
///   command              makes the row again
///   triangles, records, rays, shadow_rays, tests, unit_tests, edge_doubts, exact_inside,
///   exact_depth, point_doubts, clocks, idle_clocks, output_stalls     as `render --stats` has them
///   seconds              of render alone, one for each repeat; thread_seconds of the last one
///   processor_seconds    the same without what others computed then
///   yardstick_seconds    of a fixed piece of work after each repeat
///   decisions            with `audit`: see audit_decisions
///   rmse, psnr_db, ssim, differing_pixels               with `against`
///
/// The repeats of all runs are interleaved: first each run once, then each again. Pictures of one
/// run must be equal each time; throws std::logic_error where they are not. A line on
/// standard error says which picture is next.
[[nodiscard]] std::vector<Row> measure(const std::vector<PictureRun>& runs);

}  // namespace raygate::lab
