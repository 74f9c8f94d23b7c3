// Pixels in which a light begins or ends.
#pragma once

#include <cstdint>
#include <span>

#include "host/film/film.h"
#include "host/intersect/intersector.h"
#include "host/render/render_job.h"

namespace raygate {

/// Whether a pixel is one of them.
enum class EmitterEdge : std::uint8_t { kUnknown, kNo, kYes };

/// Finds them in a tile: `is_edge` is by pixel of the film's window.
///
/// A light is as a rule far brighter than all around it, and the pixels at its edges are the
/// noisiest of a picture, while what camera rays see of lights costs little to know: no light, no
/// shadow, no way on. In these pixels it is worth more rays.
///
/// A pixel is one of them if rays through the corners of pixels, as far
/// as its filter reaches, meet different emission. That depends on no sample, so that more rays
/// where it is so favour nothing. Lights between all corners, smaller than pixels, are not found.
/// Returns how many rays it took;
/// what they cost is added to `work`, by pixel of the tile, unless that is empty.
std::size_t find_emitter_edges(const RenderJob& job, Intersector& intersector, const Film& film,
                               const PixelRect& tile, std::span<EmitterEdge> is_edge,
                               std::span<RayWork> work);

}  // namespace raygate
