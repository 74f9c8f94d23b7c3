// A scene with its tree, lit, for as many pictures as are wanted.
#pragma once

#include <filesystem>
#include <string>

#include "host/bvh/bvh.h"
#include "host/light/default_lights.h"
#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"

namespace raygate::lab {

struct LitScene {
  std::string name;
  Scene scene;
  Bvh bvh;

  explicit LitScene(const std::filesystem::path& file)
      : name(file.stem().string()), scene(load_obj(file)), bvh(scene) {
    add_default_lights(scene, Camera::frame(scene, 4.0 / 3.0));
  }

  /// The whole scene in view.
  [[nodiscard]] Camera camera(int width, int height) const {
    return Camera::frame(scene, static_cast<double>(width) / height);
  }
};

}  // namespace raygate::lab
