// Sets of rays, and the ray tracers that trace them: raygate and Embree.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/exact/exact.h"
#include "host/intersect/intersector.h"
#include "host/scene/scene.h"

namespace raygate::lab {

/// Rays to trace, in an order in which neighbours belong together.
struct RaySet {
  std::string name;
  std::vector<Ray> rays;
  bool common_origin = false;  ///< all rays begin at rays[0].origin
  std::vector<float> t_max;    ///< empty, or one a ray: only hits with t < t_max[i] count
  bool any_hit = false;        ///< whether there is a hit is all that is asked for

  /// What an intersector is asked about `count` of the rays from `first` on.
  [[nodiscard]] RayQuery query(std::size_t first, std::size_t count) const {
    RayQuery query{.common_origin = common_origin};
    if (!t_max.empty()) query.t_max = std::span(t_max).subspan(first, count);
    if (any_hit) query.any_hit_before = query.t_max;
    return query;
  }
};

/// The rays of a picture of size x size pixels with the whole scene in view: `camera`; `light`,
/// from a point light, above the eye and to its right, to just before what the camera sees: does
/// anything lie between; and `scattered` from there, in random directions as of diffuse light. The
/// camera's are in tiles of 128 x 128 pixels, in them squares of 8 x 8, in them blocks of 4 x 2, as
/// the renderer has them; so is the order of the others.
[[nodiscard]] std::vector<RaySet> ray_sets(const Scene& scene, int size);

/// What was found, one a ray.
struct Found {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kSome = kNone - 1;  ///< any_hit: some triangle

  explicit Found(std::size_t rays) : triangle(rays), t(rays) {}

  std::vector<std::uint32_t> triangle;
  std::vector<float> t;  ///< of the nearest hit; unspecified for a miss and for any_hit
};

/// A ray tracer with a scene loaded.
class Peer {
 public:
  virtual ~Peer() = default;
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Makes ready for a set of rays; not timed.
  virtual void prepare(const RaySet& set) = 0;
  /// Traces the prepared set on one thread; timed.
  virtual void run(Found& found) = 0;
};

/// This project's `cpu` engine.
[[nodiscard]] std::unique_ptr<Peer> make_raygate(const Scene& scene);

/// Embree 3, single rays, packets of 8 and 16 and streams, each in its default and its robust mode,
/// with trees of high quality; none if this was built without Embree.
[[nodiscard]] std::vector<std::unique_ptr<Peer>> make_embrees(const Scene& scene);
/// The same of Embree 4, a shared library. Throws InputError where `file` is none.
[[nodiscard]] std::vector<std::unique_ptr<Peer>> make_embrees4(const Scene& scene,
                                                               const std::string& file);

}  // namespace raygate::lab
