#include "host/package/raygate.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "host/bvh/bvh.h"
#include "host/exact/ieee_floats.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/scene/scene.h"
#include "host/trace/hit_table.h"
#include "host/trace/ray_table.h"
#include "host/trace/tracer.h"

namespace raygate {
namespace {

glm::dvec3 vector(const Tracer::Point& p) { return {p[0], p[1], p[2]}; }

/// Returns the scene from which the BVH is built.
Scene scene_of(std::span<const Tracer::Triangle> triangles) {
  std::vector<glm::dvec3> corners;
  corners.reserve(3 * triangles.size());
  bool are_floats = true;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const Tracer::Point& corner : triangles[i]) {
      corners.push_back(vector(corner));
      are_floats = are_floats && is_binary32(corners.back());
      if (is_finite(corners.back()) && largest(corners.back()) <= kMostCoordinate) continue;
      throw std::invalid_argument("triangle " + std::to_string(i) +
                                  ": found a corner that is not finite or beyond 2^126, expected "
                                  "coordinates of magnitude at most 2^126");
    }
  }
  Scene scene;
  scene.triangles.resize(triangles.size());
  if (!are_floats) scene.origin = exact_origin(corners);
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    scene.triangles[i / 3].vertices[i % 3] = i;
    scene.add_vertex(corners[i]);
  }
  scene.drop_zero_rests();
  return scene;
}

RayTable block_of(std::span<const Tracer::Ray> rays, const glm::dvec3& origin) {
  RayTable block;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const char* const wrong =
        block.add(vector(rays[i].origin), vector(rays[i].direction), rays[i].limit, origin);
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
  Tree(Scene&& given, int threads) : scene(std::move(given)), bvh(scene, threads) {
    scene.positions = {};
    if (bvh.is_binary32()) scene.triangles = {};
  }

  [[nodiscard]] Hit answer(const RayTable& block, std::size_t i, const NearestHit& hit) const {
    if (hit.primitive == NearestHit::kNone) return {};
    const HitPoint place = hit_point_of(block.exact_ray(i), bvh.corners_of(hit.primitive));
    return {bvh.triangle_of(hit.primitive), std::ldexp(place.t, block.exponents[i]), place.u,
            place.v};
  }

  [[nodiscard]] std::vector<NearestHit> find(const RayTable& block, bool any) const {
    std::vector<NearestHit> hits(block.rays.size());
    CpuIntersector intersector(bvh);
    find_hits(bvh, intersector, block, any, hits);
    return hits;
  }

  Scene scene;  // referenced by the BVH
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
  const RayTable block = block_of(rays, tree_->scene.origin);
  const std::vector<NearestHit> found = tree_->find(block, false);
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = tree_->answer(block, i, found[i]);
}

void Tracer::any(std::span<const Ray> rays, std::span<std::uint8_t> is_hit) const {
  const IeeeFloats guard;
  require_room(rays.size(), is_hit.size());
  const std::vector<NearestHit> found = tree_->find(block_of(rays, tree_->scene.origin), true);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    is_hit[i] = found[i].primitive == NearestHit::kNone ? 0 : 1;
  }
}

std::vector<Tracer::Hit> Tracer::all(const Ray& ray) const {
  const IeeeFloats guard;
  const RayTable block = block_of({&ray, 1}, tree_->scene.origin);
  std::vector<NearestHit> found;
  RayWork work;
  all_hits(tree_->bvh, block.exact_ray(0), block.limits[0], found, work);
  std::vector<Hit> hits;
  hits.reserve(found.size());
  for (const NearestHit& hit : found) hits.push_back(tree_->answer(block, 0, hit));
  return hits;
}

}  // namespace raygate
