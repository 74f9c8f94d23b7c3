// Scenes in Embree 3, released by themselves.
#pragma once

#include <embree3/rtcore.h>

#include <memory>

#include "host/scene/scene.h"

namespace raygate::lab {

/// A device of one thread.
[[nodiscard]] std::shared_ptr<RTCDeviceTy> embree_device();

/// The committed scene, which keeps its device; triangle i is primitive i.
[[nodiscard]] std::shared_ptr<RTCSceneTy> embree_scene(const std::shared_ptr<RTCDeviceTy>& device,
                                                       const Scene& scene, RTCSceneFlags flags);

}  // namespace raygate::lab
