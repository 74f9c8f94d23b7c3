// CPU intersector: intersects rays with triangles without a hit-test unit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "host/intersect/intersector.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// Traces rays with a common origin in packets of 64, others one by one. Hit points have the bits
/// of the hit-test unit. They are computed only for nearest hits.
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

/// Computes hit points and their errors, bit for bit as set_point does, and writes them to `hits`.
class PointWriter {
 public:
  static constexpr std::size_t kMost = 256;  ///< maximum of count()

  /// `is_common`: all rays start at one point. Hits of one primitive then share its plane, which is
  /// cached for later hits.
  PointWriter(const Bvh& bvh, std::span<const Ray> rays, bool is_common, std::span<NearestHit> hits)
      : bvh_(bvh), rays_(rays), is_common_(is_common), hits_(hits) {}

  /// Returns the number of hits that were added but not written yet.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Returns the number of all hits that were written.
  [[nodiscard]] std::uint64_t written() const { return written_; }

  /// Adds the hit of ray `number` with a primitive; write() writes it. count() must be below kMost.
  RAYGATE_INLINE void add(std::uint32_t number, std::uint32_t primitive) {
    std::uint16_t unused = 0xFFFF;
    std::uint16_t& plane = is_common_ ? last_[primitive % kPlanes] : unused;
    // Branchless, because a branch would be unpredictable.
    const bool known = (plane < planes_) & (primitives_[plane % kPlanes] == primitive);
    plane = static_cast<std::uint16_t>(known ? plane : planes_);
    primitives_[planes_] = primitive;
    firsts_[planes_] = number;
    planes_ += known ? 0 : 1;
    numbers_[count_] = number;
    plane_of_[count_++] = plane;
  }

  /// Writes the points of the hits that were added.
  void write();

  /// If the primitive's plane is cached, writes the points of eight consecutive rays, starting at
  /// `number`, that hit the primitive. Returns whether the plane is cached.
  template <Vectors kCode>
  [[nodiscard]] RAYGATE_INLINE bool write_group(std::uint32_t number, std::uint32_t primitive,
                                                const FloatLanes (&directions)[3]) {
    const std::size_t plane = last_[primitive % kPlanes];
    if (kCode == Vectors::kBaseline || plane >= computed_ || primitives_[plane] != primitive) {
      return false;
    }
    const float* const words = words_[plane];
    const FloatLanes n[3] = {spread<FloatLanes>(words[0]), spread<FloatLanes>(words[1]),
                             spread<FloatLanes>(words[2])};
    const IntLanes largest = spread<IntLanes>(largest_field({words[0], words[1], words[2]}));
    const auto hit = [&](std::size_t i) RAYGATE_BODY { return &hits_[number + i]; };
    write_lanes(n, spread<FloatLanes>(words[3]), largest, directions, hit);
    written_ += kLanes;
    return true;
  }

 private:
  /// Computes the hit point from the plane (n, d) and direction of each lane, and writes it to
  /// hit(lane). `largest` is the largest exponent field of n.
  template <class Floats, class Hit>
  static RAYGATE_INLINE void write_lanes(const Floats (&n)[3], const Floats& d,
                                         const IntOf<Floats>& largest, const Floats (&direction)[3],
                                         const Hit& hit) {
    const Floats v = 0.0f + ((n[0] * direction[0] + n[1] * direction[1]) + n[2] * direction[2]);
    Floats columns[4];
    for (int k = 0; k < 3; ++k) {
      const Floats p = d * direction[k] / v;
      columns[k] = p == p ? p : float_of(IntOf<Floats>{} + 0x7FC00000);
    }
    columns[3] = float_of(point_error_of(bits_in(d), bits_in(v), grazing_of(largest, bits_in(v))));
    static_assert(offsetof(NearestHit, point_error) ==
                  offsetof(NearestHit, point) + 3 * sizeof(float));
    for (std::size_t first = 0; first < kLanesOf<Floats>; first += kQuad) {
      FloatQuad rows[kQuad];
      for (int k = 0; k < 4; ++k) {
        rows[k] = load<FloatQuad>(reinterpret_cast<const float*>(&columns[k]) + first);
      }
      transpose(rows);
      for (std::size_t i = 0; i < kQuad; ++i) std::memcpy(&hit(first + i)->point, &rows[i], 16);
    }
  }

  static constexpr std::size_t kPlanes = 2 * kMost;

  const Bvh& bvh_;
  const std::span<const Ray> rays_;
  const bool is_common_;
  const std::span<NearestHit> hits_;
  std::uint64_t written_ = 0;
  std::size_t planes_ = 0, computed_ = 0;  // number of planes, and of planes with words
  std::size_t count_ = 0;
  std::uint32_t primitives_[kPlanes + 1] = {};  // primitive of each plane
  std::uint32_t firsts_[kPlanes + 1];           // a ray that hits each plane
  // Indices of planes have 16 bits, because compilers assume that 8-bit types alias any variable.
  std::uint16_t last_[kPlanes] = {};  // by hash of a primitive: its last plane
  std::uint32_t numbers_[kMost];      // hits to write: their rays and planes
  std::uint16_t plane_of_[kMost];
  float words_[kPlanes + kQuad][4];  // N and d of planes, computed four by four
};

// The two searches of CpuIntersector. The caller initialises `hits` to misses and counts misses.

/// Intersects rays with a common origin in packets.
void trace_packets(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                   std::span<NearestHit> hits, IntersectCounters& counters);

/// Intersects rays with any origins one by one.
void trace_single_rays(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                       std::span<NearestHit> hits, IntersectCounters& counters);

/// Replaces `hits` by all hits of `ray` with t < t_max, nearest first, then by triangle index.
/// `t_max` is as in is_before(). The direction must be scaled; a direction that is not usable hits
/// nothing. `point` and `point_error` of the hits are not valid.
void all_hits(const Bvh& bvh, const ExactRay& ray, double t_max, std::vector<NearestHit>& hits,
              RayWork& work);

}  // namespace raygate
