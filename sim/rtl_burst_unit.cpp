#include "sim/rtl_burst_unit.h"

#include <cassert>
#include <utility>

#include "Vhit_test_array_structural.h"
#include "Vhit_test_array_structural___024root.h"
#include "sim/array_model.h"
#include "sim/model_loader.h"

namespace raygate {

namespace {

// The unit runs empty for 46 clocks after a batch if no other one follows. Of 0 to 256 tests a lane
// this took the fewest clocks on most scenes, for one lane and for eight.
constexpr std::size_t kEnoughTestsALane = 64;

constexpr ModelFile kBehavioural{"hit_test_array_behavioural",
                                 "the simulated hit-test unit of behavioural arithmetic", 15};

std::unique_ptr<BurstModel> make_array(int lanes, Arith arith, const BurstStalls& stalls) {
  if (arith == Arith::kStructural)
    return std::make_unique<ArrayModel<Vhit_test_array_structural>>(lanes, stalls);
  const auto make = load_model<BurstModel*(int, const BurstStalls&)>(kBehavioural);
  return std::unique_ptr<BurstModel>(make(lanes, stalls));
}

}  // namespace

RtlBurstUnit::RtlBurstUnit(int lanes, Arith arith, const BurstStalls& stalls)
    : model_(make_array(lanes, arith, stalls)),
      enough_tests_(kEnoughTestsALane * static_cast<std::size_t>(lanes)) {}

RtlBurstUnit::RtlBurstUnit(std::unique_ptr<BurstModel> model)
    : model_(std::move(model)), enough_tests_(kEnoughTestsALane) {}

RtlBurstUnit::~RtlBurstUnit() = default;

void RtlBurstUnit::start(std::span<const RayBundle> batch) { model_->start(batch); }
void RtlBurstUnit::finish(BurstResults& results) { model_->finish(results); }

BurstCounters RtlBurstUnit::counters() const { return model_->counters(); }

}  // namespace raygate
