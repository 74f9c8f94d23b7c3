// Reference model of hw/exact in C++, including latency.
#pragma once

#include "host/exact/exact.h"

namespace raygate {

/// A request to the exact unit: does a ray hit `triangle`, how does the hit's t compare with a
/// limit or with the t of another hit, or both. Values have the ranges stated in exact.h.
struct ExactRequest {
  enum class Against { kNothing, kLimit, kOther };  ///< as in exact_pkg::against_e

  Ray ray;
  FloatCorners triangle{};
  bool asks_hit = true;  ///< false: the triangle is known to be hit; requires a comparison
  Against against = Against::kNothing;
  float limit = 1.0f;    ///< for kLimit: positive, finite
  FloatCorners other{};  ///< for kOther: another triangle that is hit
};

struct ExactAnswer {
  bool hit = false;
  int order = 0;   ///< sign of t - limit or t - t(other) of a hit; 0 without comparison
  int clocks = 0;  ///< from the clock that accepts the request to the first clock with the answer
};

/// Returns the answer of a unit with digits of `width` bits, 24 to 60.
[[nodiscard]] ExactAnswer decide(const ExactRequest& request, int width = 48);

}  // namespace raygate
