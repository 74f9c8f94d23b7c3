// Embree 4, loaded from a file, such as the library in a Python wheel. Debian 12 has no package.
#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <utility>

#include "host/base/input_error.h"
#include "host/lab/rays/embree_peers.h"

namespace raygate::lab {
namespace {

/// A shared library, which stays loaded.
class Library {
 public:
  explicit Library(std::string file)
      : file_(std::move(file)),
        handle_(dlopen(std::filesystem::absolute(file_).c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) throw InputError(file_ + ": not a library: " + dlerror());
  }
  template <class Function>
  void load(Function& function, const char* name) const {
    void* const found = dlsym(handle_, name);
    if (found == nullptr) throw InputError(file_ + ": no " + name + ", expected Embree 4");
    function = reinterpret_cast<Function>(found);
  }

 private:
  std::string file_;
  void* handle_;
};

/// Query functions of Embree 4: rtcIntersect1(scene, query, arguments) and the like ("Embree 4
/// API", 4.4), while Debian's headers declare those of Embree 3. Rays and hits have the same
/// layout, except for RoomForHit.
class Embree4Queries {
 public:
  explicit Embree4Queries(const Library& library) {
    library.load(intersect1_, "rtcIntersect1");
    library.load(occluded1_, "rtcOccluded1");
    library.load(intersect8_, "rtcIntersect8");
    library.load(occluded8_, "rtcOccluded8");
    library.load(intersect16_, "rtcIntersect16");
    library.load(occluded16_, "rtcOccluded16");
  }
  void set_coherent(bool coherent) { arguments_.flags = coherent ? 1u << 16 : 0; }
  void intersect(const int*, RTCScene scene, RTCRayHit* query) {
    intersect1_(scene, query, &arguments_);
  }
  void occluded(const int*, RTCScene scene, RTCRay* ray) { occluded1_(scene, ray, &arguments_); }
  void intersect(const int* valid, RTCScene scene, RTCRayHit8* query) {
    intersect8_(valid, scene, query, &arguments_);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay8* rays) {
    occluded8_(valid, scene, rays, &arguments_);
  }
  void intersect(const int* valid, RTCScene scene, RTCRayHit16* query) {
    intersect16_(valid, scene, query, &arguments_);
  }
  void occluded(const int* valid, RTCScene scene, RTCRay16* rays) {
    occluded16_(valid, scene, rays, &arguments_);
  }

 private:
  /// Arguments with the common layout of RTCIntersectArguments and RTCOccludedArguments.
  struct Arguments {
    std::uint32_t flags = 0, features = ~0u;
    void *context = nullptr, *filter = nullptr, *user_geometry = nullptr;
    float least_width = 0.0f;  // width of curves, in some builds
  };

  Arguments arguments_;
  void (*intersect1_)(RTCScene, RTCRayHit*, Arguments*) = nullptr;
  void (*occluded1_)(RTCScene, RTCRay*, Arguments*) = nullptr;
  void (*intersect8_)(const int*, RTCScene, RTCRayHit8*, Arguments*) = nullptr;
  void (*occluded8_)(const int*, RTCScene, RTCRay8*, Arguments*) = nullptr;
  void (*intersect16_)(const int*, RTCScene, RTCRayHit16*, Arguments*) = nullptr;
  void (*occluded16_)(const int*, RTCScene, RTCRay16*, Arguments*) = nullptr;
};

}  // namespace

std::vector<std::unique_ptr<Peer>> make_embrees4(const Scene& scene, const std::string& file) {
  const Library library(file);
  EmbreeFunctions embree;
#define RAYGATE_LOAD(function) library.load(embree.function, #function);
  RAYGATE_EMBREE_FUNCTIONS(RAYGATE_LOAD)
#undef RAYGATE_LOAD
  return make_embree_peers("Embree4", embree, Embree4Queries(library), scene);
}

}  // namespace raygate::lab
