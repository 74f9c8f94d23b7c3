#include "sim/rtl_units.h"

#include <cassert>
#include <utility>

#include "Vhit_test_array_structural.h"
#include "Vhit_test_array_structural___024root.h"
#include "sim/array_model.h"
#include "sim/model_loader.h"
#include "sim/plane_model.h"

namespace raygate {

namespace {

constexpr ModelFile kStructuralPlane{"hit_test_unit_structural", "the simulated serial unit", 10};
constexpr ModelFile kBehaviouralPlane{"hit_test_unit_behavioural",
                                      "the simulated serial unit of behavioural arithmetic", 10};

std::unique_ptr<PlaneModel> make_plane(Arith arith) {
  const auto make =
      load_model<PlaneModel*()>(arith == Arith::kStructural ? kStructuralPlane : kBehaviouralPlane);
  return std::unique_ptr<PlaneModel>(make());
}

// After a batch that no other follows, the pipeline drains for 46 clocks. Of the values 0 to 256,
// this one took the fewest clocks on most scenes, with one lane and with eight.
constexpr std::size_t kEnoughTestsALane = 64;

constexpr ModelFile kBehaviouralArray{"hit_test_array_behavioural",
                                      "the simulated hit-test unit of behavioural arithmetic", 15};

std::unique_ptr<BurstModel> make_array(int lanes, Arith arith, const BurstStalls& stalls) {
  if (arith == Arith::kStructural)
    return std::make_unique<ArrayModel<Vhit_test_array_structural>>(lanes, stalls);
  const auto make = load_model<BurstModel*(int, const BurstStalls&)>(kBehaviouralArray);
  return std::unique_ptr<BurstModel>(make(lanes, stalls));
}

}  // namespace

RtlPlaneUnit::RtlPlaneUnit(Arith arith) : model_(make_plane(arith)) {}

RtlPlaneUnit::RtlPlaneUnit(std::unique_ptr<PlaneModel> model) : model_(std::move(model)) {}

RtlPlaneUnit::~RtlPlaneUnit() = default;

void RtlPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  if (!tests.empty()) model_->intersect(tests, points);
}

std::uint64_t RtlPlaneUnit::clocks() const { return model_->clocks(); }

RtlBurstUnit::RtlBurstUnit(int lanes, Arith arith, const BurstStalls& stalls)
    : model_(make_array(lanes, arith, stalls)),
      enough_tests_(kEnoughTestsALane * static_cast<std::size_t>(lanes)) {}

RtlBurstUnit::RtlBurstUnit(std::unique_ptr<BurstModel> model)
    : model_(std::move(model)), enough_tests_(kEnoughTestsALane) {}

RtlBurstUnit::~RtlBurstUnit() = default;

void RtlBurstUnit::start(std::span<const RayBundle> batch) { model_->start(batch); }
void RtlBurstUnit::finish(BurstResults& results) { model_->finish(results); }

HitCounters RtlBurstUnit::counters() const { return model_->counters(); }

}  // namespace raygate
