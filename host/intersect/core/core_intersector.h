// Core intersector, which sends rays to a ray core (hardware that traverses the BVH), and the
// interface of ray cores. A core returns hits and, if it is not exact, doubts.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// A ray for the core.
struct CoreRay {
  static constexpr std::uint32_t kNoTriangle = MemoryImage::kNoTriangle;

  Ray ray;  ///< the direction scaled (see is_scaled)
  /// Positive. Only hits with exact t < t_max count; +infinity: no limit.
  float t_max = std::numeric_limits<float>::infinity();
  std::uint32_t skip_id = kNoTriangle;    ///< index of a triangle whose hits do not count
  std::uint32_t source_id = kNoTriangle;  ///< index of the triangle that the ray leaves
  std::uint32_t tag = 0;                  ///< returned with all results of the ray
  bool any_hit = false;                   ///< the search ends at the first sure hit
};

/// A result of the core. Results of different rays interleave; kEnd is the last result of a ray.
struct CoreResult {
  enum class Kind : std::uint8_t {
    kEnd = 0,  ///< end of traversal, with the nearest sure hit if there is one
    /// A triangle that may be hit and nearer than the sure hit; exact arithmetic must decide.
    kDoubt = 1,
  };

  enum class Error : std::uint8_t {
    kNone = 0,
    kMemory = 1,     ///< a memory read returned an error
    kCycle = 2,      ///< a node is below itself, or deeper than MemoryImage::kMostDepth
    kDirection = 3,  ///< the direction is not scaled
    kAbort = 4,      ///< aborted by the user
  };

  static constexpr std::uint32_t kNoT = 31;

  Kind kind = Kind::kEnd;
  bool found = false;     ///< kEnd: there is a sure hit, so `triangle` to `point` are valid
  std::uint32_t tag = 0;  ///< CoreRay::tag
  std::uint32_t triangle = CoreRay::kNoTriangle;  ///< the triangle's line in memory
  float t = 0.0f;              ///< kEnd: fewer than 2^t_error floats from the exact t
  std::uint32_t t_error = 0;   ///< kNoT: `t` and `point` are unknown and set to 0
  glm::vec3 point{0.0f};       ///< kEnd: the hit point minus the origin, as the core computes it
  std::uint32_t tests = 0;     ///< kEnd: triangles tested
  Error error = Error::kNone;  ///< kEnd: if not kNone, only `tag` and `line` are valid
  std::uint32_t line = 0;      ///< kEnd with kMemory: the line read
};

/// Statistics of a core since its construction. `tests` counts triangles tested, `depth_doubts`
/// sure hits reported as doubts, because their order is not sure. Clocks are 0 without simulation.
struct CoreCounters : HitCounters {
  std::uint64_t rays = 0;
  std::uint64_t nodes = 0;      ///< node lines processed by the box unit
  std::uint64_t overflows = 0;  ///< rays that used the shared stack
  std::uint64_t lines = 0;      ///< lines read from memory
  std::uint64_t waits = 0;      ///< clocks in which memory did not accept a request
};

/// Traces rays through a memory image. The nearest hit of a ray in exact arithmetic is the sure hit
/// of its kEnd or one of its doubts; with any_hit, any hit may be reported instead. After an error
/// a ray has no valid hit. Doubts can differ between cores and, because of memory timing, between
/// runs. A core that is_exact has no doubts.
class CoreUnit {
 public:
  virtual ~CoreUnit() = default;

  /// Traces the rays and appends their results to `results`. `lines` is MemoryImage::lines().
  virtual void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
                     std::vector<CoreResult>& results) = 0;

  [[nodiscard]] virtual CoreCounters counters() const = 0;
  [[nodiscard]] virtual bool is_exact() const { return false; }
};

/// Resolves the core's doubts by exact arithmetic on the host. The host also computes the point of
/// each nearest hit, with the same bits as in other intersectors. Throws InputError if the core
/// reports Error::kMemory (a line that does not exist) or Error::kCycle.
class CoreIntersector : public Intersector {
 public:
  /// `bvh` must outlive this; `image` is its memory image. A thread's intersectors may share a
  /// core.
  CoreIntersector(const Bvh& bvh, std::shared_ptr<const MemoryImage> image,
                  std::shared_ptr<CoreUnit> core)
      : Intersector({.wants_sources = true}),
        bvh_(bvh),
        image_(std::move(image)),
        core_(std::move(core)) {}

  [[nodiscard]] IntersectCounters counters() const override;

 private:
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits) override;

  const Bvh& bvh_;
  std::shared_ptr<const MemoryImage> image_;
  std::shared_ptr<CoreUnit> core_;
  IntersectCounters counters_;
  std::vector<CoreRay> sent_;
  std::vector<CoreResult> results_;
};

}  // namespace raygate
