// A row of the benchmark: an image, the engine that renders it, and the number of repeats.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/lab/results.h"
#include "host/render/renderer.h"
#include "host/variants/variant_table.h"

namespace raygate::lab {

/// Options of a run. As JSON: an object with these names, of which only `scene` is required.
struct PictureRun {
  std::string scene;                 ///< an OBJ file
  std::string section;               ///< section of the report
  int width = 320, height = 240;     ///< 1 to 65536
  std::string variant = "binary32";  ///< a name of variants.json
  /// Engines of the renderer, for binary32: "cpu" or "rtl". Engines of a variant: "model"
  /// (bit-exact, in C++) or "unit" (Verilated, one lane, empty after each batch).
  std::string engine = "cpu";
  int lanes = 1;                       ///< of the pipelined rtl engine: 1, 2, 4 or 8
  int threads = 1;                     ///< 1 to 256
  std::string integrator = "primary";  ///< "primary", "whitted" or "path"
  int samples = 1;                     ///< per pixel, 1 to 2^20
  int depth = 4;                       ///< consecutive reflections and refractions, 0 to 1000
  std::uint64_t seed = 0;
  /// Relative error of P above which the host computes it: 0 for always; -1: never.
  double point_error = kPointError;
  int repeats = 1;      ///< timed repeats, 1 to 1000; preceded by an untimed one if more than one
  bool audit = false;   ///< check every hit test of camera rays exactly (not timed)
  std::string picture;  ///< writes PICTURE.png; empty: no file
  std::string against;  ///< `picture` of another run to compare with
};

/// Parses a run. Throws InputError if it is not an object, for an unknown name, a value of the
/// wrong type or out of range, and an engine that does not support the variant.
[[nodiscard]] PictureRun parse_run(const Row& object);

/// Executes all runs and returns a row for each, in order, with the run's own columns and:
///
///   command              command line that reproduces the row
///   triangles, records, rays, shadow_rays, tests, unit_tests, edge_doubts, exact_inside,
///   exact_depth, point_doubts, clocks, idle_clocks, output_stalls     as in `render --stats`
///   seconds              of render alone, one per repeat; thread_seconds of the last one
///   processor_seconds    likewise, without the time of other processes
///   yardstick_seconds    of a fixed workload after each repeat
///   decisions            with `audit`: see audit_decisions
///   rmse, psnr_db, ssim, differing_pixels               with `against`
///
/// The repeats of all runs are interleaved: each run is executed once, then each again. Throws
/// std::logic_error if the images of a run differ. Prints the next image to standard error.
[[nodiscard]] std::vector<Row> measure(const std::vector<PictureRun>& runs);

}  // namespace raygate::lab
