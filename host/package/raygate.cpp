#include "host/package/raygate.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "host/bvh/bvh.h"
#include "host/exact/ieee_floats.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/scene/scene.h"
#include "host/trace/hit_table.h"
#include "host/trace/ray_table.h"

namespace raygate {
namespace {

glm::vec3 vector(const Tracer::Point& p) { return {p[0], p[1], p[2]}; }

/// Returns a temporary scene from which the BVH is built.
Scene scene_of(std::span<const Tracer::Triangle> triangles) {
  Scene scene;
  scene.positions.reserve(3 * triangles.size());
  scene.triangles.resize(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 position = vector(triangles[i][k]);
      if (!(std::abs(position.x) <= kMostCoordinate && std::abs(position.y) <= kMostCoordinate &&
            std::abs(position.z) <= kMostCoordinate)) {
        throw std::invalid_argument("triangle " + std::to_string(i) +
                                    ": found a corner that is not finite or beyond 2^126, "
                                    "expected coordinates of magnitude at most 2^126");
      }
      scene.triangles[i].vertices[k] = static_cast<std::uint32_t>(scene.positions.size());
      scene.positions.push_back(position);
    }
  }
  return scene;
}

RayTable block_of(std::span<const Tracer::Ray> rays) {
  RayTable block;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const char* const wrong =
        block.add(glm::dvec3(vector(rays[i].origin)), glm::dvec3(vector(rays[i].direction)),
                  rays[i].limit, glm::dvec3(0.0));
    if (wrong != nullptr) {
      throw std::invalid_argument("ray " + std::to_string(i) + ": " + wrong);
    }
  }
  return block;
}

void require_room(std::size_t rays, std::size_t room) {
  if (rays != room) throw std::invalid_argument("expected room for as many answers as rays");
}

}  // namespace

struct Tracer::Tree {
  Tree(const Scene& scene, int threads) : bvh(scene, threads) {}

  [[nodiscard]] Hit answer(const RayTable& block, std::size_t i, const NearestHit& hit) const {
    if (hit.primitive == NearestHit::kNone) return {};
    const HitPoint place = hit_point_of(block.exact_ray(i), bvh.corners_of(hit.primitive));
    return {bvh.triangle_of(hit.primitive), std::ldexp(place.t, block.exponents[i]), place.u,
            place.v};
  }

  [[nodiscard]] std::vector<NearestHit> find(const RayTable& block, bool any) const {
    std::vector<NearestHit> hits(block.rays.size());
    RayQuery query{.t_max = block.limits, .exact_rays = block.exact_rays};
    CpuIntersector intersector(bvh);
    if (any) {
      query.any_hit_before = block.limits;
      intersector.occluded(block.rays, query, hits);
    } else {
      intersector.nearest(block.rays, query, hits);
    }
    return hits;
  }

  Bvh bvh;
};

Tracer::Tracer(std::span<const Triangle> triangles, int threads) {
  constexpr std::size_t kMost = ((std::size_t{1} << 31) - 1) / 3;
  const IeeeFloats guard;
  require_ieee_floats();
  if (triangles.size() > kMost) {
    throw std::invalid_argument("found " + std::to_string(triangles.size()) +
                                " triangles, expected at most " + std::to_string(kMost));
  }
  tree_ = std::make_unique<const Tree>(scene_of(triangles), threads);
}
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;
Tracer& Tracer::operator=(Tracer&&) noexcept = default;

void Tracer::nearest(std::span<const Ray> rays, std::span<Hit> hits) const {
  const IeeeFloats guard;
  require_room(rays.size(), hits.size());
  const RayTable block = block_of(rays);
  const std::vector<NearestHit> found = tree_->find(block, false);
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = tree_->answer(block, i, found[i]);
}

void Tracer::any(std::span<const Ray> rays, std::span<std::uint8_t> is_hit) const {
  const IeeeFloats guard;
  require_room(rays.size(), is_hit.size());
  const std::vector<NearestHit> found = tree_->find(block_of(rays), true);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    is_hit[i] = found[i].primitive == NearestHit::kNone ? 0 : 1;
  }
}

std::vector<Tracer::Hit> Tracer::all(const Ray& ray) const {
  const IeeeFloats guard;
  const RayTable block = block_of({&ray, 1});
  std::vector<NearestHit> found;
  RayWork work;
  all_hits(tree_->bvh, block.exact_ray(0), block.limits[0], found, work);
  std::vector<Hit> hits;
  hits.reserve(found.size());
  for (const NearestHit& hit : found) hits.push_back(tree_->answer(block, 0, hit));
  return hits;
}

}  // namespace raygate
