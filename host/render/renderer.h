// From a scene and a camera to a film.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "host/accel/bvh.h"
#include "host/hit/hit_tester.h"
#include "host/render/film.h"
#include "host/scene/scene.h"

namespace raygate {

class Camera;

/// What to render. Impossible values are bugs of the caller.
struct RenderOptions {
  int width = 0, height = 0;  ///< of the whole frame, at least 1
  PixelRect window;           ///< pixels to render, within the frame; empty: the whole frame
  int threads = 1;            ///< at least 1; the film does not depend on it
  std::uint64_t seed = 0;  ///< of everything random; one ray through each pixel's centre has none
};

/// What a render did. Seconds of the parts are summed over the threads (two threads busy for a
/// second make two seconds); `wall_seconds` is what a clock on the wall shows.
struct RenderStats {
  std::uint64_t rays = 0;
  std::uint64_t records = 0;       ///< polygon records made
  HitCounters hit;                 ///< summed over the threads' testers
  std::uint64_t exact_inside = 0;  ///< doubts about edges that exact arithmetic settled
  std::uint64_t exact_depth = 0;   ///< pairs of hits that exact arithmetic put in order
  double traverse_seconds = 0.0;   ///< boxes, and the records made on first touch
  double hit_seconds = 0.0;        ///< in HitTester::test, and merging its reports
  double doubt_seconds = 0.0;      ///< exact arithmetic about what they leave open
  double shade_seconds = 0.0;      ///< making the rays and shading them
  double wall_seconds = 0.0;
  bool cancelled = false;  ///< the progress function said stop: the film has holes
};

/// Makes the tester of one thread; called on that thread.
using HitTesterFactory = std::function<std::unique_ptr<HitTester>()>;

/// Called with the fraction done, in [0, 1], now and then and from one thread at a time; false
/// stops the render. May be empty.
using ProgressFunction = std::function<bool(double)>;

/// One ray through each pixel's centre; the nearest polygon shaded after Lambert with its diffuse
/// colour, lit from the camera on both sides, plus its emission. The film is the same, bit for
/// bit, for every engine and number of threads. An exception of a tester ends the render and is
/// thrown on.
[[nodiscard]] Film render(const Scene& scene, const Bvh& bvh, const Camera& camera,
                          const RenderOptions& options, const HitTesterFactory& make_tester,
                          RenderStats& stats, const ProgressFunction& progress = {});

}  // namespace raygate
