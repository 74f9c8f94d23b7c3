#include "host/render/tiles.h"

#include <array>

#include "host/bvh/traversal.h"

namespace raygate {
namespace {

/// The frustum from the eye through a part of the image.
class TileFrustum {
 public:
  TileFrustum(const Camera& camera, const Film& film, const PixelRect& tile, double margin)
      : eye_(camera.eye()) {
    const double x0 = (tile.x0 - margin) / film.width, y0 = (tile.y0 - margin) / film.height,
                 x1 = (tile.x1 + margin) / film.width, y1 = (tile.y1 + margin) / film.height;
    const glm::dvec3 corners[4] = {camera.direction(x0, y0), camera.direction(x1, y0),
                                   camera.direction(x1, y1), camera.direction(x0, y1)};
    for (int k = 0; k < 4; ++k) {
      inwards_[k] = glm::normalize(glm::cross(corners[k], corners[(k + 1) % 4]));
    }
  }

  /// Returns whether the box is surely outside one of the frustum's planes. Rounding to float turns
  /// directions and planes by less than 2^-22; the limit of 2^-18 covers this.
  [[nodiscard]] bool is_outside(const glm::vec3& low, const glm::vec3& high) const {
    for (const glm::dvec3& normal : inwards_) {
      glm::dvec3 farthest_in;
      for (int k = 0; k < 3; ++k) {
        farthest_in[k] = static_cast<double>(normal[k] > 0.0 ? high[k] : low[k]) - eye_[k];
      }
      if (glm::dot(normal, farthest_in) < -0x1p-18 * glm::length(farthest_in)) return true;
    }
    return false;
  }

 private:
  glm::dvec3 eye_;
  std::array<glm::dvec3, 4> inwards_;
};

}  // namespace

bool may_see_anything(const Bvh& bvh, const Camera& camera, const Film& film, const PixelRect& tile,
                      double margin) {
  if (!camera.is_pinhole()) return true;
  const TileFrustum frustum(camera, film, tile, margin);
  const auto boxes = [&](const Bvh::Node& node) {
    LaneMask met = 0;
    for (int i = 0; i < Bvh::kWidth; ++i) {
      const auto [low, high] = node.box(i);
      if (low.x <= high.x && !frustum.is_outside(low, high)) met |= 1u << i;
    }
    return met;
  };
  return any_leaf(bvh, boxes, [](const Bvh::Child&) { return true; });
}

bool may_see_box(const glm::vec3& low, const glm::vec3& high, const Camera& camera,
                 const Film& film, const PixelRect& tile, double margin) {
  return !camera.is_pinhole() || !TileFrustum(camera, film, tile, margin).is_outside(low, high);
}

}  // namespace raygate
