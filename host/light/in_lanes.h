// Hits of one kind, lane by lane.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>

#include "host/base/vectors.h"
#include "host/light/hits.h"

namespace raygate {

/// Calls shade(hits) for the hits at `at` in the block, as many at a time as there are lanes. The
/// baseline has one lane: it is the reference of the others, which have the same bits.
template <class Shade>
void shade_in_lanes(const ShadingScene& shading, HitBlock& block, HitKind kind,
                    std::span<const std::uint32_t> at, const Shade& shade) {
  in_vectors([&](auto code) RAYGATE_BODY {
    using T = std::conditional_t<code() == Vectors::kBaseline, float, FloatLanes>;
    constexpr std::size_t kCount = LanesOf<T>::kCount;
    for (std::size_t i = 0; i < at.size(); i += kCount) {
      Hits<T> hits(shading, block, kind, at.subspan(i, std::min(kCount, at.size() - i)));
      shade(hits);
    }
  });
}

}  // namespace raygate
