// Reference exact unit: hw/exact in C++, with its latency.
#pragma once

#include "host/exact/exact.h"

namespace raygate {

/// A request to the exact unit: whether a ray hits `triangle`, how that hit compares, or both.
/// Values have the ranges of exact.h.
struct ExactRequest {
  enum class Against { kNothing, kLimit, kOther };  ///< as exact_pkg::against_e

  Ray ray;
  Corners triangle{};
  bool asks_hit = true;  ///< false: it is known to be hit; must be true if there is no comparison
  Against against = Against::kNothing;
  float limit = 1.0f;  ///< with kLimit: positive, finite
  Corners other{};     ///< with kOther: another triangle that is hit
};

struct ExactAnswer {
  bool hit = false;
  int order = 0;   ///< sign of t - limit or t - t(other) of a hit; 0 without comparison
  int clocks = 0;  ///< from the clock that takes the request to the first that has the answer
};

/// Returns the answer of a unit with digits of `width` bits, 24 to 60.
[[nodiscard]] ExactAnswer decide(const ExactRequest& request, int width = 48);

}  // namespace raygate
