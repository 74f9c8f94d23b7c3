// The ray core in simulation, behind the interface of host/intersect/core.
#pragma once

#include <filesystem>
#include <memory>

#include "host/intersect/core/core_intersector.h"
#include "sim/arith.h"
#include "sim/memory_timing.h"

namespace raygate {

/// Chances per clock, in 1/256, that no ray is offered and that a result is not taken.
struct CoreStalls {
  int no_ray = 0, not_taken = 0;
  std::uint64_t seed = 0;
};

/// Maximum number of rays in flight in a ray_core by default, and in the core of a board.
inline constexpr int kTableRays = 64, kBoardRays = 16;

/// Number and kind of the cores that share one memory port.
struct CoreSet {
  int cores = 1;
  bool exact = false;                 ///< the cores resolve doubts themselves
  Arith arith = Arith::kBehavioural;  ///< structural: exact cores only
};

/// Makes Verilated ray_cores and the memory behind them. Not thread-safe: each thread makes its
/// own. Throws InputError if the model cannot be built.
[[nodiscard]] std::unique_ptr<CoreUnit> make_rtl_core(const MemoryTiming& timing = {},
                                                      const CoreStalls& stalls = {},
                                                      const CoreSet& set = {});

/// Makes a ray core with behavioural arithmetic, meant to trace single rays. Writes the waveform of
/// every clock to `file` (VCD); the file is complete when the core is destroyed. Throws InputError
/// if the file cannot be written or the model cannot be built.
[[nodiscard]] std::unique_ptr<CoreUnit> make_core_wave(const std::filesystem::path& file,
                                                       const MemoryTiming& timing);

/// Makes the small core of a board (hw/board) and its SDRAM, Verilated, behind a link of one word
/// per clock. Throws InputError if the model cannot be built.
[[nodiscard]] std::unique_ptr<CoreUnit> make_rtl_board();

}  // namespace raygate
