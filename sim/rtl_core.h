// The ray core in simulation, behind the interface of host/intersect/core.
#pragma once

#include <filesystem>
#include <memory>

#include "host/intersect/core/core_intersector.h"
#include "sim/arith.h"
#include "sim/memory_timing.h"

namespace raygate {

/// Chances, in 1/256 a clock, that no ray is offered and that a result is not taken.
struct CoreStalls {
  int no_ray = 0, not_taken = 0;
  std::uint64_t seed = 0;
};

/// Rays in the table of a core, and of a board's.
inline constexpr int kTableRays = 64, kBoardRays = 16;

/// Cores behind one port to memory.
struct CoreSet {
  int cores = 1;
  bool exact = false;                 ///< they settle doubts by themselves
  Arith arith = Arith::kBehavioural;  ///< structural: of exact cores alone
};

/// ray_core, Verilated, and the memory behind it. Not for use by two threads at once: each thread
/// makes its own. Throws InputError where the model can't be built.
[[nodiscard]] std::unique_ptr<CoreUnit> make_rtl_core(const MemoryTiming& timing = {},
                                                      const CoreStalls& stalls = {},
                                                      const CoreSet& set = {});

/// A ray core, for one ray at a time, of behavioural arithmetic, whose words are structural
/// arithmetic's, too. Every clock from now on is written to `file` (VCD), which is whole when the
/// core is gone. Throws InputError where the file can't be written or the model can't be built.
[[nodiscard]] std::unique_ptr<CoreUnit> make_core_wave(const std::filesystem::path& file,
                                                       const MemoryTiming& timing);

/// The small core of a board (hw/board) and its SDRAM, Verilated, as a board behind a link as fast
/// as its clock. Throws InputError where the model can't be built.
[[nodiscard]] std::unique_ptr<CoreUnit> make_rtl_board();

}  // namespace raygate
