#include "host/find/cpu/cpu_finder.h"

#include <algorithm>
#include <cassert>

#include "host/base/stopwatch.h"
#include "host/find/cpu/cone_search.h"
#include "host/find/cpu/ray_search.h"

namespace raygate {

void CpuFinder::find(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits) {
  assert(hits.size() == rays.size());
  Stopwatch watch;
  for (NearestHit& hit : hits) hit.slot = NearestHit::kNone;  // the rest has no meaning
  std::ranges::fill(search.work, RayWork{});
  if (search.common_origin && search.culling && !rays.empty()) {
    ConeSearch(bvh_, counters_).trace(rays, search, hits);
  } else {
    RaySearch(bvh_, counters_).trace(rays, search, hits);
  }
  counters_.hit_tests += watch.lap();
}

}  // namespace raygate
