// Sets of rays, and the ray tracers that trace them: raygate and Embree.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/exact/exact.h"
#include "host/intersect/intersector.h"
#include "host/scene/scene.h"

namespace raygate::lab {

/// Rays to trace. Neighbouring rays are coherent.
struct RaySet {
  std::string name;
  std::vector<Ray> rays;
  bool common_origin = false;  ///< all rays begin at rays[0].origin
  std::vector<float> t_max;    ///< empty, or one per ray: only hits with t < t_max[i] count
  bool any_hit = false;        ///< the query asks only whether there is a hit

  /// Finds the hits of hits.size() rays, starting at ray `first`.
  void find(Intersector& intersector, std::size_t first, std::span<NearestHit> hits) const {
    const std::span found = std::span(rays).subspan(first, hits.size());
    RayQuery query{.common_origin = common_origin};
    if (!t_max.empty()) query.t_max = std::span(t_max).subspan(first, hits.size());
    if (any_hit) query.any_hit_before = query.t_max;
    query.with_points = !any_hit;
    intersector.nearest(found, query, hits);
  }
};

/// Returns three sets of rays for an image of size x size pixels that shows the whole scene. Set
/// `camera` has camera rays, `light` occlusion rays from a point light, above and to the right of
/// the eye, to just before the hits of the camera rays. `scattered` rays leave these hits in random
/// directions of diffuse reflection. Camera rays are ordered as in the renderer: in tiles of 128 x
/// 128 pixels, squares of 8 x 8, and blocks of 4 x 2. The other rays have the same order.
[[nodiscard]] std::vector<RaySet> ray_sets(const Scene& scene, int size);

/// Hits, one per ray.
struct Found {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kSome = kNone - 1;  ///< for any_hit: some triangle

  explicit Found(std::size_t rays) : triangle(rays), t(rays) {}

  std::vector<std::uint32_t> triangle;
  std::vector<float> t;  ///< of the nearest hit; unspecified for a miss and for any_hit
};

/// A ray tracer with a scene loaded.
class Peer {
 public:
  explicit Peer(std::string by) : name(std::move(by)) {}
  virtual ~Peer() = default;
  /// Prepares for a set of rays; not timed.
  virtual void prepare(const RaySet& set) = 0;
  /// Traces the prepared set on one thread; timed.
  virtual void run(Found& found) = 0;

  const std::string name;
};

/// Returns this project's `cpu` engine as a peer.
[[nodiscard]] std::unique_ptr<Peer> make_raygate(const Scene& scene);

/// Returns peers of Embree 3: single rays, packets of 8 and 16, and streams, each in default and
/// robust mode, with high-quality BVHs.
[[nodiscard]] std::vector<std::unique_ptr<Peer>> make_embrees(const Scene& scene);
/// Returns the same peers of Embree 4. Throws InputError if `file` is not Embree 4's library.
[[nodiscard]] std::vector<std::unique_ptr<Peer>> make_embrees4(const Scene& scene,
                                                               const std::string& file);

}  // namespace raygate::lab
