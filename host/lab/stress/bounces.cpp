#include "host/lab/stress/bounces.h"

#include <optional>

#include "host/lab/stress/meshes.h"
#include "host/lab/stress/subjects.h"
#include "host/scene/camera.h"

namespace raygate::lab {
namespace {

constexpr int kRays = 8, kBounces = 12;

glm::vec3 mirrored(const glm::vec3& direction, const Corners& t) {
  const glm::dvec3 n = glm::normalize(triangle_normal(t)), d(direction);
  return scaled_direction(d - 2.0 * glm::dot(d, n) * n);
}

/// Returns the primitive that the ray hits first.
std::optional<std::uint32_t> first_hit(const Bvh& bvh, const Ray& ray) {
  std::optional<std::uint32_t> best;
  for (std::uint32_t primitive = 0; primitive < bvh.primitive_count(); ++primitive) {
    const Corners& t = bvh.corners_of(primitive);
    if (!hits_triangle(ray, t)) continue;
    if (!best || compare_hits(ray, t, bvh.corners_of(*best)) < 0) best = primitive;
  }
  return best;
}

}  // namespace

void Bounces::start_anew(Random& random) {
  const double angle = random.log_uniform(1e-6, 1);
  Placement placement;
  if (angle > 1e-2 && random.one_in(2)) placement.shift = random.point() * 1e3;
  const bool boxed = random.one_in(4);
  mesh_ = boxed ? box(placement) : wedge(angle, placement);
  bvh_ = std::make_shared<Bvh>(scene_of(*mesh_));
  const glm::dvec3 start =
      boxed ? 0.8 * random.point()
            : glm::dvec3(0.7, 0.7 * std::tan(angle) * random.uniform(0.3, 0.7), 0.2);
  origin_ = glm::vec3(start + placement.shift);
  directions_.clear();
  mirrored_ = glm::vec3(0.0f);
  bounces_left_ = kBounces;
}

/// Follows one ray of the last shot to its hit and reflects it. Restarts if that is not possible.
void Bounces::bounce(Random& random) {
  const Ray ray = {origin_, directions_[random.below(kRays)]};
  const auto primitive = first_hit(*bvh_, ray);
  const NeighborClearances clearances(*bvh_);
  RaySpawner spawner(clearances);
  const auto point = primitive ? spawner.find(ray, *primitive, SpawnSide::kIncident) : std::nullopt;
  if (!point) return start_anew(random);
  mirrored_ = mirrored(ray.direction, bvh_->corners_of(*primitive));
  if (!spawner.leaves(ray, *primitive, SpawnSide::kIncident, mirrored_))
    mirrored_ = glm::vec3(0.0f);
  origin_ = *point;
}

Shot Bounces::operator()(Random& random) {
  if (bounces_left_-- <= 0) {
    start_anew(random);
  } else {
    bounce(random);
  }
  directions_.clear();
  if (mirrored_ != glm::vec3(0.0f)) directions_.push_back(mirrored_);
  while (directions_.size() < kRays) {
    // Towards edges and points near them, such as the edge between the first two side faces.
    const Corners& t = mesh_->triangles[random.below(static_cast<int>(mesh_->triangles.size()))];
    const glm::dvec3 aim =
        glm::mix(glm::dvec3(t[0]), glm::dvec3(t[random.below(3)]), random.uniform(0, 1)) +
        random.point() * random.log_uniform(1e-9, 1e-1);
    const glm::dvec3 way = aim - glm::dvec3(origin_);
    if (way != glm::dvec3(0.0)) directions_.push_back(scaled_direction(way));
  }
  Shot shot;
  shot.mesh = mesh_;
  shot.origin = origin_;
  shot.directions = directions_;
  shot.inside = true;
  return shot;
}

}  // namespace raygate::lab
