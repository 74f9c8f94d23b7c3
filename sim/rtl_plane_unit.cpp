#include "sim/rtl_plane_unit.h"

#include <cassert>
#include <utility>

#include "Vhit_test_unit_behavioural.h"
#include "Vhit_test_unit_structural.h"
#include "sim/plane_model.h"

namespace raygate {

namespace {

std::unique_ptr<PlaneModel> make_model(Arith arith) {
  if (arith == Arith::kStructural)
    return std::make_unique<PlaneModelOf<Vhit_test_unit_structural>>();
  return std::make_unique<PlaneModelOf<Vhit_test_unit_behavioural>>();
}

}  // namespace

RtlPlaneUnit::RtlPlaneUnit(Arith arith) : model_(make_model(arith)) {}

RtlPlaneUnit::RtlPlaneUnit(std::unique_ptr<PlaneModel> model) : model_(std::move(model)) {}

RtlPlaneUnit::~RtlPlaneUnit() = default;

void RtlPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  if (!tests.empty()) model_->intersect(tests, points);
}

std::uint64_t RtlPlaneUnit::clocks() const { return model_->clocks(); }

}  // namespace raygate
