// Which sides of triangles face into something closed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/bvh/bvh.h"

namespace raygate {

/// Of a triangle: which of its sides is seen from outside of what it encloses.
enum class OuterSide : std::uint8_t {
  kBoth,           ///< it is no part of a closed surface, or not surely
  kAlongNormal,    ///< that of its normal
  kAgainstNormal,  ///< the other
};

/// For each of some primitives. A closed surface is a set of these triangles that hang together by
/// their edges, each edge of just two of them, which run along it in opposite directions. Where
/// anything else of the scene is within the box around it, it counts as open.
[[nodiscard]] std::vector<OuterSide> outer_sides(const Bvh& bvh,
                                                 std::span<const std::uint32_t> primitives);

}  // namespace raygate
