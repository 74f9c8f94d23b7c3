// Settings, statistics and monitor of a render.
#pragma once

#include <cstdint>
#include <functional>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/light/integrator_settings.h"

namespace raygate {

/// User settings of an image; constant during a render. The caller ensures that values are in
/// range. The defaults are those of ./render and of the Python module.
struct RenderSettings : IntegratorSettings {
  int width = 640, height = 480;  ///< size of the whole frame, at least 1
  PixelRect window;               ///< pixels to render, within the frame; empty: the whole frame
  int threads = 1;                ///< at least 1; does not affect the film
  int first_sample = 0;           ///< renders samples [first_sample, end_sample)
  int end_sample = 0;             ///< 0 stands for `samples`
  /// Above 0: adaptive sampling to this error, in steps of an 8-bit display after `exposure` stops
  /// (see has_converged in adaptive_sampling.h); `samples` is the maximum. The window must begin
  /// and end at multiples of kErrorBlock or at the frame's edges, and first_sample and end_sample
  /// must be 0. The film has FilmSums::error.
  double error = 0.0;
  double exposure = 0.0;
  ReconstructionFilter filter = ReconstructionFilter::kBlackmanHarris;  ///< if samples > 1
  std::uint64_t seed = 0;    ///< seed of all random numbers
  ExtraChannels channels{};  ///< in addition to colour, depth, normal and primitive
};

/// Callbacks of a render, called on the thread that called render(). Empty callbacks are skipped.
struct RenderMonitor {
  /// Receives the fraction of passes over tiles that are complete, in [0, 1], periodically.
  /// Returning false stops the render.
  std::function<bool(double)> progress{};
  /// Receives a copy of the current film every `snapshot_seconds`, or null if there is no memory
  /// for a copy. The threads continue meanwhile.
  std::function<void(const Film*)> snapshot{};
  double snapshot_seconds = 10.0;
  /// Receives the film if threads still run 0.5 s after a stop. Must end the process.
  std::function<void(const Film&)> abandon{};
};

/// Statistics of a render. Seconds of parts are sums over the threads; `wall_seconds` is elapsed
/// time, `processor_seconds` the processor time of all threads.
struct RenderStats {
  std::uint64_t rays = 0;          ///< number of rays of all kinds
  std::uint64_t camera_rays = 0;   ///< camera rays among `rays`
  std::uint64_t shadow_rays = 0;   ///< shadow rays among `rays`; the rest leave surfaces or lights
  std::uint64_t point_doubts = 0;  ///< hits whose point P the host computed; excludes shadow rays
  IntersectCounters intersect;     ///< summed over the threads' intersectors
  double shade_seconds = 0.0;      ///< generating and shading rays
  double wall_seconds = 0.0;
  double processor_seconds = 0.0;
  std::uint64_t spare_samples = 0;      ///< samples that adaptive sampling did not need
  std::uint64_t unfinished_pixels = 0;  ///< pixels whose error needs more than the maximum samples
  int missing_threads = 0;              ///< threads that could not be started
  bool cancelled = false;               ///< the monitor stopped the render; the film is incomplete
};

}  // namespace raygate
