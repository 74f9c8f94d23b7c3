// Oracle: finds exact results by brute force in integers. Shares no code with the renderer.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/lab/stress/cases.h"

namespace raygate::lab {

/// The exact result for one ray and one triangle.
struct Verdict {
  bool hit = false;
  bool tie = false;   ///< the ray meets the line of an edge exactly: the tie-break decides
  double t = 0.0;     ///< of a hit; relative error at most 2^-50
  double sine = 0.0;  ///< of a hit: sine of the angle between ray and plane, as accurate
};

struct Truth {
  std::vector<Verdict> verdicts;  ///< by ray, then by triangle
  /// For each ray the triangles that it hits, nearest first, exactly; then by index.
  std::vector<std::vector<std::uint32_t>> orders;
  /// There is another hit at equal distance, or the tie-break was used.
  std::vector<bool> nearest_tied;

  /// Returns the triangle that a ray hits first.
  [[nodiscard]] std::optional<std::uint32_t> nearest(std::size_t ray) const {
    return orders[ray].empty() ? std::nullopt : std::optional(orders[ray].front());
  }
};

/// Computes the results by definition: all coordinates are integer multiples of a power of two, so
/// the determinants are integers. With A, B, C the vertices minus the origin, a ray hits if D = A .
/// (B x C) is not 0, and I . (A x B), I . (B x C), I . (C x A) have its sign. If one of the three
/// is 0, its sign is that of the first non-zero component of the cross product, as for a direction
/// tilted by (e, e^2, e^3). A direction that is zero or not finite hits nothing.
[[nodiscard]] Truth find_truth(const Shot& shot);

}  // namespace raygate::lab
