// Camera sequence: the cameras of a picture or an animation, and the lights that go with them.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/cli/options.h"
#include "host/light/default_lights.h"
#include "host/scene/camera.h"
#include "host/scene/scene.h"
#include "host/scene/view.h"

namespace raygate {

/// The cameras of all frames, or of the one picture; lights for a scene that has none, which go
/// with the camera, so that no frame shows the scene's shadowed side; and whether there is a
/// ground.
class CameraSequence {
 public:
  /// Of a scene as the file has it. `options` must outlive this. Throws
  /// InputError as Camera::look_at and frame_scene.
  CameraSequence(const Options& options, const Scene& scene);

  struct Frame {
    Camera camera;
    std::optional<CameraLights> lights;  ///< that go with it, in place of the scene's
  };
  /// Of picture `number`, from 1.
  [[nodiscard]] const Frame& frame(int number) const {
    return frames_[static_cast<std::size_t>(number - 1)];
  }

  /// A ground catches the shadows of a first look, from above, or where --ground says so.
  [[nodiscard]] bool has_ground() const { return has_ground_; }
  /// Upwards in the scene.
  [[nodiscard]] const glm::dvec3& up() const { return view_.up; }

  /// What to type for the view that was chosen, and for its camera; nothing if a camera was given.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// What makes the same picture again of the same scene, by the names of the options.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> options() const;

 private:
  [[nodiscard]] CameraSetting setting(const Scene& scene, int number) const;
  [[nodiscard]] std::string view_text(const Scene& scene) const;

  const Options& options_;
  std::optional<CameraSetting> given_;  // on the command line, in the scene file or the scene
  View view_;                           // where it is not given
  std::vector<Frame> frames_;
  bool has_ground_ = false;
  std::string text_;
};

}  // namespace raygate
