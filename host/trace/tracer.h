// Tracer: reads rays, intersects them on all threads and writes rows in the rays' order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "host/bvh/bvh.h"
#include "host/intersect/intersector.h"
#include "host/trace/hit_table.h"
#include "host/trace/ray_table.h"

namespace raygate {

/// Statistics of a run.
struct TraceCounts {
  std::uint64_t rays = 0, hits = 0;
  std::uint64_t rounded = 0;  ///< number of rays that were rounded
};

/// Replaces a block by the next rays, at most the given number; returns false at the end.
using ReadRays = std::function<bool(std::size_t, RayTable&)>;

/// Finds the nearest hit of each ray of a block, or the first hit found if `any`. `work` is empty
/// or receives the work of each ray.
void find_hits(const Bvh& bvh, Intersector& intersector, const RayTable& block, bool any,
               std::span<NearestHit> hits, std::span<RayWork> work = {});

/// Reads all rays and passes the rows to `write`, block by block in the order of the rays. At most
/// `threads` blocks are in memory, with about 1 MB of rows each, plus the rows of one ray.
/// Exceptions of `read` and `write` propagate to the caller.
[[nodiscard]] TraceCounts trace(const ReadRays& read, Hits asked, const Bvh& bvh,
                                const HitTable& answers, const IntersectorFactory& make_intersector,
                                unsigned threads,
                                const std::function<void(std::string_view)>& write);

}  // namespace raygate
