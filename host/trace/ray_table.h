// Ray table: a block of rays in the scene file's coordinates, converted for an intersector.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "host/exact/exact.h"

namespace raygate {

/// Some rays in a row.
struct RayTable {
  std::uint64_t first = 0;     ///< number of the first ray, from 0
  std::vector<Ray> rays;       ///< relative to the scene's origin, scaled
  std::vector<float> limits;   ///< of the scaled rays; +infinity: none
  std::vector<int> exponents;  ///< t of the file's ray is 2^exponent times t of the scaled one
  std::uint64_t rounded = 0;   ///< rays that binary32 does not hold as they were given

  void clear(std::uint64_t its_first);

  /// Adds the ray P = origin + t direction, in the file's coordinates, whose hits have 0 < t <
  /// limit. The direction need not have length 1; one that is 0 hits nothing. Origins become
  /// binary32 after the scene's origin has been subtracted; directions and limits, too. Gives what
  /// is wrong with the ray, "found ..., expected ...", and then adds nothing; or nullptr.
  const char* add(const glm::dvec3& origin, const glm::dvec3& direction, double limit,
                  const glm::dvec3& scene_origin);
};

}  // namespace raygate
