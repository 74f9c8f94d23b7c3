// Embree 3, as a peer for speed comparisons and as a subject of the stress test.
#include <algorithm>
#include <limits>
#include <memory>

#include "host/exact/exact.h"
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
  RTCIntersectContext context;  // must be first: Embree returns a pointer to it
  Answer* answers;              // answers of the ray, by triangle
  const glm::vec3* direction;
};

void collect(const RTCFilterFunctionNArguments* arguments) {
  auto* collector = reinterpret_cast<Collector*>(arguments->context);
  Answer& answer = collector->answers[RTCHitN_primID(arguments->hit, arguments->N, 0)];
  answer.hit = true;
  answer.t = RTCRayN_tfar(arguments->ray, arguments->N, 0);
  answer.point = answer.t * *collector->direction;
  arguments->valid[0] = 0;  // continue the traversal
}

/// Returns whether a ray and the triangles are within Embree's range (FLT_LARGE in its sources).
/// Embree aborts for rays beyond it and skips such triangles.
bool accepts(const Shot& shot, const glm::vec3& direction) {
  constexpr float kLargest = 1.8e18f;
  const auto is_small = [](const glm::vec3& v) {
    const glm::vec3 size = glm::abs(v);
    return std::max({size.x, size.y, size.z}) < kLargest;
  };
  return is_usable(direction) && is_small(shot.origin) &&
         std::ranges::all_of(shot.mesh->triangles, [&](const Corners& corners) {
           return std::ranges::all_of(corners, is_small);
         });
}

/// Counts the hits of one ray in a filter function that rejects them.
struct Counter {
  RTCIntersectContext context;  // must be first: Embree returns a pointer to it
  std::uint32_t hits;
};

void count_hit(const RTCFilterFunctionNArguments* arguments) {
  ++reinterpret_cast<Counter*>(arguments->context)->hits;
  arguments->valid[0] = 0;
}

RTCRayHit query_of(const glm::vec3& origin, const glm::vec3& direction) {
  RTCRayHit query{};
  query.ray.org_x = origin.x, query.ray.org_y = origin.y, query.ray.org_z = origin.z;
  query.ray.dir_x = direction.x, query.ray.dir_y = direction.y, query.ray.dir_z = direction.z;
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0u;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return query;
}

/// Collects every hit of a ray in a filter function that rejects it. Tests the traversal, too.
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
        scene_ = embree_scene({}, device_, scene_of(*mesh_), flags_);
      }
      for (const glm::vec3& direction : shot.directions) {
        const bool is_accepted = accepts(shot, direction);
        answers.refused.push_back(!is_accepted);
        if (is_accepted) shoot(shot.origin, direction, next);
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
    RTCRayHit query = query_of(origin, direction);
    rtcIntersect1(scene_.get(), &collector.context, &query);
  }

  RTCSceneFlags flags_;
  std::shared_ptr<RTCDeviceTy> device_ = embree_device({});
  std::shared_ptr<RTCSceneTy> scene_;
  std::shared_ptr<const Mesh> mesh_;  // the mesh of the current scene
};

SubjectKind kind(const char* name, const char* what, RTCSceneFlags flags) {
  return {.name = name, .what = what, .share = 0.02, .make = [flags] {
            return std::make_unique<EmbreeSubject>(flags);
          }};
}

}  // namespace

std::vector<std::unique_ptr<Peer>> make_embrees(const Scene& scene) {
  return make_embree_peers("Embree", {}, Embree3Queries(), scene);
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
      Counter counter{{}, 0};
      rtcInitIntersectContext(&counter.context);
      RTCRayHit nearest = query_of(ray.origin, ray.direction);
      rtcIntersect1(loaded.get(), &counter.context, &nearest);
      if (nearest.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        counts.push_back(0);
        continue;
      }
      counter.context.filter = count_hit;
      RTCRayHit query = query_of(ray.origin, ray.direction);
      rtcIntersect1(loaded.get(), &counter.context, &query);
      counts.push_back(std::max(counter.hits, 1u));
    }
  }
  return found;
}

std::vector<SubjectKind> embree_subjects() {
  return {kind("Embree", "Embree 3 as it comes, traversal included", RTC_SCENE_FLAG_NONE),
          kind("Embree robust", "Embree 3 in robust mode", RTC_SCENE_FLAG_ROBUST)};
}

}  // namespace raygate::lab
