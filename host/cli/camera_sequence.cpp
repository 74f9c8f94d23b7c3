#include "host/cli/camera_sequence.h"

#include <cmath>
#include <initializer_list>

#include "host/cli/camera_options.h"
#include "host/cli/format.h"
#include "host/exact/exact.h"
#include "host/light/default_lights.h"
#include "host/scene/camera.h"

namespace raygate {
namespace {

/// In the scene's coordinates, with what the command line says of every camera.
CameraSetting completed(const CameraSetting& camera, const Options& options, const Scene& scene) {
  CameraSetting result = camera;
  result.eye -= scene.origin;
  result.target -= scene.origin;
  if (options.camera.up) result.up = options.camera.up;
  if (options.camera.fov) result.fov = options.camera.fov;
  result.lens = camera.lens.overridden_by(options.camera.lens);
  return result;
}

View chosen_view(const Options& options, const Scene& scene) {
  const glm::dvec3 up = options.camera.up ? *options.camera.up : guess_up_axis(scene);
  if (!options.camera.angles) return default_view(scene, up);
  return {options.camera.angles->first, options.camera.angles->second, up};
}

double aspect_of(const Options& options) {
  return static_cast<double>(options.render.width) / options.render.height;
}

}  // namespace

CameraSequence::CameraSequence(const Options& options, const Scene& scene)
    : options_(options),
      given_(options.camera.camera   ? options.camera.camera
             : options.camera.angles ? std::nullopt
                                     : scene.camera),
      view_(given_ && !options.camera.ground.value_or(false) ? View{}
                                                             : chosen_view(options, scene)) {
  for (int number = 1; number <= std::max(1, options.output.frames); ++number) {
    const Camera camera = Camera::look_at(setting(scene, number), aspect_of(options));
    frames_.push_back(
        {camera, given_ ? default_lights(scene, camera) : preview_lights(scene, camera)});
  }
  const bool is_first_look =
      !given_ && frames_.back().lights && view_.elevation > 0.0 && !is_interior(scene);
  has_ground_ = options.camera.ground.value_or(is_first_look);
  if (!given_) text_ = view_text(scene);
}

CameraSetting CameraSequence::setting(const Scene& scene, int number) const {
  const int frames = options_.output.frames;
  if (frames > 1 && !options_.camera.path.empty()) {
    const double time = (number - 1.0) / (frames - 1.0);
    return completed(camera_at(options_.camera.path, time, Camera::kDefaultFov), options_, scene);
  }
  const double turn = frames > 1 ? (number - 1.0) / frames : 0.0;
  if (given_) {
    const CameraSetting still = completed(*given_, options_, scene);
    return frames > 1 ? orbited(still, turn) : still;
  }
  View view = view_;
  view.azimuth += 360.0 * turn;
  CameraSetting whole =
      frame_scene(scene, aspect_of(options_), options_.camera.fov.value_or(Camera::kDefaultFov),
                  view, frames > 1 ? FrameFit::kCylinder : FrameFit::kVertices);
  whole.lens = options_.camera.lens;
  return whole;
}

std::string CameraSequence::view_text(const Scene& scene) const {
  const CameraSetting camera = setting(scene, 1);
  const glm::dvec3 eye = camera.eye + scene.origin, target = camera.target + scene.origin;
  std::string text =
      "--view " + format_number(view_.azimuth) + "," + format_number(view_.elevation);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(view_.up[axis]) < largest(view_.up)) continue;
    text += std::string(" --up ") + (view_.up[axis] < 0.0 ? "-" : "") + "xyz"[axis];
  }
  if (!options_.camera.up) text += scene.up ? " (of the format)" : " (a guess)";
  text += "; --camera ";
  for (int axis = 0; axis < 3; ++axis) text += format_number(eye[axis]) + ",";
  for (int axis = 0; axis < 3; ++axis) text += format_number(target[axis]) + ",";
  return text + format_number(*camera.fov);
}

std::vector<std::pair<std::string, std::string>> CameraSequence::options() const {
  const RenderOptions& render = options_.render;
  auto all = option_values(options_, kInExr);
  if (render.error == 0.0) std::erase(all, std::pair<std::string, std::string>("error", "0"));
  const double exposure = options_.output.display.exposure;
  if (render.error > 0.0 && exposure != 0.0) all.emplace_back("exposure", number_text(exposure));
  const auto numbers = [](std::initializer_list<double> values) {
    std::string text;
    for (const double value : values)
      text.append(text.empty() ? "" : ",").append(number_text(value));
    return text;
  };
  const CameraOptions& asked = options_.camera;
  std::optional<glm::dvec3> up = asked.up;
  if (given_) {
    const glm::dvec3 &eye = given_->eye, &target = given_->target;
    all.emplace_back("camera",
                     numbers({eye.x, eye.y, eye.z, target.x, target.y, target.z,
                              asked.fov.value_or(given_->fov.value_or(Camera::kDefaultFov))}));
    if (!up) up = given_->up;
  } else {
    all.emplace_back("view", numbers({view_.azimuth, view_.elevation}));
    all.emplace_back("fov", numbers({asked.fov.value_or(Camera::kDefaultFov)}));
    up = view_.up;
  }
  if (up) all.emplace_back("up", numbers({up->x, up->y, up->z}));
  for (auto& word : camera_option_values(frames_.front().camera, options_.environment)) {
    all.push_back(std::move(word));
  }
  if (has_ground_ || !given_) all.emplace_back("ground", has_ground_ ? "on" : "off");
  return all;
}

}  // namespace raygate
