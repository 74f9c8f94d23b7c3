// Reference exact unit: the answers of hw/exact in C++, and the clocks that they take.
#pragma once

#include "host/exact/exact.h"

namespace raygate {

/// What the exact unit is asked of a ray: whether it hits `triangle`, how that hit compares, or
/// both. Coordinates, direction, corners and a limit as exact.h wants them.
struct ExactRequest {
  enum class Against { kNothing, kLimit, kOther };  ///< as exact_pkg::against_e

  Ray ray;
  Corners triangle{};
  bool asks_hit =
      true;  ///< or else it is known to be hit; needed where there is nothing to compare
  Against against = Against::kNothing;
  float limit = 1.0f;  ///< with kLimit: positive, finite
  Corners other{};     ///< with kOther: another triangle that is hit
};

struct ExactAnswer {
  bool hit = false;
  int order = 0;   ///< of a hit, the sign of t - limit or t - t(other); 0 where it was not asked
  int clocks = 0;  ///< from the clock that takes the request to the first that has the answer
};

/// The unit with digits of `width` bits, 24 to 60.
[[nodiscard]] ExactAnswer decide(const ExactRequest& request, int width = 48);

}  // namespace raygate
