// Drives a Verilated hit_test_unit: tests in, points out.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <stdexcept>

#include "host/intersect/unit/burst_unit.h"
#include "sim/model.h"
#include "sim/port_numbers.h"

namespace raygate {

/// Interface through which RtlPlaneUnit drives a simulated unit.
class PlaneModel {
 public:
  virtual ~PlaneModel() = default;
  virtual void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) = 0;
  [[nodiscard]] virtual std::uint64_t clocks() const = 0;
};

/// PlaneModel of `Top`, Verilator's class of a hit_test_unit.
template <class Top, class Numbers = Binary32Numbers>
class PlaneModelOf final : public PlaneModel {
 public:
  explicit PlaneModelOf(const Numbers& numbers = {}) : numbers_(numbers) {
    unit_->valid_i = 0;
    unit_.reset();
  }

  void intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) override {
    glm::vec3 unread;  // words on the output bus before the first result
    glm::vec3* point = &unread;
    unit_->valid_i = 1;  // a test follows whenever the unit is ready
    for (std::size_t i = 0; i < tests.size(); ++i) {
      const PlaneTest& test = tests[i];
      if (!unit_->ready_o) throw std::runtime_error("hit_test_unit: not ready for a test");
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
  /// Simulates one clock with `word` on the input bus. Returns the word then on the output bus.
  float exchange(float word) {
    unit_->bus_i = numbers_.to_word(word);
    unit_.clock();
    return numbers_.from_word(unit_->bus_o);
  }

  Numbers numbers_;
  Model<Top> unit_;
};

}  // namespace raygate
