#include "sim/rtl_burst_unit.h"

#include <cassert>
#include <utility>

#include "Vhit_test_array_behavioural_1.h"
#include "Vhit_test_array_behavioural_1___024root.h"
#include "Vhit_test_array_behavioural_2.h"
#include "Vhit_test_array_behavioural_2___024root.h"
#include "Vhit_test_array_behavioural_4.h"
#include "Vhit_test_array_behavioural_4___024root.h"
#include "Vhit_test_array_behavioural_8.h"
#include "Vhit_test_array_behavioural_8___024root.h"
#include "Vhit_test_array_structural_1.h"
#include "Vhit_test_array_structural_1___024root.h"
#include "Vhit_test_array_structural_2.h"
#include "Vhit_test_array_structural_2___024root.h"
#include "Vhit_test_array_structural_4.h"
#include "Vhit_test_array_structural_4___024root.h"
#include "Vhit_test_array_structural_8.h"
#include "Vhit_test_array_structural_8___024root.h"
#include "sim/array_model.h"

namespace raygate {

namespace {

// The unit runs empty for 46 clocks after a batch if no other one follows. Of 0 to 256 tests a lane
// this took the fewest clocks on most scenes, for one lane and for eight.
constexpr std::size_t kEnoughTestsALane = 64;

std::unique_ptr<BurstModel> make_structural(int lanes, const BurstStalls& stalls) {
  switch (lanes) {
    case 1:
      return std::make_unique<ArrayModel<Vhit_test_array_structural_1, 1>>(stalls);
    case 2:
      return std::make_unique<ArrayModel<Vhit_test_array_structural_2, 2>>(stalls);
    case 4:
      return std::make_unique<ArrayModel<Vhit_test_array_structural_4, 4>>(stalls);
    default:
      assert(lanes == 8);
      return std::make_unique<ArrayModel<Vhit_test_array_structural_8, 8>>(stalls);
  }
}

std::unique_ptr<BurstModel> make_behavioural(int lanes, const BurstStalls& stalls) {
  switch (lanes) {
    case 1:
      return std::make_unique<ArrayModel<Vhit_test_array_behavioural_1, 1>>(stalls);
    case 2:
      return std::make_unique<ArrayModel<Vhit_test_array_behavioural_2, 2>>(stalls);
    case 4:
      return std::make_unique<ArrayModel<Vhit_test_array_behavioural_4, 4>>(stalls);
    default:
      assert(lanes == 8);
      return std::make_unique<ArrayModel<Vhit_test_array_behavioural_8, 8>>(stalls);
  }
}

}  // namespace

RtlBurstUnit::RtlBurstUnit(int lanes, Arith arith, const BurstStalls& stalls)
    : model_(arith == Arith::kStructural ? make_structural(lanes, stalls)
                                         : make_behavioural(lanes, stalls)),
      enough_tests_(kEnoughTestsALane * static_cast<std::size_t>(lanes)) {}

RtlBurstUnit::RtlBurstUnit(std::unique_ptr<BurstModel> model)
    : model_(std::move(model)), enough_tests_(kEnoughTestsALane) {}

RtlBurstUnit::~RtlBurstUnit() = default;

void RtlBurstUnit::run(std::span<const RayBundle> batch, BurstResults& results) {
  start(batch);
  finish(results);
}

void RtlBurstUnit::start(std::span<const RayBundle> batch) { model_->start(batch); }
void RtlBurstUnit::finish(BurstResults& results) { model_->finish(results); }

BurstCounters RtlBurstUnit::counters() const { return model_->counters(); }

}  // namespace raygate
