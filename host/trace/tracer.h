// Tracer: reads rays, intersects them on all threads and writes rows in the rays' order.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "host/bvh/bvh.h"
#include "host/intersect/intersector.h"
#include "host/trace/hit_table.h"
#include "host/trace/ray_table.h"

namespace raygate {

/// Statistics of a run.
struct TraceCounts {
  std::uint64_t rays = 0, hits = 0;
  std::uint64_t rounded = 0;  ///< number of rays that are not as given
};

/// Replaces a block by at most the given number of next rays; returns false at the end.
using ReadRays = std::function<bool(std::size_t, RayTable&)>;

/// Reads all rays and passes the rows to `write`, block by block in the order of the rays. At most
/// `threads` blocks are in memory, with about 1 MB of rows each, plus the rows of one ray.
/// Exceptions of `read` and `write` end it. `keep_going` is called between blocks.
[[nodiscard]] TraceCounts trace(const ReadRays& read, Hits asked, const Bvh& bvh,
                                const HitTable& answers, const IntersectorFactory& make_intersector,
                                unsigned threads,
                                const std::function<void(std::string_view)>& write,
                                const std::function<bool()>& keep_going);

}  // namespace raygate
