// Public acceptance tests of watertightness, by the engines and by other people's hit tests.
//
// nomiss: the Vulkan conformance tests' (ray_tracing_pipeline.watertightness.nomiss). A square of
//   two triangles is refined to N by points in random triangles, at random heights; every ray of a
//   grid along -z (256 x 256 for 65,536 triangles) must hit.
// singlehit: theirs, too. A closed fan of N triangles; rays from its axis to its centre and to the
//   middle of every inner edge. Its duplicates are hits of one triangle; here, more hits than one.
// sphere: Embree's (tutorials/verify, watertight): random rays from around the centre of a sphere,
//   far from the origin, must hit.
// edges, vertices: as Woop, Benthin and Wald 2013 argue: rays from inside a sphere at its edges and
//   vertices must hit.
//
// The random numbers and the sphere's triangles are ours, not theirs.
#pragma once

#include <vector>

#include "host/lab/results.h"

namespace raygate::lab {

struct WatertightOptions {
  int triangles = 65536;  ///< of a mesh of nomiss and singlehit, and rays at it; at least 4
  int seeds = 10;         ///< meshes of nomiss
};

/// Runs all tests. Returns a row for each test and hit test: "test", "by", "exact" (whether it
/// promises to be exact), "rays", "escapes" and "double_hits", null for hit tests that find only
/// the nearest hit.
[[nodiscard]] std::vector<Row> watertight_rows(const WatertightOptions& asked);

/// Whether a row has neither escapes nor double hits.
[[nodiscard]] bool is_watertight(const Row& row);

}  // namespace raygate::lab
