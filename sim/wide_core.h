// A ray core with a table of 256 rays in simulation.
#pragma once

#include <memory>

#include "sim/rtl_core.h"

namespace raygate {

/// As make_rtl_core with behavioural arithmetic, but for kWideRays rays in flight in each core.
[[nodiscard]] std::unique_ptr<CoreUnit> make_wide_core(const MemoryTiming& timing,
                                                       const CoreSet& set);

inline constexpr int kWideRays = 256;

}  // namespace raygate
