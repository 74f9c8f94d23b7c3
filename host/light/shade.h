// The shading functions of the integrators, for hits of one kind.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>

#include "host/base/vectors.h"
#include "host/light/direct_light.h"
#include "host/light/hits.h"

namespace raygate {

/// Calls shade(hits) for the hits at positions `at` of the block, as many at a time as there are
/// lanes. The baseline has one lane and is the reference for the others, which give the same bits.
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

/// Shades the hits at positions `at` of the block, all of one kind.
using ShadeFunction = void(const ShadingScene& shading, HitBlock& block, HitKind kind,
                           std::span<const std::uint32_t> at);

/// Whitted's ray tracing ("An improved illumination model for shaded display", 1980), as in figure
/// 2 of the paper. At each hit: emission; direct light of every light, with a shadow ray to each
/// point light and to one point of each area light; an ambient term for interreflection; and rays
/// through mirrors and glass, up to the maximum depth or until their throughput is below the
/// threshold. With one sample per pixel flat area lights are sampled at their centre: no noise,
/// hard shadows.
ShadeFunction shade_whitted;

/// Path tracing (Kajiya, "The rendering equation", 1986). At each hit one light is sampled and one
/// ray is spawned: scattered, reflected or transmitted. Light that both can find is weighted by
/// multiple importance sampling (the power heuristic of Veach and Guibas, 1995). Russian roulette
/// begins after three surfaces. The last rays, one deeper than the maximum depth, add emission
/// only.
ShadeFunction shade_path;

/// Light tracing (Dutre, Lafortune and Willems, "Monte Carlo light tracing with direct computation
/// of pixel intensities", 1993): each hit after a first mirror or glass is connected to the camera
/// by a light sample whose target is on the lens, and one ray is spawned.
ShadeFunction shade_light_path;

/// Shades hits on specular paths from the camera whose histories are in PathState::supersampled:
/// adds emission, and spawns reflected and refracted rays. A ray's sample is a multiple of
/// kSpecularHistories plus its history, so that radiance is separated by history.
ShadeFunction shade_emitters;

}  // namespace raygate
