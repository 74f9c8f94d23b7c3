// Core unit: the interface of the ray core, rays in, hits out, and doubts of a core that is not
// exact.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "host/exact/exact.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersect_counters.h"

namespace raygate {

/// A ray for the core.
struct CoreRay {
  static constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

  Ray ray;  ///< the direction scaled (see is_scaled)
  /// Positive, +infinity for none: hits at t >= limit do not count. The exact t.
  float t_max = std::numeric_limits<float>::infinity();
  std::uint32_t skip_id = kNoTriangle;    ///< a triangle that does not count, by its name
  std::uint32_t source_id = kNoTriangle;  ///< another: the one that the ray leaves
  std::uint32_t tag = 0;                  ///< comes back with all that concerns the ray
  bool any_hit = false;                   ///< the first sure hit that is found will do
  bool no_cull = false;                   ///< it enters all boxes
};

/// A word of the core about a ray. Words of several rays come mixed; a ray's end is its last one.
struct CoreResult {
  enum class Kind : std::uint8_t {
    kEnd = 0,  ///< of the walk; with the nearest sure hit, if there is one
    /// A triangle that may be hit, nearer than the sure hit: exact arithmetic must say.
    kDoubt = 1,
  };

  enum class Error : std::uint8_t {
    kNone = 0,
    kMemory = 1,     ///< memory answered a read of a line with an error
    kCycle = 2,      ///< the ray met a node twice, or one below more than MemoryImage::kMostDepth
    kDirection = 3,  ///< its direction is not scaled
    kAbort = 4,      ///< the user of the core gave it up
  };

  static constexpr std::uint32_t kNoT = 31;

  Kind kind = Kind::kEnd;
  bool found = false;     ///< kEnd: whether there is a sure hit; the next three are its
  std::uint32_t tag = 0;  ///< the ray's
  std::uint32_t triangle = CoreRay::kNoTriangle;  ///< kEnd, kDoubt: its name, its line in memory
  float t = 0.0f;                                 ///< kEnd: off by fewer than 2^t_error numbers
  std::uint32_t t_error = 0;                      ///< kNoT: t and P are not known, and 0
  glm::vec3 point{0.0f};       ///< kEnd: P in the core's own bits, relative to the origin
  std::uint32_t tests = 0;     ///< kEnd: triangles tested
  Error error = Error::kNone;  ///< kEnd: if not kNone, the ray was given up: nothing else holds
  std::uint32_t line = 0;      ///< kEnd, kMemory: one that memory lacks
};

/// What a core has done since it was made. Clocks are 0 where nothing is simulated.
struct CoreCounters {
  static constexpr std::uint64_t kSpan = 256;

  std::uint64_t rays = 0;
  std::uint64_t nodes = 0;                         ///< node lines that the box unit took
  std::uint64_t triangles = 0;                     ///< triangle lines that the set-up unit took
  std::uint64_t hits = 0, misses = 0, doubts = 0;  ///< of tests
  std::uint64_t near_ties = 0;                     ///< sure hits that leave as doubts
  std::uint64_t overflows = 0;                     ///< rays whose stack took the shared groups
  std::uint64_t lines = 0;                         ///< read from memory
  std::uint64_t waits = 0;         ///< clocks in which memory did not take what was asked for
  std::uint64_t exact_clocks = 0;  ///< of an exact core's exact unit, with a question
  /// Clocks of the busier of both units in each span of kSpan clocks: rays that keep boxes busy and
  /// rays that keep triangles busy come in turns.
  std::uint64_t busier = 0;
  /// The same if box tests had two units for the one of triangles, or the triangles' took two
  /// clocks each, and nothing else were slower.
  std::uint64_t busier_two_boxes = 0, busier_half_triangles = 0;
  std::uint64_t clocks = 0;

  CoreCounters& operator+=(const CoreCounters& other) {
    add_counters(*this, other);
    return *this;
  }
};

/// Walks rays through a memory image.
///
/// Promises: the ray's nearest hit, in exact arithmetic, is the sure hit of its end, or a triangle
/// of its doubts; with any_hit the first that is found may be in its place. A ray whose end has an
/// error has no hit that counts. What is a doubt may differ between cores, and for a core that
/// waits for memory from run to run. A core that is_exact has no doubts: the nearest hit is that of
/// its end.
class CoreUnit {
 public:
  virtual ~CoreUnit() = default;

  /// Adds what the rays give to `results`; all words of all rays. The memory holds `lines`, a
  /// MemoryImage's.
  virtual void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
                     std::vector<CoreResult>& results) = 0;

  [[nodiscard]] virtual CoreCounters counters() const = 0;
  [[nodiscard]] virtual bool is_exact() const { return false; }
};

}  // namespace raygate
