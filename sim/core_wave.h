// A ray core whose signals go to a waveform, for one ray at a time.
#pragma once

#include <filesystem>
#include <memory>

#include "host/intersect/core/core_unit.h"
#include "sim/memory_timing.h"

namespace raygate {

/// ray_core with behavioural arithmetic, whose words are structural arithmetic's, too. Every clock
/// from now on is written to `file` (VCD), which is whole when the core is gone. Throws InputError
/// where it can't be written, and in a program that was built without RAYGATE_WAVES.
[[nodiscard]] std::unique_ptr<CoreUnit> make_core_wave(const std::filesystem::path& file,
                                                       const MemoryTiming& timing);

}  // namespace raygate
