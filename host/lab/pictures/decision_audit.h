// Decision audit: counts wrong decisions of a variant's hit tests on an image's camera rays.
#pragma once

#include "host/bvh/bvh.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/lab/results.h"
#include "host/scene/camera.h"
#include "host/variants/variant_table.h"

namespace raygate::lab {

/// Compares the hits of rays through all pixel centres, found by `tester`, which uses the
/// arithmetic of `variant`, with exact arithmetic on the same triangles. Columns:
///
///   tests                     (ray, polygon) pairs tested by the traversal
///   doubts                    tests resolved by exact arithmetic: never wrong
///   wrong_hits, wrong_misses  decisions that differ from exact arithmetic
///   rays, wrong_rays          all rays, and those whose nearest polygon is wrong
///   hits                      hits of the other rays, over which errors are computed
///   t_ulp, point_ulp          errors of t and of P's worst coordinate in float32 ulps: median
///   (p50),
///                             99th percentile, largest; 0 without hits. No t_ulp for user-supplied
///                             modules, whose t is the reference model's
[[nodiscard]] Row audit_decisions(const Bvh& bvh, const Camera& camera, int width, int height,
                                  const Variant& variant, HitTester& tester);

}  // namespace raygate::lab
