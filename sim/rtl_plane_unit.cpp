#include "sim/rtl_plane_unit.h"

#include <bit>
#include <cassert>

#include "Vhit_test_unit.h"
#include "sim/model.h"

namespace raygate {

struct RtlPlaneUnit::Unit : Model<Vhit_test_unit> {
  /// One clock with `word` on the bus; returns what is on the other bus after it.
  float exchange(float word) {
    (*this)->bus_i = std::bit_cast<std::uint32_t>(word);
    clock();
    return std::bit_cast<float>((*this)->bus_o);
  }
};

RtlPlaneUnit::RtlPlaneUnit() : unit_(std::make_unique<Unit>()) {
  (*unit_)->valid_i = 0;
  unit_->reset();
}

RtlPlaneUnit::~RtlPlaneUnit() = default;

void RtlPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  if (tests.empty()) return;
  Unit& unit = *unit_;
  glm::vec3 unread;  // what the bus has before the first result
  glm::vec3* point = &unread;
  unit->valid_i = 1;  // whenever the unit is ready, the next test is there
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const PlaneTest& test = tests[i];
    assert(unit->ready_o);
    for (int k = 0; k < 3; ++k) (*point)[k] = unit.exchange(test.direction[k]);
    for (int k = 0; k < 3; ++k) unit.exchange(test.normal[k]);
    unit.exchange(test.d);
    point = &points[i];
  }
  unit->valid_i = 0;
  for (int k = 0; k < 3; ++k) (*point)[k] = unit.exchange(0.0f);
}

std::uint64_t RtlPlaneUnit::clocks() const { return unit_->clocks(); }

}  // namespace raygate
