// The triangles that stand on one, or cut it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/base/lanes.h"
#include "host/base/vectors.h"
#include "host/exact/exact.h"

namespace raygate {

/// Triangles that come close to one triangle inside its borders: what stands on it, or cuts it.
class Overlaps {
 public:
  void add(std::uint32_t primitive, const Corners& triangle);
  [[nodiscard]] std::size_t size() const { return slots_.size(); }

  /// Calls visit(primitive) for the triangles whose boxes are within `reach` of the point on each
  /// axis, until it says true; whether it did.
  template <Vectors kCode = Vectors::kBaseline, class Visit>
  [[nodiscard]] RAYGATE_INLINE bool any_near(const glm::vec3& point, float reach,
                                             const Visit& visit) const {
    const glm::vec3 from = point - reach, to = point + reach;
    const std::uint32_t* primitives = slots_.data();
    for (const Boxes& boxes : boxes_) {
      IntLanes touches = IntLanes{} - 1;
      for (int k = 0; k < 3; ++k) {
        FloatLanes low, high;
        load_lanes(boxes.low[k], low);
        load_lanes(boxes.high[k], high);
        touches &= (low <= to[k]) & (high >= from[k]);
      }
      for (LaneMask near = sign_mask<kCode>(touches); near != 0; near &= near - 1) {
        if (visit(primitives[std::countr_zero(near)])) return true;
      }
      primitives += kLanes;
    }
    return false;
  }

 private:
  /// Eight boxes; those that are not there are empty.
  struct Boxes {
    float low[3][kLanes], high[3][kLanes];
  };

  std::vector<Boxes> boxes_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace raygate
