// Rays that leave the scene for its environment.
#pragma once

#include <cstdint>
#include <span>

#include "host/light/hits.h"
#include "host/light/wave.h"

namespace raygate {

/// Adds what the environment sends along the rays at `at` in the block, places in increasing order.
/// `is_asked`: surfaces ask the environment for light, too, and a ray that was scattered counts for
/// its way's share of finding it.
void add_environment(const ShadingScene& shading, const HitBlock& block,
                     std::span<const std::uint32_t> at, bool is_asked, WaveOutput& output);

}  // namespace raygate
