// Embree 3's answers: rtcIntersect1 / rtcOccluded1, and the same eight at a time with the coherent
// flag, which is its fastest way for rays of a picture.
#include <algorithm>
#include <cstring>

#include "host/lab/embree_scene.h"
#include "host/lab/rays/peer.h"

namespace raygate::lab {
namespace {

constexpr std::size_t kWidth = 8;

class EmbreePeer : public Peer {
 public:
  EmbreePeer(std::string name, std::shared_ptr<RTCSceneTy> scene)
      : name_(std::move(name)), scene_(std::move(scene)) {
    rtcInitIntersectContext(&context_);
  }
  [[nodiscard]] const std::string& name() const override { return name_; }

 protected:
  [[nodiscard]] RTCScene scene() const { return scene_.get(); }
  static float limit(const RaySet& set, std::size_t i) {
    return set.limits.empty() ? std::numeric_limits<float>::infinity() : set.limits[i];
  }

  RTCIntersectContext context_{};
  bool any_hit_ = false;

 private:
  std::string name_;
  std::shared_ptr<RTCSceneTy> scene_;
};

class SingleRays : public EmbreePeer {
 public:
  using EmbreePeer::EmbreePeer;

  void prepare(const RaySet& set) override {
    any_hit_ = set.any_hit;
    rays_.assign(set.rays.size(), {});
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const auto& [origin, direction] = set.rays[i];
      RTCRay& ray = rays_[i];
      ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
      ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
      ray.tfar = limit(set, i);
      ray.mask = ~0u;
    }
  }

  void run(Found& found) override {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (any_hit_) {
        RTCRay ray = rays_[i];
        rtcOccluded1(scene(), &context_, &ray);
        found.triangle[i] = ray.tfar < 0.0f ? Found::kSome : Found::kNone;
      } else {
        RTCRayHit query;
        query.ray = rays_[i];
        query.hit.geomID = query.hit.primID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene(), &context_, &query);
        found.triangle[i] = query.hit.primID;
        found.t[i] = query.ray.tfar;
      }
    }
  }

 private:
  std::vector<RTCRay> rays_;
};

class EightRays : public EmbreePeer {
 public:
  using EmbreePeer::EmbreePeer;

  void prepare(const RaySet& set) override {
    any_hit_ = set.any_hit;
    context_.flags = set.common_origin ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                       : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    count_ = set.rays.size();
    rays_.assign((count_ + kWidth - 1) / kWidth, {});
    for (std::size_t i = 0; i < rays_.size() * kWidth; ++i) {
      const std::size_t from = std::min(i, count_ - 1), lane = i % kWidth;
      const auto& [origin, direction] = set.rays[from];
      RTCRay8& ray = rays_[i / kWidth];
      ray.org_x[lane] = origin.x, ray.org_y[lane] = origin.y, ray.org_z[lane] = origin.z;
      ray.dir_x[lane] = direction.x, ray.dir_y[lane] = direction.y, ray.dir_z[lane] = direction.z;
      ray.tfar[lane] = limit(set, from);
      ray.mask[lane] = ~0u;
    }
  }

  void run(Found& found) override {
    alignas(32) int valid[kWidth];
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const std::size_t first = i * kWidth, lanes = std::min(kWidth, count_ - first);
      for (std::size_t lane = 0; lane < kWidth; ++lane) valid[lane] = lane < lanes ? -1 : 0;
      if (any_hit_) {
        RTCRay8 rays = rays_[i];
        rtcOccluded8(valid, scene(), &context_, &rays);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          found.triangle[first + lane] = rays.tfar[lane] < 0.0f ? Found::kSome : Found::kNone;
        }
      } else {
        RTCRayHit8 query;
        query.ray = rays_[i];
        std::memset(query.hit.geomID, 0xFF, sizeof query.hit.geomID);
        std::memset(query.hit.primID, 0xFF, sizeof query.hit.primID);
        std::memset(query.hit.instID, 0xFF, sizeof query.hit.instID);
        rtcIntersect8(valid, scene(), &context_, &query);
        std::memcpy(&found.triangle[first], query.hit.primID, lanes * sizeof(std::uint32_t));
        std::memcpy(&found.t[first], query.ray.tfar, lanes * sizeof(float));
      }
    }
  }

 private:
  std::vector<RTCRay8> rays_;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<std::unique_ptr<Peer>> make_embrees(const Scene& scene) {
  static_assert(Found::kNone == RTC_INVALID_GEOMETRY_ID);
  const auto device = embree_device();
  const auto usual = embree_scene(device, scene, RTC_SCENE_FLAG_NONE);
  const auto robust = embree_scene(device, scene, RTC_SCENE_FLAG_ROBUST);
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(std::make_unique<SingleRays>("Embree 1", usual));
  peers.push_back(std::make_unique<SingleRays>("Embree 1 robust", robust));
  peers.push_back(std::make_unique<EightRays>("Embree 8", usual));
  peers.push_back(std::make_unique<EightRays>("Embree 8 robust", robust));
  return peers;
}

}  // namespace raygate::lab
