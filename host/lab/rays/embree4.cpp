// Embree 4, which Debian 12 does not have: loaded from a file, as a Python wheel brings it.
#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <type_traits>

#include "host/base/input_error.h"
#include "host/lab/rays/embree_peers.h"

namespace raygate::lab {
namespace {

/// A function of the library, which stays loaded.
template <class Function>
Function function_of(void* library, const char* name) {
  void* const found = dlsym(library, name);
  if (found == nullptr) throw InputError(std::string("no ") + name + ", expected that of Embree 4");
  return reinterpret_cast<Function>(found);
}

/// How Embree 4 is asked: by rtcIntersect1(scene, query, arguments) and the like ("Embree 4 API",
/// 4.4), where Debian's headers have Embree 3's. Rays and hits have the same layout, but for
/// RoomForHit.
class Embree4Queries {
 public:
  explicit Embree4Queries(void* library)
      : intersect1_(function_of<decltype(intersect1_)>(library, "rtcIntersect1")),
        occluded1_(function_of<decltype(occluded1_)>(library, "rtcOccluded1")),
        intersect8_(function_of<decltype(intersect8_)>(library, "rtcIntersect8")),
        occluded8_(function_of<decltype(occluded8_)>(library, "rtcOccluded8")) {}
  void set_coherent(bool coherent) { arguments_.flags = coherent ? 1u << 16 : 0; }
  void intersect(RTCScene scene, RTCRayHit* query) { intersect1_(scene, query, &arguments_); }
  void occluded(RTCScene scene, RTCRay* ray) { occluded1_(scene, ray, &arguments_); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8* query) {
    intersect8_(valid, scene, query, &arguments_);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay8* rays) {
    occluded8_(valid, scene, rays, &arguments_);
  }

 private:
  /// RTCIntersectArguments and RTCOccludedArguments, whose fields are the same.
  struct Arguments {
    std::uint32_t flags = 0, features = ~0u;
    void *context = nullptr, *filter = nullptr, *user_geometry = nullptr;
    float least_width = 0.0f;  // of curves, in some builds
  };

  Arguments arguments_;
  void (*intersect1_)(RTCScene, RTCRayHit*, Arguments*);
  void (*occluded1_)(RTCScene, RTCRay*, Arguments*);
  void (*intersect8_)(const int*, RTCScene, RTCRayHit8*, Arguments*);
  void (*occluded8_)(const int*, RTCScene, RTCRay8*, Arguments*);
};

}  // namespace

std::vector<std::unique_ptr<Peer>> make_embrees4(const Scene& scene, const std::string& file) {
  void* const library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw InputError(file + ": not a library: " + dlerror());
  EmbreeFunctions embree;
  const auto load = [&](auto& function, const char* name) {
    function = function_of<std::remove_reference_t<decltype(function)>>(library, name);
  };
  load(embree.new_device, "rtcNewDevice");
  load(embree.release_device, "rtcReleaseDevice");
  load(embree.new_scene, "rtcNewScene");
  load(embree.release_scene, "rtcReleaseScene");
  load(embree.set_scene_flags, "rtcSetSceneFlags");
  load(embree.commit_scene, "rtcCommitScene");
  load(embree.new_geometry, "rtcNewGeometry");
  load(embree.release_geometry, "rtcReleaseGeometry");
  load(embree.set_new_buffer, "rtcSetNewGeometryBuffer");
  load(embree.commit_geometry, "rtcCommitGeometry");
  load(embree.attach_geometry, "rtcAttachGeometry");
  return make_embree_peers("Embree 4", embree, Embree4Queries(library), scene);
}

}  // namespace raygate::lab
