#include "host/light/overlaps.h"

#include <algorithm>
#include <limits>

namespace raygate {

void Overlaps::add(std::uint32_t primitive, const Corners& triangle) {
  const auto lane = static_cast<int>(slots_.size() % kLanes);
  slots_.push_back(primitive);
  if (lane == 0) {
    Boxes& empty = boxes_.emplace_back();
    for (int k = 0; k < 3; ++k) {
      std::ranges::fill(empty.low[k], std::numeric_limits<float>::infinity());
      std::ranges::fill(empty.high[k], -std::numeric_limits<float>::infinity());
    }
  }
  for (int k = 0; k < 3; ++k) {
    boxes_.back().low[k][lane] = std::min({triangle[0][k], triangle[1][k], triangle[2][k]});
    boxes_.back().high[k][lane] = std::max({triangle[0][k], triangle[1][k], triangle[2][k]});
  }
}

}  // namespace raygate
