#include "host/render/renderer.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>
#include <vector>

#include "host/base/stopwatch.h"
#include "host/light/light_paths.h"
#include "host/light/lights.h"
#include "host/ranks/ranks.h"
#include "host/render/coordinator.h"
#include "host/render/emitter_supersampler.h"
#include "host/render/remote_workers.h"
#include "host/render/tiles.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

Film empty_film(const RenderOptions& options) {
  const PixelRect frame{0, 0, options.width, options.height};
  const bool is_crop = options.window.width() > 0 && options.window.height() > 0;
  const PixelRect& window = is_crop ? options.window : frame;
  assert(window.x0 >= 0 && window.x1 <= options.width);
  assert(window.y0 >= 0 && window.y1 <= options.height);
  return make_film(options.width, options.height, window, options.channels);
}

/// Whether light paths are asked for and possible.
bool wants_light_paths(const RenderOptions& options, const Camera& camera) {
  return options.caustics != Caustics::kOff && options.integrator == IntegratorKind::kPath &&
         options.samples > 1 && options.error == 0.0 && !options.lights &&
         camera.projection() == Projection::kPerspective;
}

/// The frame as light paths have to hit it for the film's window.
FrameView frame_view(const Camera& camera, const RenderOptions& options, const Film& film) {
  const glm::dvec2 size(film.width, film.height);
  const double margin = filter_radius(options.filter) + 1.0;
  const PixelRect& window = film.window;
  return {camera, film.width, film.height, (glm::dvec2(window.x0, window.y0) - margin) / size,
          (glm::dvec2(window.x1, window.y1) + margin) / size};
}

}  // namespace

Film render(const PreparedScene& prepared, const Camera& camera, const RenderOptions& options,
            const IntersectorFactory& make_intersector, RenderStats& stats,
            const RenderMonitor& monitor) {
  assert(options.width > 0 && options.height > 0 && options.threads > 0 && options.samples > 0);
  Stopwatch wall;
  const double busy = processor_seconds();
  stats = {};
  const Bvh& bvh = prepared.bvh;
  Film film = empty_film(options);
  auto first_intersector = make_intersector();
  const int end = options.end_sample > 0 ? options.end_sample : options.samples;
  const int ranks = options.ranks == nullptr ? 1 : options.ranks->count();
  const Tiles tiles(film.window, end - options.first_sample, first_intersector->preferred_batch(),
                    options.threads, ranks, options.error > 0.0);
  const bool is_path = options.integrator == IntegratorKind::kPath;
  const auto sampling = is_path ? Lights::Sampling::kOne : Lights::Sampling::kAll;
  std::optional<Lights> camera_lights;
  if (options.lights) camera_lights.emplace(prepared.scene, bvh, sampling, options.lights);
  const Lights& lights = camera_lights ? *camera_lights : prepared.lights(sampling);
  std::optional<LightPaths> light_paths;
  if (wants_light_paths(options, camera)) {
    light_paths.emplace(prepared, lights, frame_view(camera, options, film));
    if (!light_paths->exist()) light_paths.reset();
  }
  if (options.unfinished != nullptr) {
    film = *options.unfinished;
    film.keeps_sums = options.channels.sums;
    assert(film.sums.samples.size() == film.color.size());
  } else if (tiles.passes() > 1 || film.keeps_sums || options.error > 0.0 || ranks > 1 ||
             light_paths) {
    add_sums(film, options.error > 0.0);
  }
  // One sample is the pixel's middle: where it falls is no matter of chance. Behind a lens lights
  // have no edges.
  std::vector<HistoryMask> emitter_histories;
  if (options.samples > 1 && camera.aperture() == 0.0 && !lights.areas().empty()) {
    emitter_histories.assign(film.color.size(), kUnknownHistories);
  }
  const RenderJob job{prepared, camera, options, lights, light_paths ? &*light_paths : nullptr};
  if (ranks > 1 && options.ranks->index() != 0) {
    run_worker(*options.ranks, job, std::move(first_intersector), make_intersector, monitor, film,
               emitter_histories, stats);
    return film;
  }
  run_coordinator(job, tiles, std::move(first_intersector), make_intersector, monitor, film,
                  emitter_histories, stats);
  if (stats.intersect.common_records != 0) {
    const std::size_t origins = (camera.has_common_origin() ? 1 : 0) + lights.points().size();
    const std::uint64_t every_record = bvh.primitive_count() * origins * std::uint64_t(ranks);
    stats.skipped.records = every_record - stats.intersect.common_records;
  }
  const std::uint64_t every_test = stats.rays * bvh.triangle_count();
  stats.skipped.culled_tests = every_test - std::min(every_test, stats.intersect.hit.tests);
  if (options.error > 0.0) {
    for (const std::uint32_t samples : film.sums.samples) {
      stats.spare_samples += static_cast<std::uint32_t>(options.samples) - samples;
    }
  }
  stats.wall_seconds = wall.lap();
  stats.processor_seconds += processor_seconds() - busy;
  return film;
}

}  // namespace raygate
