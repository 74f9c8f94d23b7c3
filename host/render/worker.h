// What a rank other than 0 does in a render: it traces the tiles that it is given.
#pragma once

#include <memory>
#include <span>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/render/emitter_edges.h"
#include "host/render/render_job.h"
#include "host/render/renderer.h"

namespace raygate {

/// Helps rank 0, on options.threads threads, until all is traced. `film`, with sums, becomes its
/// notebook. Throws what a intersector throws, and RunIsOver.
void run_worker(Ranks& ranks, const RenderJob& job, std::unique_ptr<Intersector> first_intersector,
                const IntersectorFactory& make_intersector, const ProgressFunction& progress,
                Film& film, std::span<EmitterEdge> emitter_edges, RenderStats& stats);

}  // namespace raygate
