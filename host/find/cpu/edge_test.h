// The inside test in float32: three edge planes against eight rays.
#pragma once

#include <span>

#include "host/find/unit/hit_tester.h"

namespace raygate {

/// What float32 is sure of about eight rays and one record; all other lanes are in doubt.
struct EdgeVerdict {
  LaneMask hit = 0;   ///< surely hit, ahead of the origin
  LaneMask miss = 0;  ///< surely not
};

/// `verdicts[i]` is the verdict on the bundle's records[i], for its lanes (no bits elsewhere).
///
/// With U = I . E, computed as (x + y) + z: a hit has all three U of the sign of d (exact.cpp says
/// why), so an edge surely on the other side is a miss, and three surely on this side are a hit.
/// This asks for less than two edges of opposite sign do, and never calls what is behind the
/// origin a hit. d = 0 is a miss.
void test_edges(const RayBundle& bundle, std::span<EdgeVerdict> verdicts);

}  // namespace raygate
