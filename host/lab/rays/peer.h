// What `lab rays` times: one way of tracing a set of rays.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/exact/exact.h"
#include "host/scene/scene.h"

namespace raygate::lab {

/// Rays to trace, in an order in which neighbours belong together.
struct RaySet {
  std::string name;
  std::vector<Ray> rays;
  bool common_origin = false;  ///< all rays begin at rays[0].origin
  std::vector<float> limits;   ///< empty, or one a ray: only hits with t < limits[i] count
  bool any_hit = false;        ///< whether there is a hit is all that is asked for
};

/// What was found, one a ray.
struct Found {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kSome = kNone - 1;  ///< any_hit: some triangle

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

/// Embree 3, single rays and eight coherent ones at once, each in its default and its robust mode;
/// none where this was built without Embree.
[[nodiscard]] std::vector<std::unique_ptr<Peer>> make_embrees(const Scene& scene);

}  // namespace raygate::lab
