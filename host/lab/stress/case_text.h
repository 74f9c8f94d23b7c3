// A case as a line of text, as test/regressions.txt has it.
#pragma once

#include <string>
#include <vector>

#include "host/lab/stress/shot.h"

namespace raygate::lab {

/// One ray and the triangles it is tested against: what a failure comes down to.
struct Case {
  glm::vec3 origin{0.0f}, direction{0.0f};
  std::vector<Corners> triangles;
};

/// Words in hex: origin, direction, the triangles' vertices.
[[nodiscard]] std::string to_text(const Case& failure);

/// And back; std::invalid_argument where the line is no case.
[[nodiscard]] Case case_from(const std::string& line);

/// As something to shoot at.
[[nodiscard]] Shot shot_of(const Case& failure);

}  // namespace raygate::lab
