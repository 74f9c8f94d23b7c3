#include "host/scene/camera_setting.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "host/base/elementary.h"

namespace raygate {
namespace {

/// Between b (share 0) and c (share 1), with the slopes that their neighbours give.
glm::dvec3 catmull_rom(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d, double share) {
  const glm::dvec3 slope_b = 0.5 * (c - a), slope_c = 0.5 * (d - b);
  const double s = share, s2 = s * s, s3 = s2 * s;
  return (2.0 * s3 - 3.0 * s2 + 1.0) * b + (s3 - 2.0 * s2 + s) * slope_b +
         (3.0 * s2 - 2.0 * s3) * c + (s3 - s2) * slope_c;
}

}  // namespace

CameraSetting camera_at(const std::vector<CameraSetting>& path, double time, double default_fov) {
  assert(path.size() >= 2);
  const auto last = static_cast<std::ptrdiff_t>(path.size()) - 1;
  const double place = std::clamp(time, 0.0, 1.0) * static_cast<double>(last);
  const auto begin = std::min(static_cast<std::ptrdiff_t>(place), last - 1);
  const double share = place - static_cast<double>(begin);
  const auto at = [&](std::ptrdiff_t index) -> const CameraSetting& {
    return path[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(index, 0, last))];
  };
  const CameraSetting &a = at(begin - 1), &b = at(begin), &c = at(begin + 1), &d = at(begin + 2);
  CameraSetting camera;
  camera.eye = catmull_rom(a.eye, b.eye, c.eye, d.eye, share);
  camera.target = catmull_rom(a.target, b.target, c.target, d.target, share);
  if (b.fov || c.fov) {
    camera.fov = std::lerp(b.fov.value_or(default_fov), c.fov.value_or(default_fov), share);
  }
  if (b.up || c.up) {
    const glm::dvec3 y_axis(0.0, 1.0, 0.0);
    camera.up = glm::mix(glm::normalize(b.up.value_or(y_axis)),
                         glm::normalize(c.up.value_or(y_axis)), share);
  }
  return camera;
}

CameraSetting orbited(const CameraSetting& camera, double turn) {
  const glm::dvec3 up = camera.up.value_or(glm::dvec3(0.0, 1.0, 0.0)), size = glm::abs(up);
  const int axis = size.y >= size.x && size.y >= size.z ? 1 : size.z >= size.x ? 2 : 0;
  const int from = (axis + 1) % 3, to = (axis + 2) % 3;
  const auto [s, c] = sine_cosine(up[axis] < 0.0 ? -turn : turn);
  const auto rotated = [from, to, s = s, c = c](const glm::dvec3& v) {  // clang 14: not [&]
    glm::dvec3 result = v;
    result[from] = c * v[from] - s * v[to];
    result[to] = c * v[to] + s * v[from];
    return result;
  };
  CameraSetting result = camera;
  result.eye = camera.target + rotated(camera.eye - camera.target);
  if (camera.up) result.up = rotated(*camera.up);
  return result;
}

}  // namespace raygate
