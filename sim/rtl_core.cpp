#include "sim/rtl_core.h"

#include <cassert>

#include "host/intersect/core/linked_core.h"
#include "sim/model_loader.h"

namespace raygate {
namespace {

constexpr ModelFile kExact{"ray_core_exact", "the simulated exact ray core", 60};
constexpr ModelFile kExactBehavioural{"ray_core_exact_behavioural",
                                      "the simulated exact ray core of behavioural arithmetic", 60};
constexpr ModelFile kBehavioural{"ray_core_behavioural",
                                 "the simulated ray core of behavioural arithmetic", 40};
constexpr ModelFile kOpen{"ray_core_open", "the simulated ray core that writes waveforms", 40};
constexpr ModelFile kBoard{"board_core", "the simulated board", 40};

}  // namespace

std::unique_ptr<CoreUnit> make_rtl_core(const MemoryTiming& timing, const CoreStalls& stalls,
                                        const CoreSet& set) {
  const bool structural = set.arith == Arith::kStructural;
  assert(set.exact || !structural);
  const auto make = load_model<CoreUnit*(const MemoryTiming&, const CoreStalls&, const CoreSet&)>(
      !set.exact   ? kBehavioural
      : structural ? kExact
                   : kExactBehavioural);
  return std::unique_ptr<CoreUnit>(make(timing, stalls, set));
}

std::unique_ptr<CoreUnit> make_core_wave(const std::filesystem::path& file,
                                         const MemoryTiming& timing) {
  const auto make = load_model<CoreUnit*(const char*, const MemoryTiming&)>(kOpen);
  return std::unique_ptr<CoreUnit>(make(file.c_str(), timing));
}

std::unique_ptr<CoreUnit> make_rtl_board() {
  const auto make = load_model<WordLink*()>(kBoard);
  return std::make_unique<LinkedCore>(std::unique_ptr<WordLink>(make()), kBoardRays);
}

}  // namespace raygate
