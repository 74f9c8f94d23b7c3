// Reference model of how the ray core makes polygon records (triangle_test).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "host/exact/exact.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// A record computed in binary32, with larger bounds than those of make_record. d is NaN if its
/// sign is not sure, or if N or d are too inaccurate for a hit.
struct SetUpRecord {
  PolygonRecord record;
  std::uint32_t normal_error = 0;    ///< number of bits that cancelled in N, unless d is NaN
  std::uint32_t distance_error = 0;  ///< likewise in d
};

/// Returns the record of triangle_test, bit for bit, for any floats including NaN and infinities.
[[nodiscard]] SetUpRecord set_up(const glm::vec3& origin, const Corners& triangle);

/// Returns whether a hit is sure (set_up_pkg::is_good_hit). `grazing` is HitDistance::error.
[[nodiscard]] bool is_good_hit(const SetUpRecord& set_up, std::uint32_t grazing);

/// Returns e such that fewer than 2^e floats lie between t of a good hit and the exact t
/// (set_up_pkg::t_error_exponent).
[[nodiscard]] std::uint32_t t_error_exponent(const SetUpRecord& set_up, std::uint32_t grazing);

}  // namespace raygate
