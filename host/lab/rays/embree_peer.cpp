// Embree 3's answers: rtcIntersect1 / rtcOccluded1, and the same eight at a time with the coherent
// flag, which is its fastest way for rays of a picture.
#include "host/lab/rays/peer.h"

#ifdef RAYGATE_EMBREE
#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#endif

namespace raygate::rays {

#ifdef RAYGATE_EMBREE
namespace {

constexpr int kWidth = 8;

/// The device and the committed scene, triangle i being primitive i.
class Loaded {
 public:
  Loaded(const Scene& scene, RTCSceneFlags flags) : device_(rtcNewDevice("threads=1")) {
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), scene.positions.size()));
    std::memcpy(vertices, scene.positions.data(), scene.positions.size() * sizeof(glm::vec3));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), scene.triangles.size()));
    for (const Triangle& triangle : scene.triangles) {
      for (const std::uint32_t vertex : triangle.vertices) *indices++ = vertex;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  Loaded(const Loaded&) = delete;
  Loaded& operator=(const Loaded&) = delete;
  ~Loaded() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] RTCScene scene() const { return scene_; }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

class EmbreePeer : public Peer {
 public:
  EmbreePeer(std::string name, std::shared_ptr<Loaded> loaded)
      : name_(std::move(name)), loaded_(std::move(loaded)) {}
  [[nodiscard]] const std::string& name() const override { return name_; }

 protected:
  [[nodiscard]] RTCScene scene() const { return loaded_->scene(); }

 private:
  std::string name_;
  std::shared_ptr<Loaded> loaded_;
};

class SingleRays : public EmbreePeer {
 public:
  using EmbreePeer::EmbreePeer;

  void prepare(const RaySet& set) override {
    any_hit_ = set.any_hit;
    rays_.clear();
    for (std::size_t i = 0; i < set.rays.size(); ++i) {
      const auto& [origin, direction] = set.rays[i];
      RTCRay& ray = rays_.emplace_back();
      ray = {};
      ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
      ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
      ray.tfar = set.limits.empty() ? std::numeric_limits<float>::infinity() : set.limits[i];
      ray.mask = ~0u;
    }
  }

  void run(Found& found) override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (any_hit_) {
        RTCRay ray = rays_[i];
        rtcOccluded1(scene(), &context, &ray);
        found.triangle[i] = ray.tfar < 0.0f ? Found::kSome : Found::kNone;
      } else {
        RTCRayHit query;
        query.ray = rays_[i];
        query.hit.geomID = query.hit.primID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene(), &context, &query);
        found.triangle[i] = query.hit.primID;
        found.t[i] = query.ray.tfar;
      }
    }
  }

 private:
  std::vector<RTCRay> rays_;
  bool any_hit_ = false;
};

class EightRays : public EmbreePeer {
 public:
  using EmbreePeer::EmbreePeer;

  void prepare(const RaySet& set) override {
    any_hit_ = set.any_hit;
    flags_ = set.common_origin ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                               : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    count_ = set.rays.size();
    rays_.assign((count_ + kWidth - 1) / kWidth, {});
    for (std::size_t i = 0; i < rays_.size() * kWidth; ++i) {
      const std::size_t from = std::min(i, count_ - 1);
      const auto& [origin, direction] = set.rays[from];
      RTCRay8& ray = rays_[i / kWidth];
      const std::size_t lane = i % kWidth;
      ray.org_x[lane] = origin.x, ray.org_y[lane] = origin.y, ray.org_z[lane] = origin.z;
      ray.dir_x[lane] = direction.x, ray.dir_y[lane] = direction.y, ray.dir_z[lane] = direction.z;
      ray.tfar[lane] =
          set.limits.empty() ? std::numeric_limits<float>::infinity() : set.limits[from];
      ray.mask[lane] = ~0u;
    }
  }

  void run(Found& found) override {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = flags_;
    alignas(32) int valid[kWidth];
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const std::size_t first = i * kWidth, lanes = std::min<std::size_t>(kWidth, count_ - first);
      for (std::size_t lane = 0; lane < kWidth; ++lane) valid[lane] = lane < lanes ? -1 : 0;
      if (any_hit_) {
        RTCRay8 rays = rays_[i];
        rtcOccluded8(valid, scene(), &context, &rays);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          found.triangle[first + lane] = rays.tfar[lane] < 0.0f ? Found::kSome : Found::kNone;
        }
      } else {
        RTCRayHit8 query;
        query.ray = rays_[i];
        std::memset(query.hit.geomID, 0xFF, sizeof query.hit.geomID);
        std::memset(query.hit.primID, 0xFF, sizeof query.hit.primID);
        std::memset(query.hit.instID, 0xFF, sizeof query.hit.instID);
        rtcIntersect8(valid, scene(), &context, &query);
        std::memcpy(&found.triangle[first], query.hit.primID, lanes * sizeof(std::uint32_t));
        std::memcpy(&found.t[first], query.ray.tfar, lanes * sizeof(float));
      }
    }
  }

 private:
  std::vector<RTCRay8> rays_;
  std::size_t count_ = 0;
  bool any_hit_ = false;
  RTCIntersectContextFlags flags_ = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
};

}  // namespace

std::vector<std::unique_ptr<Peer>> make_embrees(const Scene& scene) {
  static_assert(Found::kNone == RTC_INVALID_GEOMETRY_ID);
  const auto usual = std::make_shared<Loaded>(scene, RTC_SCENE_FLAG_NONE);
  const auto robust = std::make_shared<Loaded>(scene, RTC_SCENE_FLAG_ROBUST);
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(std::make_unique<SingleRays>("Embree 1", usual));
  peers.push_back(std::make_unique<SingleRays>("Embree 1 robust", robust));
  peers.push_back(std::make_unique<EightRays>("Embree 8", usual));
  peers.push_back(std::make_unique<EightRays>("Embree 8 robust", robust));
  return peers;
}
#else
std::vector<std::unique_ptr<Peer>> make_embrees(const Scene&) { return {}; }
#endif

}  // namespace raygate::rays
