// Embree 3, as a peer whose rays per second are compared, and as a subject of the stress test.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "host/exact/exact.h"
#include "host/lab/rays/rays.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {
namespace {

/// A device of one thread.
std::shared_ptr<RTCDeviceTy> embree_device() {
  return {rtcNewDevice("threads=1"), rtcReleaseDevice};
}

/// The committed scene, which keeps its device; triangle i is primitive i.
std::shared_ptr<RTCSceneTy> embree_scene(const std::shared_ptr<RTCDeviceTy>& device,
                                         const Scene& scene, RTCSceneFlags flags) {
  std::shared_ptr<RTCSceneTy> loaded(rtcNewScene(device.get()),
                                     [device](RTCScene done) { rtcReleaseScene(done); });
  rtcSetSceneFlags(loaded.get(), flags);
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(glm::vec3), scene.positions.size()));
  std::ranges::copy(scene.positions, positions);
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), scene.triangles.size()));
  for (const Triangle& triangle : scene.triangles) {
    indices = std::ranges::copy(triangle.vertices, indices).out;
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(loaded.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(loaded.get());
  return loaded;
}

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
    return set.t_max.empty() ? std::numeric_limits<float>::infinity() : set.t_max[i];
  }

  RTCIntersectContext context_{};
  bool any_hit_ = false;

 private:
  std::string name_;
  std::shared_ptr<RTCSceneTy> scene_;
};

/// rtcIntersect1 / rtcOccluded1.
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

/// The same eight at a time, coherent: its fastest way for rays of a picture.
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

/// The context of one query: where its hits go.
struct Collector {
  RTCIntersectContext context;  // first: Embree hands back a pointer to it
  Answer* answers;              // of the ray, triangle by triangle
  const glm::vec3* direction;
};

void collect(const RTCFilterFunctionNArguments* arguments) {
  auto* collector = reinterpret_cast<Collector*>(arguments->context);
  Answer& answer = collector->answers[RTCHitN_primID(arguments->hit, arguments->N, 0)];
  answer.hit = true;
  answer.t = RTCRayN_tfar(arguments->ray, arguments->N, 0);
  answer.point = answer.t * *collector->direction;
  arguments->valid[0] = 0;  // go on
}

/// Whether Debian's Embree takes the ray: it aborts where one is not finite or beyond its range of
/// coordinates, and leaves out triangles that are.
bool accepts(const glm::vec3& origin, const glm::vec3& direction) {
  constexpr float kLargest = 1.8e18f;
  const glm::vec3 size = glm::abs(origin);
  return is_usable(direction) && std::max({size.x, size.y, size.z}) < kLargest;
}

/// Its traversal included. Every hit of a ray is collected by a filter that turns it down.
class EmbreeSubject : public Subject {
 public:
  explicit EmbreeSubject(int flags)
      : flags_(static_cast<RTCSceneFlags>(flags | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION)) {}

  void run(std::span<const Shot> shots, Answers& answers) override {
    std::size_t tests = 0;
    for (const Shot& shot : shots) tests += shot.tests();
    answers.tests.assign(tests, {});
    Answer* next = answers.tests.data();
    for (const Shot& shot : shots) {
      if (shot.mesh != mesh_) {
        mesh_ = shot.mesh;
        scene_ = embree_scene(device_, scene_of(*mesh_), flags_);
      }
      for (const glm::vec3& direction : shot.directions) {
        if (accepts(shot.origin, direction)) shoot(shot.origin, direction, next);
        next += shot.mesh->triangles.size();
      }
    }
    nearest_by_t(shots, answers);
  }

 private:
  void shoot(const glm::vec3& origin, const glm::vec3& direction, Answer* answers) {
    Collector collector{{}, answers, &direction};
    rtcInitIntersectContext(&collector.context);
    collector.context.filter = collect;
    RTCRayHit query{};
    query.ray.org_x = origin.x, query.ray.org_y = origin.y, query.ray.org_z = origin.z;
    query.ray.dir_x = direction.x, query.ray.dir_y = direction.y, query.ray.dir_z = direction.z;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &collector.context, &query);
  }

  RTCSceneFlags flags_;
  std::shared_ptr<RTCDeviceTy> device_ = embree_device();
  std::shared_ptr<RTCSceneTy> scene_;
  std::shared_ptr<const Mesh> mesh_;  // whose scene it is
};

SubjectKind kind(const char* name, const char* what, RTCSceneFlags flags) {
  return {.name = name, .what = what, .share = 0.02, .make = [flags] {
            return std::make_unique<EmbreeSubject>(flags);
          }};
}

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

std::vector<SubjectKind> embree_subjects() {
  return {kind("Embree", "Embree 3 as it comes, traversal included", RTC_SCENE_FLAG_NONE),
          kind("Embree robust", "Embree 3 in robust mode", RTC_SCENE_FLAG_ROBUST)};
}

}  // namespace raygate::lab
