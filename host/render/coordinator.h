// Coordinator: hands out tiles on rank 0, or in the only process.
#pragma once

#include <memory>
#include <span>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/render/emitter_supersampler.h"
#include "host/render/render_job.h"
#include "host/render/tiles.h"

namespace raygate {

/// Renders all tiles into `film` on options.threads threads and on the other ranks, until they are
/// complete or `monitor` stops the render (RenderStats::cancelled). Rethrows exceptions of
/// intersectors; throws RankFailure.
void run_coordinator(const RenderJob& job, const Tiles& tiles,
                     std::unique_ptr<Intersector> first_intersector,
                     const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                     Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats);

}  // namespace raygate
