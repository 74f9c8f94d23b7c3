// From a scene and a camera to a film.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "host/bvh/bvh.h"
#include "host/film/film.h"
#include "host/film/reconstruction_filter.h"
#include "host/intersect/intersector.h"
#include "host/light/integrator_kind.h"
#include "host/light/neighbor_clearance.h"
#include "host/light/path_options.h"
#include "host/light/point_error.h"
#include "host/light/skips.h"
#include "host/scene/scene.h"

namespace raygate {

class Camera;
class Ranks;

/// What to render. Impossible values are bugs of the caller.
struct RenderOptions {
  int width = 0, height = 0;  ///< of the whole frame, at least 1
  PixelRect window;           ///< pixels to render, within the frame; empty: the whole frame
  int threads = 1;            ///< at least 1; the film does not depend on it
  /// Those that share this render, each called with the same of everything that the film depends
  /// on; null: nobody else. Rank 0 has the film in the end; the others have parts, and call back
  /// for nothing but progress, to be told to stop. If one of them cannot go on, rank 0 calls
  /// `urgent_snapshot` and throws RankFailure.
  Ranks* ranks = nullptr;
  int samples = 1;       ///< of each pixel, at least 1; a single one is its middle
  int first_sample = 0;  ///< those from this one ...
  int end_sample = 0;    ///< ... to before this one are rendered; 0: all
  /// What there is of this picture, of the same window, options and samples from first_sample on,
  /// with its sums: the render goes on from there. Null: nothing.
  const Film* begun = nullptr;
  /// Above 0: `samples` is the most, and pixels go without those that their error does not need
  /// (has_converged in sample_choice.h); in steps of an 8-bit display after `exposure` stops. The
  /// window then begins and ends at multiples of kErrorBlock, or with the frame, and all samples
  /// are rendered. The film has FilmSums::error.
  double error = 0.0;
  double exposure = 0.0;
  ReconstructionFilter filter =
      ReconstructionFilter::kBlackmanHarris;  ///< with more than one sample
  std::uint64_t seed = 0;                     ///< of everything random
  ExtraChannels channels{};                   ///< besides colour, depth, normal and primitive
  IntegratorKind integrator = IntegratorKind::kPrimary;
  int max_depth = 4;                ///< reflections and refractions in a row, at least 0
  double threshold = 1.0 / 256.0;   ///< Whitted: rays that count for less are not traced
  std::optional<double> ambient{};  ///< Whitted: radiance; none: see Lights::ambient
  PathOptions path{};               ///< path
  Skips skips{};                    ///< the film does not depend on them
  /// The unit's P is used where it is off by no more of the distance than that, in all else the
  /// host's: 0 for the host's alone; the largest float for the unit's wherever it has one.
  float point_error = kPointError;
  /// If not empty: called with a copy of the film so far every so many seconds, on the thread that
  /// called render(); the others go on.
  std::function<void(const Film&)> snapshot{};
  double snapshot_seconds = 10.0;
  /// With other ranks: asked now and then whether one of them may have died, and called if so, as
  /// `snapshot` is.
  std::function<bool()> is_urgent{};
  std::function<void(const Film&)> urgent_snapshot{};
  /// If not empty: called with a copy of the film so far when the threads have not stopped half a
  /// second after they were told to, deep in a search as they are; at once where there are other
  /// ranks, as a launcher that ends them ends this one, too, in a second. Must end the process.
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
  bool cancelled = false;  ///< the progress function said stop: the film has what there was
};

/// What another rank has counted. Its clock is not.
void add(RenderStats& stats, const RenderStats& of_worker);

/// Called with the fraction done, in [0, 1], now and then on the thread that called render(); false
/// stops the render. May be empty.
using ProgressFunction = std::function<bool(double)>;

/// The clearances are for renders of the same tree to share, one after the other or at once.
/// The film is the same, bit for bit, for every intersector, number of threads and skip, and a
/// window's is that part of the whole one's. An exception of a intersector ends the render and is
/// thrown on. Scenes without any light are black, but for kPrimary: see add_default_lights.
[[nodiscard]] Film render(const Scene& scene, const NeighborClearances& clearances,
                          const Camera& camera, const RenderOptions& options,
                          const IntersectorFactory& make_intersector, RenderStats& stats,
                          const ProgressFunction& progress = {});

/// The same for a tree that is rendered once.
[[nodiscard]] inline Film render(const Scene& scene, const Bvh& bvh, const Camera& camera,
                                 const RenderOptions& options,
                                 const IntersectorFactory& make_intersector, RenderStats& stats,
                                 const ProgressFunction& progress = {}) {
  return render(scene, NeighborClearances(bvh), camera, options, make_intersector, stats, progress);
}

}  // namespace raygate
