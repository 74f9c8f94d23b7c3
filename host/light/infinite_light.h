// Rays that leave the scene for its environment.
#pragma once

#include <cstdint>
#include <span>

#include "host/light/hits.h"
#include "host/light/ray_batch.h"

namespace raygate {

/// Adds what the environment sends along the rays at `at` in the block, places in increasing order.
/// `is_asked`: surfaces ask the environment for light, too, and a ray that was scattered counts by
/// its MIS weight.
void add_infinite_light(const ShadingScene& shading, const HitBlock& block,
                        std::span<const std::uint32_t> at, bool is_asked, ShadingOutput& output);

}  // namespace raygate
