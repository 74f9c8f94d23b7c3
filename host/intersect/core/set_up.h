// Reference model of the ray core's set-up unit: a triangle and an origin in, a polygon record out.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/exact/exact.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// A record with less exact words than make_record's, which runs in double: its bounds say how much
/// less. d is NaN where its sign is not sure, or N or d are too far off for a hit.
struct SetUpRecord {
  PolygonRecord record;
  std::uint32_t normal_error = 0;    ///< how many bits cancelled in N, where d is a number
  std::uint32_t distance_error = 0;  ///< likewise in d
};

/// set_up_unit in binary32, bit for bit. Takes any floats, NaN and infinities too.
[[nodiscard]] SetUpRecord set_up(const glm::vec3& origin, const Corners& triangle);

/// Whether a hit of such a record is sure: set_up_pkg::is_good_hit. `grazing` is
/// HitDistance::error.
[[nodiscard]] bool is_good_hit(const SetUpRecord& set_up, std::uint32_t grazing);

/// Fewer than 2^(this) floats lie between the t of a good hit and the exact one:
/// set_up_pkg::t_error_exponent.
[[nodiscard]] std::uint32_t t_error_exponent(const SetUpRecord& set_up, std::uint32_t grazing);

}  // namespace raygate
