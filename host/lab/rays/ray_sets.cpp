// Rays of an image: from the camera, from a light, and scattered.
#include <cmath>
#include <random>

#include "host/film/film.h"
#include "host/lab/rays/rays.h"
#include "host/scene/camera.h"
#include "host/scene/view.h"

namespace raygate::lab {
namespace {

/// Visits blocks of width x height that cover `rect`, row by row.
template <class Visit>
void for_blocks(const PixelRect& rect, int width, int height, const Visit& visit) {
  for (int y = rect.y0; y < rect.y1; y += height) {
    for (int x = rect.x0; x < rect.x1; x += width) visit(PixelRect{x, y, x + width, y + height});
  }
}

/// Returns a point above and to the right of the eye; both offsets are a quarter of |eye|.
glm::vec3 light_of(const Scene& scene) {
  const Camera camera = front_camera(scene, 1.0);
  const glm::dvec3 eye(camera.eye());
  return glm::vec3(eye + 0.25 * glm::length(eye) * (camera.right() + camera.up()));
}

RaySet camera_rays(const Scene& scene, int size) {
  const Camera camera = front_camera(scene, 1.0);
  RaySet set{"camera", {}, true, {}, false};
  for_blocks({0, 0, size, size}, 128, 128, [&](const PixelRect& tile) {
    for_blocks(tile, 8, 8, [&](const PixelRect& square) {
      for_blocks(square, 4, 2, [&](const PixelRect& block) {
        for_blocks(block, 1, 1, [&](const PixelRect& pixel) {
          set.rays.push_back(
              {camera.eye(), camera.direction((pixel.x0 + 0.5) / size, (pixel.y0 + 0.5) / size)});
        });
      });
    });
  });
  return set;
}

RaySet light_rays(const Scene& scene, const RaySet& camera, const Found& found) {
  RaySet set{"light", {}, true, {}, true};
  const glm::vec3 light = light_of(scene);
  for (std::size_t i = 0; i < camera.rays.size(); ++i) {
    if (found.triangle[i] == Found::kNone) continue;
    const auto& [origin, direction] = camera.rays[i];
    const glm::dvec3 point = glm::dvec3(origin) + double(found.t[i]) * glm::dvec3(direction);
    const glm::dvec3 way = point - glm::dvec3(light);
    const glm::vec3 scaled = scaled_direction(way);
    set.rays.push_back({light, scaled});
    set.t_max.push_back(
        static_cast<float>(0.9999 * glm::length(way) / glm::length(glm::dvec3(scaled))));
  }
  return set;
}

RaySet scattered_rays(const Scene& scene, const RaySet& camera, const Found& found) {
  RaySet set{"scattered", {}, false, {}, false};
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss;
  for (std::size_t i = 0; i < camera.rays.size(); ++i) {
    if (found.triangle[i] == Found::kNone) continue;
    const auto& [origin, direction] = camera.rays[i];
    const auto& v = scene.triangles[found.triangle[i]].vertices;
    const glm::dvec3 a(scene.positions[v[0]]), b(scene.positions[v[1]]), c(scene.positions[v[2]]);
    glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
    if (glm::dot(normal, glm::dvec3(direction)) > 0.0) normal = -normal;
    glm::dvec3 way = glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
    way = glm::normalize(way + 1.0000001 * normal);  // cosine-distributed
    set.rays.push_back({glm::vec3(glm::dvec3(origin) + 0.9999 * found.t[i] * glm::dvec3(direction)),
                        scaled_direction(way)});
  }
  return set;
}

}  // namespace

std::vector<RaySet> ray_sets(const Scene& scene, int size) {
  RaySet camera = camera_rays(scene, size);
  Found seen(camera.rays.size());
  const auto raygate = make_raygate(scene);
  raygate->prepare(camera);
  raygate->run(seen);
  RaySet light = light_rays(scene, camera, seen), scattered = scattered_rays(scene, camera, seen);
  return {std::move(camera), std::move(light), std::move(scattered)};
}

}  // namespace raygate::lab
