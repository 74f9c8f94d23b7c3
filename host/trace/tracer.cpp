#include "host/trace/tracer.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "host/base/threads.h"
#include "host/intersect/cpu/all_hits.h"

namespace raygate {
namespace {

/// What one thread works with.
struct Desk {
  std::unique_ptr<Intersector> intersector;  ///< none where all hits are asked for
  RayTable block;
  std::vector<NearestHit> nearest;
  std::vector<RayWork> work;
  std::vector<RayHit> found;
  std::string rows;
};

/// One row for each ray: its nearest hit, or some hit.
void find_one(Desk& desk, Hits asked) {
  const std::size_t count = desk.block.rays.size();
  desk.nearest.assign(count, {});
  desk.work.assign(count, {});
  RayQuery query{.t_max = desk.block.limits, .work = desk.work};
  if (asked == Hits::kAny) query.any_hit_before = desk.block.limits;
  desk.intersector->intersect(desk.block.rays, query, desk.nearest);
  for (std::uint32_t i = 0; i < count; ++i) {
    desk.found.push_back({i, desk.nearest[i], desk.work[i].doubts});
  }
}

void find_all(Desk& desk, const Bvh& bvh) {
  for (std::uint32_t i = 0; i < desk.block.rays.size(); ++i) {
    RayWork work;
    all_hits(bvh, desk.block.rays[i], desk.block.limits[i], desk.nearest, work);
    for (const NearestHit& hit : desk.nearest) desk.found.push_back({i, hit, work.doubts});
  }
}

}  // namespace

TraceCounts trace(const ReadRays& read, Hits asked, const Bvh& bvh, const HitTable& answers,
                  const IntersectorFactory& make_intersector, unsigned threads,
                  const std::function<void(std::string_view)>& write,
                  const std::function<bool()>& keep_going) {
  constexpr std::size_t kBlock = std::size_t{1} << 14;
  TraceCounts counts;
  std::vector<Desk> desks(threads);
  while (keep_going()) {
    std::size_t busy = 0;
    while (busy < desks.size() && read(kBlock, desks[busy].block)) ++busy;
    if (busy == 0) break;
    for_each_on_threads(static_cast<int>(threads), busy, [&](std::size_t i) {
      Desk& desk = desks[i];
      desk.found.clear();
      desk.rows.clear();
      if (asked == Hits::kAll) {
        find_all(desk, bvh);
      } else {
        if (!desk.intersector) desk.intersector = make_intersector();
        find_one(desk, asked);
      }
      answers.append(desk.block, desk.found, desk.rows);
    });
    for (std::size_t i = 0; i < busy; ++i) {
      const Desk& desk = desks[i];
      write(desk.rows);
      counts.rays += desk.block.rays.size();
      counts.rows += desk.found.size();
      counts.rounded += desk.block.rounded;
      counts.hits +=
          static_cast<std::uint64_t>(std::ranges::count_if(desk.found, [](const RayHit& found) {
            return found.hit.primitive != NearestHit::kNone;
          }));
    }
  }
  return counts;
}

}  // namespace raygate
