#include "host/picture/view_pyramid.h"

#include <array>
#include <vector>

namespace raygate {
namespace {

/// The pyramid from the eye through a part of the picture.
class ViewPyramid {
 public:
  ViewPyramid(const Camera& camera, double x0, double y0, double x1, double y1)
      : eye_(camera.eye()) {
    const glm::dvec3 corners[4] = {camera.direction(x0, y0), camera.direction(x1, y0),
                                   camera.direction(x1, y1), camera.direction(x0, y1)};
    for (int k = 0; k < 4; ++k) {
      inwards_[k] = glm::normalize(glm::cross(corners[k], corners[(k + 1) % 4]));
    }
  }

  /// Whether the box is surely outside one of the planes. Directions are floats: they turn by less
  /// than 2^-23, and the planes by little more.
  [[nodiscard]] bool is_beside(const glm::vec3& low, const glm::vec3& high) const {
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
  const ViewPyramid pyramid(camera, (tile.x0 - margin) / film.width,
                            (tile.y0 - margin) / film.height, (tile.x1 + margin) / film.width,
                            (tile.y1 + margin) / film.height);
  std::vector<Bvh::Ref> waiting{bvh.root()};
  while (!waiting.empty()) {
    const Bvh::Ref ref = waiting.back();
    waiting.pop_back();
    if (ref.count > 0) return true;
    const Bvh::Node& node = bvh.nodes()[ref.first];
    for (int side = 0; side < 2; ++side) {
      const bool is_absent = node.bounds[0][side].x > node.bounds[1][side].x;
      if (is_absent || pyramid.is_beside(node.bounds[0][side], node.bounds[1][side])) continue;
      waiting.push_back(node.child[side]);
    }
  }
  return false;
}

}  // namespace raygate
