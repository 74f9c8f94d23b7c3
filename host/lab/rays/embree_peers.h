// Embree peers: common code for Embree 3 and 4, which differ only in their query functions.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/lab/rays/rays.h"

namespace raygate::lab {

/// Functions that build a scene, of Embree 3, which the lab is linked with, or of Embree 4.
struct EmbreeFunctions {
  decltype(&rtcNewDevice) new_device = rtcNewDevice;
  decltype(&rtcReleaseDevice) release_device = rtcReleaseDevice;
  decltype(&rtcNewScene) new_scene = rtcNewScene;
  decltype(&rtcReleaseScene) release_scene = rtcReleaseScene;
  decltype(&rtcSetSceneFlags) set_scene_flags = rtcSetSceneFlags;
  decltype(&rtcCommitScene) commit_scene = rtcCommitScene;
  decltype(&rtcNewGeometry) new_geometry = rtcNewGeometry;
  decltype(&rtcReleaseGeometry) release_geometry = rtcReleaseGeometry;
  decltype(&rtcSetNewGeometryBuffer) set_new_buffer = rtcSetNewGeometryBuffer;
  decltype(&rtcCommitGeometry) commit_geometry = rtcCommitGeometry;
  decltype(&rtcAttachGeometry) attach_geometry = rtcAttachGeometry;
};

inline std::shared_ptr<RTCDeviceTy> embree_device(const EmbreeFunctions& embree) {
  return {embree.new_device("threads=1"), embree.release_device};
}

/// Returns the committed scene, which keeps its device alive. Triangle i is primitive i.
inline std::shared_ptr<RTCSceneTy> embree_scene(const EmbreeFunctions& embree,
                                                const std::shared_ptr<RTCDeviceTy>& device,
                                                const Scene& scene, RTCSceneFlags flags) {
  std::shared_ptr<RTCSceneTy> loaded(
      embree.new_scene(device.get()),
      [device, release = embree.release_scene](RTCScene done) { release(done); });
  embree.set_scene_flags(loaded.get(), flags);
  const RTCGeometry geometry = embree.new_geometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(
      embree.set_new_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                            sizeof(glm::vec3), scene.positions.size()));
  std::ranges::copy(scene.positions, positions);
  auto* indices = static_cast<std::uint32_t*>(
      embree.set_new_buffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                            3 * sizeof(std::uint32_t), scene.triangles.size()));
  for (const Triangle& triangle : scene.triangles) {
    indices = std::ranges::copy(triangle.vertices, indices).out;
  }
  embree.commit_geometry(geometry);
  embree.attach_geometry(loaded.get(), geometry);
  embree.release_geometry(geometry);
  embree.commit_scene(loaded.get());
  return loaded;
}

/// A query with room for the additional word per ray of Embree 4's hits.
template <class RayHit, std::size_t kWords>
struct RoomForHit : RayHit {
  std::uint32_t more[kWords];
};

/// `Queries` calls Embree: set_coherent(), intersect() and occluded() for one ray or eight.
template <class Queries>
class EmbreePeer : public Peer {
 public:
  EmbreePeer(std::string name, Queries queries, std::shared_ptr<RTCSceneTy> scene)
      : queries_(queries), name_(std::move(name)), scene_(std::move(scene)) {}
  [[nodiscard]] const std::string& name() const override { return name_; }

 protected:
  [[nodiscard]] RTCScene scene() const { return scene_.get(); }
  static float limit(const RaySet& set, std::size_t i) {
    return set.t_max.empty() ? std::numeric_limits<float>::infinity() : set.t_max[i];
  }

  Queries queries_;
  bool any_hit_ = false;

 private:
  std::string name_;
  std::shared_ptr<RTCSceneTy> scene_;
};

/// Traces rays one by one, by rtcIntersect1 and rtcOccluded1.
template <class Queries>
class SingleRays : public EmbreePeer<Queries> {
 public:
  using EmbreePeer<Queries>::EmbreePeer;

  void prepare(const RaySet& set) override {
    this->any_hit_ = set.any_hit;
    rays_.assign(set.rays.size(), {});
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const auto& [origin, direction] = set.rays[i];
      RTCRay& ray = rays_[i];
      ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
      ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
      ray.tfar = this->limit(set, i);
      ray.mask = ~0u;
    }
  }

  void run(Found& found) override {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (this->any_hit_) {
        RTCRay ray = rays_[i];
        this->queries_.occluded(this->scene(), &ray);
        found.triangle[i] = ray.tfar < 0.0f ? Found::kSome : Found::kNone;
      } else {
        RoomForHit<RTCRayHit, 4> query;
        query.ray = rays_[i];
        query.hit.geomID = query.hit.primID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        this->queries_.intersect(this->scene(), &query);
        found.triangle[i] = query.hit.primID;
        found.t[i] = query.ray.tfar;
      }
    }
  }

 private:
  std::vector<RTCRay> rays_;
};

/// Traces eight coherent rays at a time, Embree's fastest mode for rays of an image.
template <class Queries>
class EightRays : public EmbreePeer<Queries> {
 public:
  using EmbreePeer<Queries>::EmbreePeer;

  void prepare(const RaySet& set) override {
    this->any_hit_ = set.any_hit;
    this->queries_.set_coherent(set.common_origin);
    count_ = set.rays.size();
    rays_.assign((count_ + kWidth - 1) / kWidth, {});
    for (std::size_t i = 0; i < rays_.size() * kWidth; ++i) {
      const std::size_t from = std::min(i, count_ - 1), lane = i % kWidth;
      const auto& [origin, direction] = set.rays[from];
      RTCRay8& ray = rays_[i / kWidth];
      ray.org_x[lane] = origin.x, ray.org_y[lane] = origin.y, ray.org_z[lane] = origin.z;
      ray.dir_x[lane] = direction.x, ray.dir_y[lane] = direction.y, ray.dir_z[lane] = direction.z;
      ray.tfar[lane] = this->limit(set, from);
      ray.mask[lane] = ~0u;
    }
  }

  void run(Found& found) override {
    alignas(32) int valid[kWidth];
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const std::size_t first = i * kWidth, lanes = std::min(kWidth, count_ - first);
      for (std::size_t lane = 0; lane < kWidth; ++lane) valid[lane] = lane < lanes ? -1 : 0;
      if (this->any_hit_) {
        RTCRay8 rays = rays_[i];
        this->queries_.occluded(valid, this->scene(), &rays);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          found.triangle[first + lane] = rays.tfar[lane] < 0.0f ? Found::kSome : Found::kNone;
        }
      } else {
        RoomForHit<RTCRayHit8, kWidth> query;
        query.ray = rays_[i];
        std::memset(query.hit.geomID, 0xFF, sizeof query.hit.geomID);
        std::memset(query.hit.primID, 0xFF, sizeof query.hit.primID);
        std::memset(query.hit.instID, 0xFF, sizeof query.hit.instID);
        this->queries_.intersect(valid, this->scene(), &query);
        std::memcpy(&found.triangle[first], query.hit.primID, lanes * sizeof(std::uint32_t));
        std::memcpy(&found.t[first], query.ray.tfar, lanes * sizeof(float));
      }
    }
  }

 private:
  static constexpr std::size_t kWidth = 8;

  std::vector<RTCRay8> rays_;
  std::size_t count_ = 0;
};

/// Returns peers for single rays and for eight at a time, each in default and robust mode.
template <class Queries>
std::vector<std::unique_ptr<Peer>> make_embree_peers(const std::string& name,
                                                     const EmbreeFunctions& embree,
                                                     const Queries& queries, const Scene& scene) {
  static_assert(Found::kNone == RTC_INVALID_GEOMETRY_ID);
  const auto device = embree_device(embree);
  const auto usual = embree_scene(embree, device, scene, RTC_SCENE_FLAG_NONE);
  const auto robust = embree_scene(embree, device, scene, RTC_SCENE_FLAG_ROBUST);
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(std::make_unique<SingleRays<Queries>>(name + " 1", queries, usual));
  peers.push_back(std::make_unique<SingleRays<Queries>>(name + " 1 robust", queries, robust));
  peers.push_back(std::make_unique<EightRays<Queries>>(name + " 8", queries, usual));
  peers.push_back(std::make_unique<EightRays<Queries>>(name + " 8 robust", queries, robust));
  return peers;
}

}  // namespace raygate::lab
