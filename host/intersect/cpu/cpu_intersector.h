// CPU intersector: intersects rays with triangles without a hit-test unit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/intersect/intersector.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// Traces rays with a common origin in packets of 64, others one by one. P has the bits of the
/// hit-test unit and is computed once for each nearest hit.
class CpuIntersector : public Intersector {
 public:
  /// `bvh` must outlive this object.
  explicit CpuIntersector(const Bvh& bvh) : Intersector({.takes_exact_rays = true}), bvh_(bvh) {}

  [[nodiscard]] IntersectCounters counters() const override { return counters_; }

 protected:
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits) override;

 private:
  const Bvh& bvh_;
  IntersectCounters counters_;
};

/// Computes P and its error with the bits of set_point, and writes them to the hits of a query.
class PointWriter {
 public:
  static constexpr std::size_t kMost = 256;

  /// `is_common`: all rays start at one point, so that hits of one primitive share its plane.
  PointWriter(const Bvh& bvh, std::span<const Ray> rays, bool is_common, std::span<NearestHit> hits)
      : bvh_(bvh), rays_(rays), is_common_(is_common), hits_(hits) {}

  /// Number of hits that were added and not written.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Number of all hits that were written.
  [[nodiscard]] std::uint64_t written() const { return written_; }

  /// Adds the hit of a ray with a primitive. At most kMost are added before they are written.
  RAYGATE_INLINE void add(std::uint32_t number, std::uint32_t primitive) {
    std::uint16_t unused = 0xFFFF;
    std::uint16_t& plane = is_common_ ? last_[primitive % kMost] : unused;
    // Branchless, as a branch would be unpredictable.
    const bool known = (plane < planes_) & (primitives_[plane % kMost] == primitive);
    plane = static_cast<std::uint16_t>(known ? plane : planes_);
    primitives_[planes_] = primitive;
    firsts_[planes_] = number;
    planes_ += known ? 0 : 1;
    numbers_[count_] = number;
    plane_of_[count_++] = plane;
  }

  /// Writes the points of the hits that were added.
  void write();

 private:
  const Bvh& bvh_;
  const std::span<const Ray> rays_;
  const bool is_common_;
  const std::span<NearestHit> hits_;
  std::uint64_t written_ = 0;
  std::size_t planes_ = 0, count_ = 0;
  std::uint32_t primitives_[kMost + 1] = {};  // by plane, with a ray that hits it
  std::uint32_t firsts_[kMost + 1];
  // Numbers of planes have 16 bits, as bytes might alias any other variable.
  std::uint16_t last_[kMost] = {};  // by hash: the last plane of a primitive
  std::uint32_t numbers_[kMost];    // of rays, with their planes
  std::uint16_t plane_of_[kMost];
  float words_[kMost][4];  // of planes: N and d
};

// The two searches of CpuIntersector. `hits` are initialised to misses; misses are not counted.

/// Intersects rays of one origin in packets.
void trace_packets(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                   std::span<NearestHit> hits, IntersectCounters& counters);

/// Intersects rays of any origins one by one.
void trace_single_rays(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                       std::span<NearestHit> hits, IntersectCounters& counters);

/// Replaces `hits` by all hits of `ray` with t < t_max, nearest first, then by triangle index.
/// `t_max` is positive; +infinity: no limit. The direction must be scaled, or is not usable and
/// hits nothing. `point` and `point_error` of the hits are not valid.
void all_hits(const Bvh& bvh, const ExactRay& ray, float t_max, std::vector<NearestHit>& hits,
              RayWork& work);

}  // namespace raygate
