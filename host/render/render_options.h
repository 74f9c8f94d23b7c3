// Render options: what to render; render statistics: what it took; and the render's monitor.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "host/film/film.h"
#include "host/film/reconstruction_filter.h"
#include "host/intersect/intersector.h"
#include "host/light/default_lights.h"
#include "host/light/integrator_settings.h"

namespace raygate {

class Ranks;

/// What to render. Impossible values are bugs of the caller. The defaults are those of ./render and
/// of the Python module, whatever the engine; four samples as in Mitsuba.
struct RenderOptions : IntegratorSettings {
  int width = 640, height = 480;  ///< of the whole frame, at least 1
  PixelRect window;               ///< pixels to render, within the frame; empty: the whole frame
  int threads = 1;                ///< at least 1; the film does not depend on it
  /// The processes that share this render, each called with the same of everything that the film
  /// depends on; null: this one alone. Rank 0 has the film in the end; the others have parts, and
  /// call back for nothing but progress, to be told to stop. If one of them cannot go on, rank 0
  /// calls `urgent_snapshot` and throws RankFailure.
  Ranks* ranks = nullptr;
  int first_sample = 0;  ///< samples [first, end) are rendered
  int end_sample = 0;    ///< 0: all from the first on
  /// The unfinished film, with its sums, of the same window, options and samples from first_sample
  /// on, that the render resumes. Null: none.
  const Film* unfinished = nullptr;
  /// Above 0: adaptive sampling. `samples` is the most, and pixels go without those that their
  /// error does not need (has_converged in adaptive_sampling.h); in steps of an 8-bit display after
  /// `exposure` stops. The window then begins and ends at multiples of kErrorBlock, or with the
  /// frame, and all samples are rendered. The film has FilmSums::error.
  double error = 0.0;
  double exposure = 0.0;
  ReconstructionFilter filter = ReconstructionFilter::kBlackmanHarris;  ///< of several samples
  std::uint64_t seed = 0;                                               ///< of everything random
  ExtraChannels channels{};              ///< besides colour, depth, normal and primitive
  std::optional<CameraLights> lights{};  ///< in place of the scene's

  /// What takes the place of defaults: light from all around needs paths, as whitted has neither
  /// shadows nor shape of it; and paths need samples.
  void choose_integrator(bool has_environment, bool integrator_is_given, bool samples_are_given) {
    if (!has_environment || integrator_is_given) return;
    integrator = IntegratorKind::kPath;
    if (!samples_are_given) samples = kPathSamples;
  }
  static constexpr int kPathSamples = 16;
};

/// What a render tells its caller while it runs, on the thread that called render(). What is empty
/// is not called.
struct RenderMonitor {
  /// Takes the fraction done, in [0, 1], now and then; false stops the render.
  std::function<bool(double)> progress{};
  /// Takes a copy of the film so far every so many seconds, while the threads go on; nullptr where
  /// there is no memory for a copy.
  std::function<void(const Film*)> snapshot{};
  double snapshot_seconds = 10.0;
  /// With other ranks: asked now and then whether one of them may have died, and what takes the
  /// film if so.
  std::function<bool()> is_urgent{};
  std::function<void(const Film*)> urgent_snapshot{};
  /// Takes the film when the threads, deep in a search, have not stopped half a second after they
  /// were told to; at once where there are other ranks, as a launcher that ends them ends this one,
  /// too, in a second. Must end the process.
  std::function<void(const Film&)> abandon{};
};

/// What a render did. Seconds of the parts are summed over the threads (two threads busy for a
/// second make two seconds); `wall_seconds` is what a clock on the wall shows, `processor_seconds`
/// what all threads of the program, of all ranks, were given of the processors meanwhile.
struct RenderStats {
  std::uint64_t rays = 0;          ///< of all kinds; the others are reflected or refracted
  std::uint64_t camera_rays = 0;   ///< of these, from the camera
  std::uint64_t shadow_rays = 0;   ///< of these, between surfaces and lights
  std::uint64_t point_doubts = 0;  ///< hits of the others whose P the host computed
  SkipCounters skipped;
  IntersectCounters intersect;  ///< summed over the threads' intersectors
  double shade_seconds = 0.0;   ///< making the rays and shading them
  double wall_seconds = 0.0;
  double processor_seconds = 0.0;
  std::uint64_t spare_samples = 0;   ///< not taken, as RenderOptions::error had no need of them
  double gather_seconds = 0.0;       ///< of a processor of rank 0: handing out, putting together
  std::uint64_t gathered_tiles = 0;  ///< that came back from other ranks, once or more often ...
  std::uint64_t gathered_bytes = 0;  ///< ... with so much
  int missing_threads = 0;           ///< that could not be started; the others did their work
  bool cancelled = false;            ///< the monitor stopped it: the film has what there was

  /// Adds what another rank has counted. Its clock is not.
  void add(const RenderStats& worker) {
    rays += worker.rays;
    camera_rays += worker.camera_rays;
    shadow_rays += worker.shadow_rays;
    point_doubts += worker.point_doubts;
    skipped += worker.skipped;
    intersect += worker.intersect;
    shade_seconds += worker.shade_seconds;
    processor_seconds += worker.processor_seconds;
  }
};

}  // namespace raygate
