#include "sim/rtl_plane_unit.h"

#include <cassert>
#include <utility>

#include "sim/model_loader.h"
#include "sim/plane_model.h"

namespace raygate {

namespace {

constexpr ModelFile kStructural{"hit_test_unit_structural", "the simulated serial unit", 10};
constexpr ModelFile kBehavioural{"hit_test_unit_behavioural",
                                 "the simulated serial unit of behavioural arithmetic", 10};

std::unique_ptr<PlaneModel> make_model(Arith arith) {
  const auto make =
      load_model<PlaneModel*()>(arith == Arith::kStructural ? kStructural : kBehavioural);
  return std::unique_ptr<PlaneModel>(make());
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
