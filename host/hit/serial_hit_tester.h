// Hit tests by a unit that knows planes only: the paper's hardware and the software around it.
#pragma once

#include <memory>
#include <vector>

#include "host/hit/hit_tester.h"
#include "host/hit/plane_unit.h"

namespace raygate {

/// The unit finds where a ray meets a polygon's plane; whether that is inside the polygon, and
/// which hit is nearest, is found here, in software, as in the paper.
class SerialHitTester : public HitTester {
 public:
  /// Which pairs go through the unit.
  enum class Order {
    kEdgesFirst,   ///< those that the edge planes do not rule out: a miss costs no clocks
    kPlanesFirst,  ///< every one, as in the paper
  };

  explicit SerialHitTester(std::unique_ptr<PlaneUnit> unit, Order order = Order::kEdgesFirst);

  void test(std::span<const RayBundle> batch, HitResults& results) override;
  [[nodiscard]] HitCounters counters() const override;
};

}  // namespace raygate
