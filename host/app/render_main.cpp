// The program `render`: a scene in, pictures and statistics out.
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/app/built_in.h"
#include "host/app/console.h"
#include "host/app/engines.h"
#include "host/app/load.h"
#include "host/app/options.h"
#include "host/app/outputs.h"
#include "host/app/picture_server.h"
#include "host/base/input_error.h"
#include "host/base/measure.h"
#include "host/bvh/bvh.h"
#include "host/film/display.h"
#include "host/film/film.h"
#include "host/film/merge.h"
#include "host/intersect/check_intersector.h"
#include "host/light/prepared_scene.h"
#include "host/render/renderer.h"
#include "host/scene/instances.h"
#include "host/scene/view.h"

namespace raygate {
namespace {

/// Throws InputError if an output cannot be written or would replace a file that the scene was read
/// from. Only the EXR may replace the film that it resumes.
void check_outputs(const Options& options, std::vector<std::filesystem::path> inputs) {
  require_distinct(options.output.paths(), inputs);
  if (!options.resume.empty()) inputs.push_back(options.resume);
  OutputOptions others = options.output;
  others.exr.reset();
  for (const auto& outputs : {others.paths(), options.core_files.paths()}) {
    require_distinct(outputs, inputs);
  }
}

ExrMetadata make_metadata(const Options& options, const Framing& framing, const Scene& scene,
                          const std::string& digest) {
  const Camera& camera = framing.camera;
  const RenderSettings& render = options.render;
  const glm::dvec3 eye = scene.origin + glm::dvec3(camera.eye());
  glm::mat4 world_to_camera(1.0f);
  const glm::dvec3 axes[] = {camera.right(), camera.up(), camera.forward()};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      world_to_camera[column][row] = static_cast<float>(axes[row][column]);
    }
    world_to_camera[3][row] = static_cast<float>(-glm::dot(axes[row], eye));
  }
  Options same = options;
  same.camera = framing.request;
  const double height = 2.0 * camera.half_height();
  ExrMetadata metadata{
      .software = kSoftware,
      .scene = options.scene_file.obj.filename().string(),
      .seed = render.seed,
      .options = option_values(std::move(same), kInExr),
      .world_to_camera = world_to_camera,
      .screen_window_width = static_cast<float>(height * render.width / render.height)};
  metadata.options.emplace_back(kSceneAttribute, digest);
  if (render.end_sample > 0) set_samples(metadata, {render.first_sample, render.end_sample});
  return metadata;
}

/// Renders with a line of progress and checkpoints. Throws Interrupted when a signal comes.
Film render_monitored(const Options& options, const RenderJob& job, const ExrMetadata& metadata,
                      const IntersectorFactory& make_intersector, RenderStats& stats) {
  ProgressLine line(!options.quiet);
  Checkpointer checkpointer(options.output, metadata, options.threads, line);
  RenderMonitor monitor;
  monitor.progress = [&](double fraction) {
    // Until the first call there is nothing to save, and a signal ends the program.
    if (interruption() == 0) note_interruptions();
    line.update(fraction);
    return interruption() == 0;
  };
  if (options.output.save_seconds > 0.0) {
    monitor.snapshot = [&](const Film* film) { checkpointer.save(film); };
    monitor.snapshot_seconds = options.output.save_seconds;
  }
  // The threads may be deep in a search: end without them.
  monitor.abandon = [&](const Film& film) {
    line.erase();
    std::_Exit(run_guarded([&]() -> int { checkpointer.end_interrupted(film); }));
  };
  Film film = render(job, make_intersector, stats, monitor);
  line.erase();
  if (stats.cancelled) checkpointer.end_interrupted(film);
  if (stats.missing_threads > 0) {
    print_warning("only " + std::to_string(options.threads - stats.missing_threads) + " of " +
                  std::to_string(options.threads) + " threads could be started");
  }
  return film;
}

/// Renders what the options ask for, or serves it. Prints warnings and progress on standard error
/// and the summary on standard output, or on standard error if an output goes there. Throws
/// InputError for errors of the user, EngineMismatch, and other exceptions for internal
/// errors; then no output file has changed. Throws Interrupted after the unfinished pictures were
/// written.
void run(const Options& options) {
  Stopwatch total, lap;
  Report report;
  std::FILE* console = stdout;
  const OutputOptions& outputs = options.output;
  const CoreFileOptions& core_files = options.core_files;
  std::vector<std::filesystem::path> paths = outputs.paths();
  if (options.serve) paths.clear();
  for (const auto& path : core_files.paths()) paths.push_back(path);
  for (const auto& path : paths) {
    require_writable(path);
    if (is_standard_output(path)) console = stderr;
  }

  Scene scene =
      load(options.scene_file,
           {.smooth = options.smooth,
            .vertices = options.rounds_vertices ? Vertices::kBinary32 : Vertices::kAsPictures},
           options.environment, options.camera.up);
  report.load_seconds = lap.lap();
  report.triangles = triangle_count(scene);
  report.rounding = scene.rounding;
  const std::string digest = digest_of(scene);  // without default lights and ground
  print_warnings(scene.warnings, options.verbose);
  std::vector<std::filesystem::path> inputs = scene.files;
  inputs.push_back(options.scene);
  check_outputs(options, std::move(inputs));

  // The ground is added after framing, so that it is not framed.
  const RenderSettings& settings = options.render;
  const Framing framing =
      frame_picture(options.camera, scene, static_cast<double>(settings.width) / settings.height);
  const Scene unframed = options.serve ? scene : Scene();
  if (framing.has_ground) add_ground(scene, framing.up);
  report.view = framing.text;
  if (settings.caustics == Caustics::kOn &&
      (framing.lights || framing.camera.projection() != Projection::kPerspective)) {
    throw InputError("--caustics on: expected a perspective camera and a scene with lights");
  }
  resolve_instances(scene, options.instances, options.scene);
  if (core_files.paths().empty()) prepare_engine(options);
  lap.lap();
  const Bvh bvh(scene, options.threads);
  report.tree_seconds = lap.lap();
  const PreparedScene prepared(scene, bvh);
  if (options.serve) return serve_pictures(options, {unframed, prepared, framing.has_ground});

  const auto image = make_memory_image(options, bvh);
  if (!core_files.image.empty()) print(dump_image(core_files, *image), console);
  if (!core_files.wave.empty()) {
    const glm::dvec2 middle = glm::dvec2(core_files.pixel) + 0.5;
    const Ray ray = framing.camera.ray(middle.x / settings.width, middle.y / settings.height, {});
    print(trace_pixel(core_files, bvh, image, ray), console);
  }
  if (!core_files.paths().empty()) return;

  const ExrMetadata metadata = make_metadata(options, framing, scene, digest);
  std::optional<Film> unfinished;
  if (!options.resume.empty()) unfinished = read_unfinished(options, metadata);
  const RenderJob job{prepared, framing.camera, settings, framing.lights,
                      unfinished ? &*unfinished : nullptr};
  const Film film = render_monitored(options, job, metadata,
                                     make_intersector_factory(options, bvh, image), report.render);

  // All files are staged before the first takes its name: a full disk changes none of them.
  lap.lap();
  StagedFiles staged = stage_files(outputs, film, metadata, options.threads);
  report.pictures = staged.paths;
  report.legends = staged.legends;
  report.write_seconds = lap.lap();
  report.total_seconds = total.lap();
  if (outputs.stats) staged.files.emplace_back(*outputs.stats, to_json(report, options));
  for (AtomicFile& file : staged.files) file.commit();
  if (!options.quiet) print(to_text(report, options), console);
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  return raygate::run_main(argc, argv, [](const std::vector<std::string>& words) {
    raygate::run(raygate::parse_options(words));
    return 0;
  });
}
