// Tests for timing the hit-test units: random triangles, about a given fraction of which is hit.
#pragma once

#include <cstdint>
#include <vector>

#include "host/intersect/unit/burst_unit.h"

namespace raygate {

/// A batch of bursts with the records to which they point, and the same tests for the paper's unit.
struct TestStream {
  std::vector<PolygonRecord> records;
  std::vector<RayBundle> bundles;  ///< one ray each
  std::vector<PlaneTest> plane_tests;
};

/// Returns `bursts` random rays with `tests` triangles each. The corners are random points of a
/// 4 x 4 x 4 box in front of the origin. A ray goes to a random point of the box. With probability
/// `aimed` (0 to 1), independently for each test, the triangle is moved so that its centre is on
/// the ray. Without such moves, about 8 % of the tests are hits.
[[nodiscard]] TestStream random_stream(int bursts, int tests, double aimed);

}  // namespace raygate
