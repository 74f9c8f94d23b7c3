// Decision audit: counts the wrong decisions of a variant's hit tests on a picture's camera rays.
#pragma once

#include "host/bvh/bvh.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/lab/results.h"
#include "host/scene/camera.h"
#include "host/variants/variant_table.h"

namespace raygate::lab {

/// What the rays through all pixels' centres meet by `tester`, which computes as `variant` says,
/// against exact arithmetic on the same triangles:
///
///   tests                     ray against polygon, as the traversal led to them
///   doubts                    of these, left to exact arithmetic: never wrong
///   wrong_hits, wrong_misses  decided otherwise than exact arithmetic does
///   rays, wrong_rays          those whose first polygon is another than the exact one
///   hits                      of the other rays: so many are in the errors
///   t_ulp, point_ulp          errors of t and of P's worst coordinate in units of float32's last
///   place: median (p50),
///                             99th percentile, largest; 0 where there are none. No t_ulp where
///                             modules are brought along, for t is the reference model's
[[nodiscard]] Row audit_decisions(const Bvh& bvh, const Camera& camera, int width, int height,
                                  const Variant& variant, HitTester& tester);

}  // namespace raygate::lab
