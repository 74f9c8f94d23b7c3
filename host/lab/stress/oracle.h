// The truth about a shot, by brute force in integers. Shares no code with the renderer.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "host/lab/stress/shot.h"

namespace raygate::lab {

/// The truth about one ray and one triangle.
struct Verdict {
  bool hit = false;
  bool tie = false;   ///< the ray meets an edge's line exactly: only the tie-break decides
  double t = 0.0;     ///< of a hit, off by 2^-50 of itself at most
  double sine = 0.0;  ///< of a hit: of the angle between ray and plane, as good
};

struct Truth {
  std::vector<Verdict> verdicts;  ///< ray by ray, triangle by triangle
  /// For each ray the triangles it hits, near before far, exactly; of those equally far the lower
  /// index first.
  std::vector<std::vector<std::uint32_t>> orders;
  std::vector<bool> nearest_tied;  ///< another is as far, or the tie-break had a say

  /// The triangle that a ray hits first.
  [[nodiscard]] std::optional<std::uint32_t> nearest(std::size_t ray) const {
    return orders[ray].empty() ? std::nullopt : std::optional(orders[ray].front());
  }
};

/// The definition: all coordinates are whole multiples of a power of two, so the determinants are
/// integers. With A, B, C the vertices minus the origin, a ray hits where
///     D = A . (B x C) is not 0, and I . (A x B), I . (B x C), I . (C x A) have its sign;
/// where one of the three is 0, its sign is that of the first component of the cross product that
/// is not 0, as for a direction tilted by (e, e^2, e^3). A direction that is zero or not finite
/// hits nothing. 128 bits where they are enough, GMP's integers elsewhere.
[[nodiscard]] Truth find_truth(const Shot& shot);

}  // namespace raygate::lab
