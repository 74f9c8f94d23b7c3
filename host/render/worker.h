// What a rank other than 0 does in a render: it traces the tiles that it is given.
#pragma once

#include <memory>
#include <span>

#include "host/film/film.h"
#include "host/find/finder.h"
#include "host/render/emitter_edges.h"
#include "host/render/render_job.h"
#include "host/render/renderer.h"

namespace raygate {

/// Helps rank 0, on options.threads threads, until all is traced. `film`, with sums, becomes its
/// notebook. Throws what a finder throws, and RunIsOver.
void run_worker(Ranks& ranks, const RenderJob& job, std::unique_ptr<Finder> first_finder,
                const FinderFactory& make_finder, const ProgressFunction& progress, Film& film,
                std::span<EmitterEdge> emitter_edges, RenderStats& stats);

}  // namespace raygate
