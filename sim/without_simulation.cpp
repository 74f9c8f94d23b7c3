// Stubs for programs without simulated units: making one throws InputError with instructions.
#include <string>

#include "host/base/input_error.h"
#include "sim/rtl_core.h"
#include "sim/rtl_units.h"
#include "sim/simulation.h"

namespace raygate {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw InputError(what +
                   " is not in this program, which was built without Verilator; `make verilate` "
                   "builds it in; --engine cpu does not need it");
}

constexpr const char* kUnit = "the simulated hit-test unit";

}  // namespace

// Never constructed: the members of type std::unique_ptr need complete types.
class BurstModel {};
class PlaneModel {};

bool has_simulation() { return false; }

RtlBurstUnit::RtlBurstUnit(int /*lanes*/, Arith /*arith*/, const BurstStalls& /*stalls*/) {
  fail(kUnit);
}
RtlBurstUnit::~RtlBurstUnit() = default;
void RtlBurstUnit::start(std::span<const RayBundle> /*batch*/) {}
void RtlBurstUnit::finish(BurstResults& /*results*/) {}
HitCounters RtlBurstUnit::counters() const { return {}; }

RtlPlaneUnit::RtlPlaneUnit(Arith /*arith*/) { fail(kUnit); }
RtlPlaneUnit::~RtlPlaneUnit() = default;
void RtlPlaneUnit::intersect(std::span<const PlaneTest> /*tests*/,
                             std::span<glm::vec3> /*points*/) {}
std::uint64_t RtlPlaneUnit::clocks() const { return 0; }

std::unique_ptr<CoreUnit> make_rtl_core(const MemoryTiming& /*timing*/,
                                        const CoreStalls& /*stalls*/, const CoreSet& /*set*/) {
  fail("the simulated ray core");
}
std::unique_ptr<CoreUnit> make_core_wave(const std::filesystem::path& /*file*/,
                                         const MemoryTiming& /*timing*/) {
  fail("the simulated ray core that writes waveforms");
}
std::unique_ptr<CoreUnit> make_rtl_board() { fail("the simulated board"); }

}  // namespace raygate
