#include "host/render/wavefront.h"

#include <algorithm>
#include <array>

#include "host/render/stopwatch.h"

namespace raygate {

Wavefront::Wavefront(const Bvh& bvh, HitTester& tester)
    : bvh_(bvh), tester_(tester), nearest_(bvh) {}

void Wavefront::trace(const glm::vec3& origin, std::span<const glm::vec3> directions,
                      RecordCache& records, std::span<const float> limits) {
  Stopwatch watch;
  nearest_.reset(directions.size(), limits);
  make_packets(origin, directions, limits);
  for (;;) {
    collect(directions, records);
    seconds_.traverse += watch.lap();
    if (batch_.empty()) return;
    results_.clear();
    tester_.test(batch_, results_);
    seconds_.hit += watch.lap();
    merge(origin, directions);
    const double before = seconds_.doubt;
    seconds_.doubt = nearest_.counters().seconds;
    seconds_.hit += watch.lap() - (seconds_.doubt - before);
  }
}

/// Each eight rays make one packet, or, where they point into several octants, one for each.
void Wavefront::make_packets(const glm::vec3& origin, std::span<const glm::vec3> directions,
                             std::span<const float> limits) {
  packets_.clear();
  active_.clear();
  for (std::size_t first = 0; first < directions.size(); first += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, directions.size() - first);
    LaneMask left = 0;
    for (std::size_t lane = 0; lane < count; ++lane) {
      if (is_usable(directions[first + lane])) left |= 1u << lane;
    }
    while (left != 0) {
      const int octant = octant_of(directions[first + std::countr_zero(left)]);
      active_.push_back(static_cast<std::uint32_t>(packets_.size()));
      auto& traversal = packets_
                            .emplace_back(Packet{PacketTraversal(bvh_, octant),
                                                 static_cast<std::uint32_t>(first)})
                            .traversal;
      for (LaneMask lanes = left; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        const glm::vec3& direction = directions[first + lane];
        if (octant_of(direction) != octant) continue;
        traversal.set_ray(lane, origin, direction);
        if (!limits.empty()) traversal.set_cutoff(lane, limits[first + lane]);
        left &= ~(1u << lane);
      }
    }
  }
}

/// Sends every packet to its next leaf and writes the tests found there into the batch. Packets
/// that are through leave the active ones.
void Wavefront::collect(std::span<const glm::vec3> directions, RecordCache& records) {
  batch_.clear();
  std::size_t kept = 0;
  for (const std::uint32_t index : active_) {
    Packet& packet = packets_[index];
    const auto visit = packet.traversal.next_leaf();
    if (!visit) continue;
    active_[kept++] = index;
    RayBundle& bundle = batch_.emplace_back();
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::size_t ray = std::min(packet.first_ray + std::size_t(lane), directions.size() - 1);
      for (int k = 0; k < 3; ++k) bundle.direction[k][lane] = directions[ray][k];
    }
    bundle.records = records.leaf(visit->first, visit->count);
    bundle.record_count = visit->count;
    bundle.first_tag = visit->first;
    bundle.lanes = visit->lanes;
  }
  active_.resize(kept);
}

void Wavefront::merge(const glm::vec3& origin, std::span<const glm::vec3> directions) {
  const auto offer = [&](const auto& report) {
    Packet& packet = packets_[active_[report.bundle]];
    const std::uint32_t ray = packet.first_ray + report.lane;
    if (nearest_.offer(ray, {origin, directions[ray]}, report)) {
      packet.traversal.set_cutoff(static_cast<int>(report.lane), nearest_[ray].t.high);
    }
  };
  for (const SureHit& hit : results_.hits) offer(hit);
  for (const Doubt& doubt : results_.doubts) offer(doubt);
}

}  // namespace raygate
