// The integrators: what each does with hits of one kind.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>

#include "host/base/vectors.h"
#include "host/light/direct_light.h"
#include "host/light/hits.h"

namespace raygate {

/// Calls shade(hits) for the hits at `at` in the block, as many at a time as there are lanes. The
/// baseline has one lane: it is the reference of the others, which have the same bits.
template <class Shade>
void shade_in_lanes(const ShadingScene& shading, HitBlock& block, HitKind kind,
                    std::span<const std::uint32_t> at, const Shade& shade) {
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr std::size_t kCount = kLanesOf<T>;
    for (std::size_t i = 0; i < at.size(); i += kCount) {
      Hits<T> hits(shading, block, kind, at.subspan(i, std::min(kCount, at.size() - i)));
      shade(hits);
    }
  });
}

/// Shades the hits at `at` in the block, all of one kind.
using ShadeFunction = void(const ShadingScene& shading, HitBlock& block, HitKind kind,
                           std::span<const std::uint32_t> at);

/// Whitted's ray tracing ("An improved illumination model for shaded display", 1980), as figure 2
/// of the paper has it. At each hit: what the surface emits; the light of every light that it
/// scatters, with a shadow ray to each point light and to one point of each area light; ambient
/// light, which reaches everything, for all light between surfaces; and rays on through mirrors and
/// glass, to the depth chosen or until their throughput falls below the threshold. With one sample
/// a pixel flat area lights are sampled in their middle: no noise, hard shadows.
ShadeFunction shade_whitted;

/// Path tracing (Kajiya, "The rendering equation", 1986). At each hit one light is sampled, and one
/// ray goes on, scattered, mirrored or through the surface. Light that both find is weighted by
/// multiple importance sampling (the power heuristic of Veach and Guibas, 1995). Russian roulette
/// begins after three surfaces. The last rays, one deeper than the depth chosen, see what emits and
/// nothing else.
ShadeFunction shade_path;

/// Light tracing (Dutre, Lafortune and Willems, "Monte Carlo light tracing with direct computation
/// of pixel intensities", 1993): each hit behind a first mirror or glass is connected to the
/// camera, as a light sample that is on its way to the lens, and one ray goes on.
ShadeFunction shade_light_path;

/// Emission along specular paths from the camera, with the histories in PathState::supersampled:
/// what hits emit, and rays reflected and refracted. A ray's sample is a multiple of
/// kSpecularHistories plus its history, so that radiance is separated by history.
ShadeFunction shade_emitters;

}  // namespace raygate
