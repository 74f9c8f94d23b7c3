// What rank 0, or the only process, does in a render: it traces all tiles, with the others' help.
#pragma once

#include <memory>
#include <span>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/render/emitter_edges.h"
#include "host/render/render_job.h"
#include "host/render/renderer.h"
#include "host/render/tiles.h"

namespace raygate {

/// Traces on options.threads threads until all is in `film`, or `report` says stop
/// (RenderStats::cancelled). Throws what a intersector throws, and RankFailure.
void trace_all(const RenderJob& job, const Tiles& tiles,
               std::unique_ptr<Intersector> first_intersector,
               const IntersectorFactory& make_intersector, const ProgressFunction& report,
               Film& film, std::span<EmitterEdge> emitter_edges, RenderStats& stats);

}  // namespace raygate
