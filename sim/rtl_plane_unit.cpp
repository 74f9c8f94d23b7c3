#include "sim/rtl_plane_unit.h"

#include <bit>
#include <cassert>

#include "Vhit_test_unit_behavioural.h"
#include "Vhit_test_unit_structural.h"
#include "sim/model.h"

namespace raygate {

/// What RtlPlaneUnit needs of a unit.
class PlaneModel {
 public:
  virtual ~PlaneModel() = default;
  virtual void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) = 0;
  [[nodiscard]] virtual std::uint64_t clocks() const = 0;
};

namespace {

/// The unit `Top` (a class that Verilator made).
template <class Top>
class PlaneModelOf final : public PlaneModel {
 public:
  PlaneModelOf() {
    unit_->valid_i = 0;
    unit_.reset();
  }

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override {
    glm::vec3 unread;  // what the bus has before the first result
    glm::vec3* point = &unread;
    unit_->valid_i = 1;  // whenever the unit is ready, the next test is there
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const PlaneTest& test = tests[i];
      assert(unit_->ready_o);
      for (int k = 0; k < 3; ++k) (*point)[k] = exchange(test.direction[k]);
      for (int k = 0; k < 3; ++k) exchange(test.normal[k]);
      exchange(test.d);
      point = &points[i];
    }
    unit_->valid_i = 0;
    for (int k = 0; k < 3; ++k) (*point)[k] = exchange(0.0f);
  }

  [[nodiscard]] std::uint64_t clocks() const override { return unit_.clocks(); }

 private:
  /// One clock with `word` on the bus; returns what is on the other bus after it.
  float exchange(float word) {
    unit_->bus_i = std::bit_cast<std::uint32_t>(word);
    unit_.clock();
    return std::bit_cast<float>(unit_->bus_o);
  }

  Model<Top> unit_;
};

std::unique_ptr<PlaneModel> make_model(Arith arith) {
  if (arith == Arith::kStructural) return std::make_unique<PlaneModelOf<Vhit_test_unit_structural>>();
  return std::make_unique<PlaneModelOf<Vhit_test_unit_behavioural>>();
}

}  // namespace

RtlPlaneUnit::RtlPlaneUnit(Arith arith) : model_(make_model(arith)) {}

RtlPlaneUnit::~RtlPlaneUnit() = default;

void RtlPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  if (!tests.empty()) model_->intersect(tests, points);
}

std::uint64_t RtlPlaneUnit::clocks() const { return model_->clocks(); }

}  // namespace raygate
