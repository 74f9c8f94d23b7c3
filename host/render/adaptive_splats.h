// Adaptive splats: what light paths bring where samples go by error.
#pragma once

#include "host/intersect/intersector.h"
#include "host/render/render_job.h"
#include "host/render/splat_layer.h"

namespace raygate {

/// With RenderOptions::error, traces all light paths before the first camera path: their noise is
/// their own, and no camera path makes it less. The whole frame's, in passes of 8, 8, 16, 32, ...
/// samples, as long as any block (adaptive_sampling.h) needs more; a block keeps those that it
/// needs, by the same rule as camera samples, as a display would show them on middle grey. So what
/// a block gets depends on no other block, nor on how many samples may follow: crops, ranks and
/// resumed renders have the same light.
///
/// `film`: whose window counts. Adds to `stats`, whose `cancelled` says that the monitor wanted no
/// more: then the layer is of no use.
[[nodiscard]] SplatLayer adaptive_splats(const RenderJob& job, const Film& film,
                                         const IntersectorFactory& make_intersector,
                                         const RenderMonitor& monitor, RenderStats& stats);

}  // namespace raygate
