#include "host/trace/tracer.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/base/threads.h"
#include "host/intersect/cpu/cpu_intersector.h"

namespace raygate {
namespace {

// Number of bytes of rows at which a thread stops until its rows are written.
constexpr std::size_t kManyRows = std::size_t{1} << 20;

/// State of one thread: a block of rays, and its rows until they are written.
struct Desk {
  std::unique_ptr<Intersector> intersector;  ///< null for Hits::kAll
  RayTable block;
  std::size_t next = 0;  ///< first ray without rows
  std::vector<NearestHit> nearest;
  std::vector<RayWork> work;
  std::vector<RayHit> found;
  std::string rows;
  std::uint64_t hits = 0;  ///< number of hits in `rows`

  void write_found(const HitTable& answers) {
    answers.append(block, found, rows);
    hits += static_cast<std::uint64_t>(std::ranges::count_if(
        found, [](const RayHit& ray) { return ray.hit.primitive != NearestHit::kNone; }));
    found.clear();
  }
};

/// Makes one row for each ray: its nearest hit, or any hit.
void find_one(Desk& desk, Hits asked, const Bvh& bvh, const HitTable& answers) {
  const std::size_t count = desk.block.rays.size();
  desk.nearest.assign(count, {});
  desk.work.assign(count, {});
  if (!desk.intersector->traits().takes_exact_rays) desk.block.round();
  find_hits(bvh, *desk.intersector, desk.block, asked == Hits::kAny, desk.nearest, desk.work);
  for (std::uint32_t i = 0; i < count; ++i) {
    desk.found.push_back({i, desk.nearest[i], desk.work[i].doubts});
  }
  desk.write_found(answers);
  desk.next = count;
}

/// Makes rows of all hits until they take about kManyRows bytes: a block's rows may exceed memory.
void find_all(Desk& desk, const Bvh& bvh, const HitTable& answers) {
  for (; desk.next < desk.block.rays.size() && desk.rows.size() < kManyRows; ++desk.next) {
    RayWork work;
    all_hits(bvh, desk.block.exact_ray(desk.next), desk.block.limits[desk.next], desk.nearest,
             work);
    const auto ray = static_cast<std::uint32_t>(desk.next);
    for (const NearestHit& hit : desk.nearest) desk.found.push_back({ray, hit, work.doubts});
    desk.write_found(answers);
  }
}

}  // namespace

void find_hits(const Bvh& bvh, Intersector& intersector, const RayTable& block, bool any,
               std::span<NearestHit> hits, std::span<RayWork> work) {
  std::vector<float> t_max(hits.size());  // intersectors compare with limits in binary32
  std::ranges::transform(block.limits, t_max.begin(), float_above);
  RayQuery query{
      .t_max = t_max, .exact_rays = block.exact_rays, .work = work, .with_points = false};
  if (any) query.any_hit_before = t_max;
  intersector.nearest(block.rays, query, hits);
  std::vector<NearestHit> before;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].primitive == NearestHit::kNone) continue;
    const ExactRay ray = block.exact_ray(i);
    const double limit = block.limits[i];
    if (is_before(bvh, ray, hits[i], limit)) continue;
    RayWork ignored;
    all_hits(bvh, ray, limit, before, ignored);
    hits[i] = before.empty() ? NearestHit{} : before[0];
  }
}

TraceCounts trace(const ReadRays& read, Hits asked, const Bvh& bvh, const HitTable& answers,
                  const IntersectorFactory& make_intersector, unsigned threads,
                  const std::function<void(std::string_view)>& write) {
  constexpr std::size_t kBlock = std::size_t{1} << 14;
  TraceCounts counts;
  std::vector<Desk> desks(threads);
  std::size_t first = 0, busy = 0;  // desks [first, busy) have rows to find or to write
  while (true) {
    if (first == busy) {
      first = busy = 0;
      while (busy < desks.size() && read(kBlock, desks[busy].block)) desks[busy++].next = 0;
      if (busy == 0) break;
    }
    for_each_on_threads(static_cast<int>(threads), busy - first, [&](std::size_t i) {
      Desk& desk = desks[first + i];
      if (asked == Hits::kAll) {
        find_all(desk, bvh, answers);
      } else {
        if (!desk.intersector) desk.intersector = make_intersector();
        find_one(desk, asked, bvh, answers);
      }
    });
    for (; first < busy; ++first) {
      Desk& desk = desks[first];
      write(desk.rows);
      desk.rows.clear();
      counts.hits += std::exchange(desk.hits, 0);
      if (desk.next < desk.block.rays.size()) break;
      counts.rays += desk.block.rays.size();
      counts.rounded += desk.block.rounded;
    }
  }
  return counts;
}

}  // namespace raygate
