// Embree peers: common code for Embree 3 and 4, which differ only in their query functions.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "host/lab/rays/rays.h"

namespace raygate::lab {

/// Calls X with each function that builds a scene.
#define RAYGATE_EMBREE_FUNCTIONS(X) \
  X(rtcNewDevice)                   \
  X(rtcReleaseDevice)               \
  X(rtcNewScene)                    \
  X(rtcReleaseScene)                \
  X(rtcSetSceneFlags)               \
  X(rtcSetSceneBuildQuality)        \
  X(rtcCommitScene)                 \
  X(rtcNewGeometry)                 \
  X(rtcReleaseGeometry)             \
  X(rtcSetNewGeometryBuffer)        \
  X(rtcCommitGeometry)              \
  X(rtcAttachGeometry)

/// Pointers to the functions above: of Embree 3, with which the lab is linked, or of Embree 4.
struct EmbreeFunctions {
// NOLINTNEXTLINE(bugprone-macro-parentheses): the member's name cannot be in parentheses
#define RAYGATE_MEMBER(function) decltype(&::function) function = ::function;
  RAYGATE_EMBREE_FUNCTIONS(RAYGATE_MEMBER)
#undef RAYGATE_MEMBER
};

inline std::shared_ptr<RTCDeviceTy> embree_device(const EmbreeFunctions& embree) {
  return {embree.rtcNewDevice("threads=1"), embree.rtcReleaseDevice};
}

/// Returns the committed scene, which keeps its device alive. Triangle i is primitive i.
inline std::shared_ptr<RTCSceneTy> embree_scene(const EmbreeFunctions& embree,
                                                const std::shared_ptr<RTCDeviceTy>& device,
                                                const Scene& scene, RTCSceneFlags flags) {
  std::shared_ptr<RTCSceneTy> loaded(
      embree.rtcNewScene(device.get()),
      [device, release = embree.rtcReleaseScene](RTCScene done) { release(done); });
  embree.rtcSetSceneFlags(loaded.get(), flags);
  embree.rtcSetSceneBuildQuality(loaded.get(), RTC_BUILD_QUALITY_HIGH);
  const RTCGeometry geometry = embree.rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(
      embree.rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                     sizeof(glm::vec3), scene.positions.size()));
  std::ranges::copy(scene.positions, positions);
  auto* indices = static_cast<std::uint32_t*>(
      embree.rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                     3 * sizeof(std::uint32_t), scene.triangles.size()));
  for (const Triangle& triangle : scene.triangles) {
    indices = std::ranges::copy(triangle.vertices, indices).out;
  }
  embree.rtcCommitGeometry(geometry);
  embree.rtcAttachGeometry(loaded.get(), geometry);
  embree.rtcReleaseGeometry(geometry);
  embree.rtcCommitScene(loaded.get());
  return loaded;
}

/// The types of a packet's rays and hits; for one ray, fields are scalars.
template <std::size_t kWidth>
struct Packet;
template <>
struct Packet<1> {
  using Rays = RTCRay;
  using Hits = RTCRayHit;
};
template <>
struct Packet<8> {
  using Rays = RTCRay8;
  using Hits = RTCRayHit8;
};
template <>
struct Packet<16> {
  using Rays = RTCRay16;
  using Hits = RTCRayHit16;
};

/// A query with space for the additional word per ray in Embree 4's hits.
template <class RayHit, std::size_t kWords>
struct RoomForHit : RayHit {
  std::uint32_t more[kWords];
};

/// Return one lane of a field.
template <class Word>
Word& in_lane(Word& field, std::size_t) {
  return field;
}
template <class Word, std::size_t kWidth>
Word& in_lane(Word (&field)[kWidth], std::size_t lane) {
  return field[lane];
}

/// Stores a ray in one lane of `rays`. The lane's other words must be zero.
template <class Rays>
void set_ray(Rays& rays, std::size_t lane, const Ray& ray,
             float t_max = std::numeric_limits<float>::infinity()) {
  const auto& [origin, direction] = ray;
  in_lane(rays.org_x, lane) = origin.x, in_lane(rays.org_y, lane) = origin.y;
  in_lane(rays.org_z, lane) = origin.z;
  in_lane(rays.dir_x, lane) = direction.x, in_lane(rays.dir_y, lane) = direction.y;
  in_lane(rays.dir_z, lane) = direction.z;
  in_lane(rays.tfar, lane) = t_max;
  in_lane(rays.mask, lane) = ~0u;
}

template <class Hits>
void set_no_hit(Hits& hits) {
  std::memset(&hits.geomID, 0xFF, sizeof hits.geomID);
  std::memset(&hits.primID, 0xFF, sizeof hits.primID);
  std::memset(&hits.instID, 0xFF, sizeof hits.instID);
}

/// Traces rays one by one or in packets, by rtcIntersect1, rtcIntersect8 and the like. Packets with
/// a common origin have the coherent flag. `Queries` calls Embree: set_coherent(), intersect() and
/// occluded() for one ray, 8 or 16.
template <std::size_t kWidth, class Queries>
class RayPackets : public Peer {
 public:
  RayPackets(std::string name, Queries queries, std::shared_ptr<RTCSceneTy> scene)
      : Peer(std::move(name)), queries_(queries), scene_(std::move(scene)) {}

  void prepare(const RaySet& set) override {
    any_hit_ = set.any_hit;
    queries_.set_coherent(kWidth > 1 && set.common_origin);
    count_ = set.rays.size();
    rays_.assign((count_ + kWidth - 1) / kWidth, {});
    for (std::size_t i = 0; i < rays_.size() * kWidth; ++i) {
      const std::size_t number = std::min(i, count_ - 1);
      set_ray(rays_[i / kWidth], i % kWidth, set.rays[number]);
      if (!set.t_max.empty()) in_lane(rays_[i / kWidth].tfar, i % kWidth) = set.t_max[number];
    }
  }

  void run(Found& found) override {
    alignas(64) int valid[kWidth];
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const std::size_t first = i * kWidth;
      const std::size_t lanes = kWidth == 1 ? 1 : std::min(kWidth, count_ - first);
      for (std::size_t lane = 0; lane < kWidth; ++lane) valid[lane] = lane < lanes ? -1 : 0;
      RoomForHit<typename Packet<kWidth>::Hits, kWidth> query;
      query.ray = rays_[i];
      if (any_hit_) {
        queries_.occluded(valid, scene_.get(), &query.ray);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          found.triangle[first + lane] =
              in_lane(query.ray.tfar, lane) < 0.0f ? Found::kSome : Found::kNone;
        }
      } else {
        set_no_hit(query.hit);
        queries_.intersect(valid, scene_.get(), &query);
        std::memcpy(&found.triangle[first], &query.hit.primID, lanes * sizeof(std::uint32_t));
        std::memcpy(&found.t[first], &query.ray.tfar, lanes * sizeof(float));
      }
    }
  }

 protected:
  Queries queries_;
  std::shared_ptr<RTCSceneTy> scene_;
  bool any_hit_ = false;
  std::vector<typename Packet<kWidth>::Rays> rays_;
  std::size_t count_ = 0;
};

/// Traces streams of rays with Embree 3 (rtcIntersect1M), with the coherent flag as in RayPackets.
template <class Queries>
class RayStreams : public RayPackets<1, Queries> {
 public:
  using RayPackets<1, Queries>::RayPackets;

  void prepare(const RaySet& set) override {
    RayPackets<1, Queries>::prepare(set);
    this->queries_.set_coherent(set.common_origin);
  }

  void run(Found& found) override {
    RTCRayHit stream[kStream];
    for (std::size_t first = 0; first < this->count_; first += kStream) {
      const std::size_t count = std::min(kStream, this->count_ - first);
      for (std::size_t i = 0; i < count; ++i) {
        stream[i].ray = this->rays_[first + i];
        set_no_hit(stream[i].hit);
      }
      this->queries_.trace_stream(this->scene_.get(), stream, static_cast<unsigned>(count),
                                  this->any_hit_);
      for (std::size_t i = 0; i < count; ++i) {
        if (this->any_hit_) {
          found.triangle[first + i] = stream[i].ray.tfar < 0.0f ? Found::kSome : Found::kNone;
        } else {
          found.triangle[first + i] = stream[i].hit.primID;
          found.t[first + i] = stream[i].ray.tfar;
        }
      }
    }
  }

 private:
  // Rays per stream. Such a stream fits into the first-level cache.
  static constexpr std::size_t kStream = 1024;
};

/// Returns peers for rays, packets and, if `Queries` has them, streams; in default and robust mode.
template <class Queries>
std::vector<std::unique_ptr<Peer>> make_embree_peers(const std::string& name,
                                                     const EmbreeFunctions& embree,
                                                     const Queries& queries, const Scene& scene) {
  static_assert(Found::kNone == RTC_INVALID_GEOMETRY_ID);
  const auto device = embree_device(embree);
  std::vector<std::unique_ptr<Peer>> peers;
  for (const bool robust : {false, true}) {
    const auto loaded =
        embree_scene(embree, device, scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    const auto add = [&]<class Kind>(const char* mode, std::type_identity<Kind>) {
      peers.push_back(
          std::make_unique<Kind>(name + "-" + mode + (robust ? " robust" : ""), queries, loaded));
    };
    add("1", std::type_identity<RayPackets<1, Queries>>());
    add("8", std::type_identity<RayPackets<8, Queries>>());
    add("16", std::type_identity<RayPackets<16, Queries>>());
    if constexpr (requires(Queries q, RTCRayHit * rays) { q.trace_stream({}, rays, 1u, true); }) {
      add("stream", std::type_identity<RayStreams<Queries>>());
    }
  }
  return peers;
}

}  // namespace raygate::lab
