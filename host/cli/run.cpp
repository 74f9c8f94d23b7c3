#include "host/cli/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "host/cli/engines.h"
#include "host/cli/format.h"
#include "host/cli/interrupt.h"
#include "host/cli/outputs.h"
#include "host/cli/progress_bar.h"
#include "host/cli/report.h"
#include "host/cli/version.h"
#include "host/light/lights.h"
#include "host/picture/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/camera_path.h"
#include "host/scene/io/obj_loader.h"
#include "host/scene/io/scene_file.h"
#include "host/tree/bvh.h"

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

/// In the scene's coordinates.
CameraSetting recentred(CameraSetting camera, const Scene& scene) {
  camera.eye -= scene.origin;
  camera.target -= scene.origin;
  return camera;
}

/// The camera of a picture, or of frame `frame` of a film, from 1.
Camera make_camera(const Options& options, const Scene& scene, int frame) {
  const double aspect = static_cast<double>(options.width) / options.height;
  const int frames = options.output.frames;
  if (frames > 1 && !options.path.empty()) {
    const double time = (frame - 1.0) / (frames - 1.0);
    const CameraSetting camera = camera_on_path(options.path, time, Camera::kDefaultFov);
    return Camera::look_at(recentred(camera, scene), aspect);
  }
  const CameraSetting still = options.camera ? recentred(*options.camera, scene)
                                             : framing(scene, aspect, Camera::kDefaultFov);
  return Camera::look_at(frames > 1 ? turned(still, (frame - 1.0) / frames) : still, aspect);
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
          .scene = options.obj().filename().string(),
          .seed = options.seed,
          .world_to_camera = world_to_camera,
          .screen_window_width = static_cast<float>(height * options.width / options.height)};
}

void write_partial(const OutputOptions& outputs, const Film& film, ExrMetadata metadata) {
  metadata.partial = true;
  for (PendingFile& file : make_ready(outputs, film, metadata).files) file.commit();
}

/// Renders with a progress bar, until a signal comes; saves what there is now and then.
Film render_film(const Options& options, const OutputOptions& outputs, const Scene& scene,
                 const Bvh& bvh, const Camera& camera, const ExrMetadata& metadata,
                 RenderStats& stats) {
  RenderOptions render_options{.width = options.width,
                               .height = options.height,
                               .window = options.window,
                               .threads = static_cast<int>(options.threads),
                               .samples = options.light.samples,
                               .filter = options.light.filter,
                               .seed = options.seed,
                               .channels = options.output.needed_channels(),
                               .integrator = options.light.integrator,
                               .max_depth = options.light.max_depth(),
                               .threshold = options.light.threshold,
                               .ambient = options.light.ambient,
                               .skips = options.light.skips,
                               .point_error = options.light.point_error};
  if (outputs.save_seconds > 0.0) {
    render_options.snapshot = [&](const Film& film) { write_partial(outputs, film, metadata); };
    render_options.snapshot_seconds = outputs.save_seconds;
  }
  ProgressBar bar(!options.quiet);
  return render(scene, bvh, camera, render_options, make_finder_factory(options, bvh), stats,
                [&](double fraction) {
                  bar.update(fraction);
                  return InterruptGuard::signal() == 0;
                });
}

std::string listed(const std::vector<std::filesystem::path>& paths) {
  std::string text;
  for (const auto& path : paths) text += (text.empty() ? "" : ", ") + path.string();
  return text;
}

/// Writes what had been rendered when a signal came, if that is anything.
[[noreturn]] void end_interrupted(const OutputOptions& outputs, const Film& film,
                                  const ExrMetadata& metadata) {
  const int signal = InterruptGuard::signal();
  if (std::ranges::all_of(film.primitive, [](auto id) { return id == kNoPrimitive; })) {
    throw Interrupted(signal, "no file was changed");
  }
  write_partial(outputs, film, metadata);
  OutputOptions pictures = outputs;
  pictures.stats.reset();
  throw Interrupted(signal, "wrote what there was: " + listed(pictures.paths()));
}

/// Renders one picture and writes it with `report` completed.
void render_picture(const Options& options, const OutputOptions& outputs, const Scene& scene,
                    const Bvh& bvh, const Camera& camera, Clock::time_point start, Report& report) {
  const ExrMetadata metadata = make_metadata(options, scene, camera);
  const Film film = render_film(options, outputs, scene, bvh, camera, metadata, report.render);
  if (report.render.cancelled) end_interrupted(outputs, film, metadata);

  // All files are made ready before the first takes its name: a full disk changes none of them.
  const Clock::time_point write_start = Clock::now();
  ReadyPictures ready = make_ready(outputs, film, metadata);
  report.pictures = ready.paths;
  report.legends = ready.legends;
  report.write_seconds = seconds_since(write_start);
  report.total_seconds = seconds_since(start);
  if (outputs.stats) ready.files.emplace_back(*outputs.stats, to_json(report));
  for (PendingFile& file : ready.files) file.commit();
}

/// One picture after the other; a line for each.
void render_film_of_frames(const Options& options, const Scene& scene, const Bvh& bvh,
                           Report& report) {
  const int frames = options.output.frames;
  for (int frame = 1; frame <= frames; ++frame) {
    const Clock::time_point start = Clock::now();
    render_picture(options, options.output.numbered(frame), scene, bvh,
                   make_camera(options, scene, frame), start, report);
    if (options.quiet) continue;
    std::printf("frame %d of %d: %s, wrote %s\n", frame, frames,
                format_duration(report.total_seconds).c_str(), listed(report.pictures).c_str());
    std::fflush(stdout);
  }
}

}  // namespace

void run(const Options& options) {
  const Clock::time_point start = Clock::now();
  const int frames = options.output.frames;
  for (int frame = frames == 0 ? 0 : 1; frame <= frames; ++frame) {
    const OutputOptions outputs = frame == 0 ? options.output : options.output.numbered(frame);
    for (const auto& path : outputs.paths()) require_writable(path);
  }
  Report report;
  report.options = options;

  Scene scene = load_obj(options.obj(), {.skip_degenerate = options.skip_degenerate});
  if (options.scene_file) add_lights(*options.scene_file, scene);
  report.load_seconds = seconds_since(start);
  report.triangles = scene.triangles.size();
  print_warnings(scene);

  const Clock::time_point tree_start = Clock::now();
  const Bvh bvh(scene, static_cast<int>(options.threads));
  report.tree_seconds = seconds_since(tree_start);

  const InterruptGuard guard;
  light_if_dark(scene, make_camera(options, scene, 1));
  if (frames > 0) {
    render_film_of_frames(options, scene, bvh, report);
  } else {
    render_picture(options, options.output, scene, bvh, make_camera(options, scene, 1), start,
                   report);
    if (!options.quiet) std::fputs(to_text(report).c_str(), stdout);
  }
}

}  // namespace raygate
