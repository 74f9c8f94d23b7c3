#include "host/cli/run.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/accel/bvh.h"
#include "host/cli/engines.h"
#include "host/cli/interrupt.h"
#include "host/cli/progress_bar.h"
#include "host/cli/report.h"
#include "host/cli/version.h"
#include "host/image/exr.h"
#include "host/image/pending_file.h"
#include "host/image/png.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/obj_loader.h"

namespace raygate {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void print_warnings(const Scene& scene) {
  std::set<std::string> printed;
  for (const std::string& warning : scene.warnings) {
    if (printed.insert(warning).second) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  }
}

Camera make_camera(const Options& options, const Scene& scene) {
  const double aspect = static_cast<double>(options.width) / options.height;
  if (!options.camera) return Camera::frame(scene, aspect);
  const CameraPlacement& placement = *options.camera;
  const glm::dvec3 view = placement.target - placement.eye;
  // +y is up in a picture; where the view goes along it, up is what a map has there: -z.
  const bool vertical = view.x == 0.0 && view.z == 0.0;
  const glm::dvec3 up = vertical ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(0.0, 1.0, 0.0);
  return Camera::look_at(placement.eye - scene.origin, placement.target - scene.origin, up,
                         placement.fov.value_or(Camera::kDefaultFov), aspect);
}

ExrMetadata make_metadata(const Options& options, const Scene& scene, const Camera& camera) {
  const glm::dvec3 eye = scene.origin + glm::dvec3(camera.eye());
  glm::mat4 world_to_camera(1.0f);
  const glm::dvec3 axes[] = {camera.right(), camera.up(), camera.forward()};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      world_to_camera[column][row] = static_cast<float>(axes[row][column]);
    }
    world_to_camera[3][row] = static_cast<float>(-glm::dot(axes[row], eye));
  }
  const double height = 2.0 * std::tan(glm::radians(camera.vertical_fov_degrees()) / 2.0);
  return {.software = kSoftware,
          .scene = options.scene.filename().string(),
          .seed = options.seed,
          .world_to_camera = world_to_camera,
          .screen_window_width = static_cast<float>(height * options.width / options.height)};
}

/// Renders with a progress bar; throws Interrupted if a signal stopped it.
Film render_film(const Options& options, const Scene& scene, const Bvh& bvh, const Camera& camera,
                 RenderStats& stats) {
  const RenderOptions render_options{.width = options.width,
                                     .height = options.height,
                                     .window = options.window,
                                     .threads = static_cast<int>(options.threads),
                                     .seed = options.seed};
  ProgressBar bar(!options.quiet);
  Film film = render(scene, bvh, camera, render_options, make_tester_factory(options), stats,
                     [&](double fraction) {
                       bar.update(fraction);
                       return InterruptGuard::signal() == 0;
                     });
  if (InterruptGuard::signal() != 0) throw Interrupted(InterruptGuard::signal());
  return film;
}

}  // namespace

void run(const Options& options) {
  const Clock::time_point start = Clock::now();
  for (const auto& output : {options.exr, options.png, options.stats}) {
    if (output) require_writable(*output);
  }
  Report report;
  report.options = options;

  const Scene scene = load_obj(options.scene, {.skip_degenerate = options.skip_degenerate});
  report.load_seconds = seconds_since(start);
  report.triangles = scene.triangles.size();
  print_warnings(scene);

  const Clock::time_point tree_start = Clock::now();
  const Bvh bvh(scene);
  report.tree_seconds = seconds_since(tree_start);

  const InterruptGuard guard;
  const Camera camera = make_camera(options, scene);
  const Film film = render_film(options, scene, bvh, camera, report.render);

  // All files are made ready before the first takes its name: a full disk changes none of them.
  const Clock::time_point write_start = Clock::now();
  std::vector<PendingFile> files;
  if (options.exr) {
    files.emplace_back(*options.exr, encode_exr(film, make_metadata(options, scene, camera)));
    report.pictures.push_back(*options.exr);
  }
  if (options.png) {
    files.emplace_back(*options.png, encode_png(film));
    report.pictures.push_back(*options.png);
  }
  report.write_seconds = seconds_since(write_start);
  report.total_seconds = seconds_since(start);
  if (options.stats) files.emplace_back(*options.stats, to_json(report));
  for (PendingFile& file : files) file.commit();
  if (!options.quiet) std::fputs(to_text(report).c_str(), stdout);
}

}  // namespace raygate
