// Embree 3, as a peer for speed comparisons and as a subject of the stress test.
#include <algorithm>
#include <limits>
#include <memory>

#include "host/exact/exact.h"
#include "host/exact/test/meshes.h"
#include "host/lab/rays/embree_peers.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {
namespace {

/// Query functions of Embree 3.
class Embree3Queries {
 public:
  Embree3Queries() { rtcInitIntersectContext(&context_); }
  void set_coherent(bool coherent) {
    context_.flags =
        coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  void intersect(const int*, RTCScene scene, RTCRayHit* query) {
    rtcIntersect1(scene, &context_, query);
  }
  void occluded(const int*, RTCScene scene, RTCRay* ray) { rtcOccluded1(scene, &context_, ray); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8* query) {
    rtcIntersect8(valid, scene, &context_, query);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay8* rays) {
    rtcOccluded8(valid, scene, &context_, rays);
  }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16* query) {
    rtcIntersect16(valid, scene, &context_, query);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay16* rays) {
    rtcOccluded16(valid, scene, &context_, rays);
  }
  void trace_stream(RTCScene scene, RTCRayHit* rays, unsigned count, bool any_hit) {
    if (any_hit) {
      rtcOccluded1M(scene, &context_, &rays->ray, count, sizeof *rays);
    } else {
      rtcIntersect1M(scene, &context_, rays, count, sizeof *rays);
    }
  }

 private:
  RTCIntersectContext context_{};
};

/// Context of a query, which stores its hits.
struct Collector {
  RTCIntersectContext context{};  // must be first: Embree returns a pointer to it
  std::uint32_t hits = 0;
  Answer* answers = nullptr;  // answers of the ray, by triangle; null: hits are only counted
  glm::vec3 direction{0.0f};
};

void collect(const RTCFilterFunctionNArguments* arguments) {
  auto* collector = reinterpret_cast<Collector*>(arguments->context);
  ++collector->hits;
  arguments->valid[0] = 0;  // continue the traversal
  if (collector->answers == nullptr) return;
  Answer& answer = collector->answers[RTCHitN_primID(arguments->hit, arguments->N, 0)];
  answer.hit = true;
  const float t = RTCRayN_tfar(arguments->ray, arguments->N, 0);
  answer.t = t;
  answer.point = t * collector->direction;
}

/// Traces a ray: finds the nearest hit, or, with `collector`, all hits.
RTCRayHit shoot(RTCScene scene, const Ray& ray, Collector* collector = nullptr) {
  RTCRayHit query{};
  set_ray(query.ray, 0, ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  Collector none;
  Collector& mine = collector != nullptr ? *collector : none;
  rtcInitIntersectContext(&mine.context);
  if (collector != nullptr) mine.context.filter = collect;
  rtcIntersect1(scene, &mine.context, &query);
  return query;
}

/// Returns whether a ray and the triangles are within Embree's range (FLT_LARGE in its sources).
/// Beyond this range, Embree aborts for rays and skips triangles.
bool accepts(const Shot& shot, const glm::dvec3& direction) {
  const auto is_small = [](const glm::dvec3& v) { return largest(v) < 1.8e18; };
  return is_usable(direction) && is_small(shot.origin) &&
         std::ranges::all_of(*shot.mesh, [&](const Corners& corners) {
           return std::ranges::all_of(corners, is_small);
         });
}

/// Collects all hits of a ray by a filter function that rejects each hit. Tests traversal, too.
class EmbreeSubject : public Subject {
 public:
  explicit EmbreeSubject(int flags)
      : flags_(static_cast<RTCSceneFlags>(flags | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION)) {}

  void run(std::span<const Shot> shots, Answers& answers) override {
    std::size_t tests = 0;
    for (const Shot& shot : shots) tests += shot.tests();
    answers.tests.assign(tests, {});
    answers.refused.clear();
    Answer* next = answers.tests.data();
    for (const Shot& shot : shots) {
      if (shot.mesh != mesh_) {
        mesh_ = shot.mesh;
        scene_ = embree_scene({}, device_, test::scene_of(*mesh_), flags_);
      }
      for (const glm::dvec3& direction : shot.directions) {
        const bool is_accepted = accepts(shot, direction);
        answers.refused.push_back(!is_accepted);
        const Ray ray{glm::vec3(shot.origin), glm::vec3(direction)};
        Collector collector{.answers = next, .direction = ray.direction};
        if (is_accepted) (void)shoot(scene_.get(), ray, &collector);
        next += shot.mesh->size();
      }
    }
    nearest_by_t(shots, answers);
  }

 private:
  RTCSceneFlags flags_;
  std::shared_ptr<RTCDeviceTy> device_ = embree_device({});
  std::shared_ptr<RTCSceneTy> scene_;
  MeshPointer mesh_;  // the mesh of the current scene
};

SubjectKind kind(const char* name, const char* what, RTCSceneFlags flags) {
  return {.name = name, .what = what, .binary64 = true, .share = 0.02, .make = [flags] {
            return std::make_unique<EmbreeSubject>(flags);
          }};
}

}  // namespace

std::vector<std::unique_ptr<Peer>> make_embrees(const Scene& scene) {
  return make_embree_peers("Embree3", {}, Embree3Queries(), scene);
}

std::vector<std::pair<std::string, std::vector<std::uint32_t>>> embree_hit_counts(
    const Scene& scene, std::span<const Ray> rays) {
  std::vector<std::pair<std::string, std::vector<std::uint32_t>>> found;
  for (const auto& [name, mode] : {std::pair{"Embree", RTC_SCENE_FLAG_NONE},
                                   std::pair{"Embree robust", RTC_SCENE_FLAG_ROBUST}}) {
    const auto loaded =
        embree_scene({}, embree_device({}), scene, mode | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    std::vector<std::uint32_t>& counts =
        found.emplace_back(name, std::vector<std::uint32_t>()).second;
    for (const Ray& ray : rays) {
      Collector collector;
      const bool is_hit = shoot(loaded.get(), ray).hit.geomID != RTC_INVALID_GEOMETRY_ID;
      if (is_hit) (void)shoot(loaded.get(), ray, &collector);
      counts.push_back(is_hit ? std::max(collector.hits, 1u) : 0u);
    }
  }
  return found;
}

std::vector<SubjectKind> embree_subjects() {
  return {kind("Embree", "Embree 3 as it comes, traversal included", RTC_SCENE_FLAG_NONE),
          kind("Embree robust", "Embree 3 in robust mode", RTC_SCENE_FLAG_ROBUST)};
}

}  // namespace raygate::lab
