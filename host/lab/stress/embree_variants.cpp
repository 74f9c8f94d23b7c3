// Embree 3, its traversal included. Every hit of a ray is collected by a filter that turns it down.
#include "host/exact/exact.h"
#include "host/lab/stress/variants.h"

#ifdef RAYGATE_EMBREE
#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>
#include <limits>
#endif

namespace raygate::stress {

#ifdef RAYGATE_EMBREE
namespace {

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

class EmbreeVariant : public Variant {
 public:
  explicit EmbreeVariant(RTCSceneFlags flags) : device_(rtcNewDevice("threads=1")), flags_(flags) {}
  EmbreeVariant(const EmbreeVariant&) = delete;
  EmbreeVariant& operator=(const EmbreeVariant&) = delete;
  ~EmbreeVariant() override {
    if (scene_ != nullptr) rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  void run(std::span<const Shot> shots, Answers& answers) override {
    std::size_t tests = 0;
    for (const Shot& shot : shots) tests += shot.tests();
    answers.tests.assign(tests, {});
    Answer* next = answers.tests.data();
    for (const Shot& shot : shots) {
      load(shot.mesh);
      for (const glm::vec3& direction : shot.directions) {
        if (accepts(shot.origin, direction)) shoot(shot.origin, direction, next);
        next += shot.mesh->triangles.size();
      }
    }
    nearest_by_t(shots, answers);
  }

 private:
  void load(const std::shared_ptr<const Mesh>& mesh) {
    if (mesh == mesh_) return;
    mesh_ = mesh;
    if (scene_ != nullptr) rtcReleaseScene(scene_);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags_ | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const std::size_t count = mesh->triangles.size();
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * count));
    std::memcpy(vertices, mesh->triangles.data(), count * sizeof(Corners));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count));
    for (unsigned i = 0; i < 3 * count; ++i) indices[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }

  void shoot(const glm::vec3& origin, const glm::vec3& direction, Answer* answers) {
    Collector collector{{}, answers, &direction};
    rtcInitIntersectContext(&collector.context);
    collector.context.filter = collect;
    RTCRayHit query{};
    query.ray.org_x = origin.x;
    query.ray.org_y = origin.y;
    query.ray.org_z = origin.z;
    query.ray.dir_x = direction.x;
    query.ray.dir_y = direction.y;
    query.ray.dir_z = direction.z;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &collector.context, &query);
  }

  RTCDevice device_;
  RTCSceneFlags flags_;
  RTCScene scene_ = nullptr;
  std::shared_ptr<const Mesh> mesh_;
};

VariantKind kind(const char* name, const char* what, RTCSceneFlags flags) {
  return {name, what, false, 0.02, "", [flags] { return std::make_unique<EmbreeVariant>(flags); }};
}

}  // namespace

std::vector<VariantKind> embree_variants() {
  return {kind("Embree", "Embree 3 as it comes, traversal included", RTC_SCENE_FLAG_NONE),
          kind("Embree robust", "Embree 3 in robust mode", RTC_SCENE_FLAG_ROBUST)};
}
#else
std::vector<VariantKind> embree_variants() { return {}; }
#endif

}  // namespace raygate::stress
