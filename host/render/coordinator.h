// Coordinator: rank 0, or the only process, hands out tiles; the other ranks are its workers.
#pragma once

#include <memory>
#include <span>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/render/emitter_supersampler.h"
#include "host/render/render_job.h"
#include "host/render/tiles.h"

namespace raygate {

/// Renders all tiles on options.threads threads, and on the other ranks, until all is in `film`, or
/// `monitor` says stop (RenderStats::cancelled). Throws what an intersector throws, and
/// RankFailure.
void run_coordinator(const RenderJob& job, const Tiles& tiles,
                     std::unique_ptr<Intersector> first_intersector,
                     const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                     Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats);

/// Renders the tiles that rank 0 sends, on options.threads threads, until it says that all is done,
/// or `monitor` says stop. `film`, with sums, becomes this rank's notebook. Throws what an
/// intersector throws, and RunIsOver.
void run_worker(Ranks& ranks, const RenderJob& job, std::unique_ptr<Intersector> first_intersector,
                const IntersectorFactory& make_intersector, const RenderMonitor& monitor,
                Film& film, std::span<HistoryMask> emitter_histories, RenderStats& stats);

}  // namespace raygate
