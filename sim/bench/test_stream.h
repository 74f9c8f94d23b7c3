// Tests for timing the hit-test units: random triangles, about a given fraction of which is hit.
#pragma once

#include <cstdint>
#include <vector>

#include "host/intersect/unit/burst_unit.h"

namespace raygate {

/// A batch of bursts with the records it points to, and the same tests for the paper's unit.
struct TestStream {
  std::vector<PolygonRecord> records;
  std::vector<RayBundle> bundles;  ///< one ray each
  std::vector<PlaneTest> plane_tests;
};

/// Returns `bursts` random rays with `tests` triangles each, whose corners are anywhere in a box of
/// 4 x 4 x 4 in front of the origin. A ray is aimed at a point of the box; with probability `aimed`
/// (0 to 1), independently for each test, the triangle is moved until its middle is on the ray.
/// Without aiming some 8 % are hit.
[[nodiscard]] TestStream random_stream(int bursts, int tests, double aimed);

}  // namespace raygate
