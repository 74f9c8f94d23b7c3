#include "host/app/load.h"

#include <cmath>
#include <filesystem>

#include "host/app/console.h"
#include "host/base/input_error.h"
#include "host/exact/exact.h"
#include "host/film/environment_file.h"
#include "host/scene/instances.h"
#include "host/scene/view.h"

namespace raygate {
Scene load(const SceneFile& file, const LoadOptions& options, const EnvironmentSetting& environment,
           const std::optional<glm::dvec3>& up) {
  std::error_code ignored;
  if (file.obj != file.file && !std::filesystem::exists(file.obj, ignored)) {
    throw InputError(file.file.string() + ": found no " + file.obj.lexically_normal().string() +
                     ", expected this model, or \"obj\" to name another; for scenes/: make cpu");
  }
  Scene scene = load_scene(file, options);
  require_numbers(scene, file.file);
  if (environment.file.empty()) return scene;
  const std::optional<glm::dvec3>& of_file =
      file.camera.camera ? file.camera.camera->up : file.camera.up;
  load_environment(environment, up.value_or(of_file.value_or(scene.up)), scene);
  return scene;
}

namespace {

/// Returns the options for a view: "--view 33,24 --up y (usual in the format); --camera ...".
std::string view_text(const CameraRequest& request, const Scene& scene, const View& view,
                      const CameraSetting& camera) {
  std::string text = "--view " + format_number(view.azimuth) + "," + format_number(view.elevation);
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(view.up[axis]) < largest(view.up)) continue;
    text += std::string(" --up ") + (view.up[axis] < 0.0 ? "-" : "") + "xyz"[axis];
  }
  if (!request.up) text += " (usual in the format)";
  const glm::dvec3 eye = camera.eye + scene.origin, target = camera.target + scene.origin;
  text += "; --camera ";
  for (int i = 0; i < 6; ++i) text += format_number((i < 3 ? eye : target)[i % 3]) + ",";
  return text + format_number(*camera.fov);
}

}  // namespace

Framing frame_picture(const CameraRequest& request, const Scene& scene, double aspect) {
  const std::optional<CameraSetting> given = request.camera   ? request.camera
                                             : request.angles ? std::nullopt
                                                              : scene.camera;
  const double fov = request.fov.value_or(Camera::kDefaultFov);
  const bool is_view = !given && !request.eye;
  const auto [azimuth, elevation] =
      request.angles.value_or(std::pair(kDefaultAzimuth, kDefaultElevation));
  const View view{azimuth, elevation, request.up.value_or(scene.up)};
  CameraSetting setting = given ? *given : frame_scene(scene, aspect, fov, view);
  if (given) {
    setting.eye -= scene.origin;
    setting.target -= scene.origin;
  }
  setting.lens = setting.lens.overridden_by(request.lens);
  if (!setting.fov && scene.camera) setting.fov = scene.camera->fov;
  if (request.eye) setting.eye = *request.eye - scene.origin;
  if (request.target) setting.target = *request.target - scene.origin;
  if (request.up && !is_view) setting.up = request.up;
  if (request.fov) setting.fov = request.fov;
  const Camera camera = Camera::look_at(setting, aspect);
  const auto lights = default_lights(scene, camera, is_view);
  const bool needs_ground = is_view && lights && view.elevation > 0.0;
  Framing framing{camera, lights, request.ground.value_or(needs_ground), view.up, "", {}};
  CameraRequest& same = framing.request;
  same.up = request.up;
  if (is_view) {
    framing.text = view_text(request, scene, view, setting);
    same.angles = {view.azimuth, view.elevation};
    same.fov = fov;
    same.up = view.up;
  } else {
    same.camera = setting;
    same.camera->eye = request.eye ? *request.eye : given->eye;
    same.camera->target = request.target ? *request.target
                          : given        ? given->target
                                         : setting.target + scene.origin;
    if (!same.up) same.up = setting.up;
  }
  if (camera.projection() != Projection::kPerspective) same.lens.projection = camera.projection();
  if (camera.aperture() > 0.0) {
    same.lens.aperture = camera.aperture();
    same.lens.focus = camera.focus();
  }
  if (framing.has_ground || is_view) same.ground = framing.has_ground;
  return framing;
}

}  // namespace raygate
