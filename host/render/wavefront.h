// Many rays in flight: while some wait for their hit tests, others walk the tree.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/accel/packet_traversal.h"
#include "host/hit/hit_tester.h"
#include "host/render/nearest_hits.h"
#include "host/render/record_cache.h"

namespace raygate {

/// Traces a few hundred to a thousand rays at once. In each round every packet of eight goes on to
/// its next leaf; the leaves' tests together are one batch for the tester; its answers shorten the
/// rays. The unit sees few large batches, the host's memory a few packets.
class Wavefront {
 public:
  /// Where the time went.
  struct Seconds {
    double traverse = 0.0;  ///< boxes, and records made on first touch
    double hit = 0.0;       ///< in HitTester::test, and merging its reports
    double doubt = 0.0;     ///< exact arithmetic about what they leave open
  };

  Wavefront(const Bvh& bvh, HitTester& tester);

  /// Finds the nearest hit of each ray from `origin`, whose records `records` holds. Directions
  /// scaled (see scaled_direction); each eight in a row should go about the same way. With
  /// `limits`, one a ray, only hits with t < limits[i] count (see NearestHits::reset). Directions
  /// that are zero or not finite hit nothing.
  void trace(const glm::vec3& origin, std::span<const glm::vec3> directions, RecordCache& records,
             std::span<const float> limits = {});

  /// Of the ray directions[number] of the last trace.
  [[nodiscard]] const NearestHit& nearest(std::size_t number) const { return nearest_[number]; }

  [[nodiscard]] const Seconds& seconds() const { return seconds_; }
  [[nodiscard]] const NearestHits::Counters& counters() const { return nearest_.counters(); }

 private:
  /// Up to eight rays of one octant; lane k is ray first_ray + k.
  struct Packet {
    PacketTraversal traversal;
    std::uint32_t first_ray;
  };

  void make_packets(const glm::vec3& origin, std::span<const glm::vec3> directions,
                    std::span<const float> limits);
  void collect(std::span<const glm::vec3> directions, RecordCache& records);
  void merge(const glm::vec3& origin, std::span<const glm::vec3> directions);

  const Bvh& bvh_;
  HitTester& tester_;
  NearestHits nearest_;
  Seconds seconds_;
  // Room to work in, kept from trace to trace.
  std::vector<Packet> packets_;
  std::vector<std::uint32_t> active_;  // packets still on their way; batch_[i] is active_[i]'s
  std::vector<RayBundle> batch_;
  HitResults results_;
};

}  // namespace raygate
