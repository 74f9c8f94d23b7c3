// Public acceptance tests of watertightness, for engines and other ray tracers' hit tests.
//
// nomiss: from the Vulkan conformance tests (ray_tracing_pipeline.watertightness.nomiss). A square
//   of two triangles is refined to N by points in random triangles, at random heights. Every ray of
//   a grid along -z (256 x 256 for 65,536 triangles) must hit.
// singlehit: from the same tests. A closed fan of up to 1,024 triangles, and rays from its axis to
//   its centre and to the middle of every inner edge. The original counts repeated hits of one
//   triangle as duplicates; here, more than one hit is a duplicate.
// sphere: from Embree (tutorials/verify, watertight). Random rays from around the centre of a
//   sphere far from the origin must hit.
// edges, vertices: as in Woop, Benthin and Wald 2013. Rays from inside a sphere at its edges and
//   vertices must hit.
//
// The random numbers and the sphere's triangles differ from the originals.
#pragma once

#include <vector>

#include "host/lab/results.h"

namespace raygate::lab {

struct WatertightOptions {
  int triangles = 65536;  ///< of a mesh of nomiss and singlehit, and number of rays; at least 4
  int seeds = 10;         ///< number of meshes of nomiss
};

/// Runs all tests. Returns a row for each test and hit test: "test", "by", "exact" (whether it
/// claims to be exact), "rays", "escapes" and "double_hits" (null for hit tests that find only the
/// nearest hit).
[[nodiscard]] std::vector<Row> watertight_rows(const WatertightOptions& asked);

/// Returns whether a row has neither escapes nor double hits.
[[nodiscard]] bool is_watertight(const Row& row);

}  // namespace raygate::lab
