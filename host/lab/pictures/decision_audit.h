// How wrong a variant's hit tests are, for the camera's rays of a picture.
#pragma once

#include <cstdint>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/lab/results.h"
#include "host/lab/variants/variant_table.h"
#include "host/scene/camera.h"

namespace raygate::lab {

/// Median, 99th percentile and largest of some errors; 0 where there are none.
struct ErrorSummary {
  double p50 = 0.0, p99 = 0.0, max = 0.0;
};

/// What the rays through all pixels' centres met, against exact arithmetic on the same triangles.
struct DecisionAudit {
  std::uint64_t tests = 0;         ///< ray against polygon, as the tree's way led to them
  std::uint64_t doubts = 0;        ///< of these, left to exact arithmetic: never wrong
  std::uint64_t wrong_hits = 0;    ///< said to be hits, and are misses
  std::uint64_t wrong_misses = 0;  ///< said to be misses, and are hits
  std::uint64_t rays = 0;
  std::uint64_t wrong_rays = 0;  ///< whose first polygon is another than the exact one
  /// Of the other rays' hits, in units of float32's last place: t, and P's worst coordinate.
  ErrorSummary t_ulp, point_ulp;
  std::uint64_t hits = 0;  ///< so many rays are in the errors

  /// A column for each member.
  [[nodiscard]] Row row() const;
};

/// Traces one ray for each pixel with `tester`, which computes as `variant` says.
[[nodiscard]] DecisionAudit audit_decisions(const Bvh& bvh, const Camera& camera, int width,
                                            int height, const Variant& variant, HitTester& tester);

}  // namespace raygate::lab
