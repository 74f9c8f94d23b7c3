#include "host/lab/embree_scene.h"

#include <algorithm>

namespace raygate::lab {

std::shared_ptr<RTCDeviceTy> embree_device() {
  return {rtcNewDevice("threads=1"), rtcReleaseDevice};
}

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

}  // namespace raygate::lab
