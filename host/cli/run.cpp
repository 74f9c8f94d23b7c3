#include "host/cli/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "host/base/input_error.h"
#include "host/bvh/bvh.h"
#include "host/cli/camera_sequence.h"
#include "host/cli/checkpointer.h"
#include "host/cli/engines.h"
#include "host/cli/format.h"
#include "host/cli/output_files.h"
#include "host/cli/process.h"
#include "host/cli/progress_bar.h"
#include "host/cli/report.h"
#include "host/cli/resume.h"
#include "host/cli/version.h"
#include "host/film/environment_file.h"
#include "host/light/neighbor_clearance.h"
#include "host/ranks/job_queue.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/view.h"
#include "host/scene/instances.h"
#include "host/scene/io/scene_file.h"
#include "host/scene/io/scene_loader.h"

namespace raygate {
namespace {

using Clock = std::chrono::steady_clock;
using CoreImage = std::shared_ptr<const MemoryImage>;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void print_warnings(const Scene& scene) {
  std::set<std::string> printed;
  for (const std::string& warning : scene.warnings) {
    if (printed.insert(warning).second) print_warning(warning);
  }
}

/// The scene that a scene file is about may be one that a script makes.
void require_scene(const Options& options) {
  std::error_code ignored;
  if (!options.scene_file || std::filesystem::exists(options.obj(), ignored)) return;
  const std::filesystem::path& file = options.scene_file->file;
  const std::string scene = options.obj().lexically_normal().string();
  const std::filesystem::path script =
      file.parent_path() / ("make_" + file.stem().string() + ".py");
  throw InputError(file.string() + ": found no " + scene + ", expected the scene that it is about" +
                   (std::filesystem::exists(script, ignored)
                        ? "; `make verilate` makes it, and so does `python3 " + script.string() +
                              " " + scene + "`"
                        : ""));
}

/// No output may take the place of a file that the scene was read from.
void require_inputs_kept(const Options& options, const Scene& scene) {
  std::vector<std::filesystem::path> inputs = scene.files;
  inputs.push_back(options.scene);
  const int frames = options.output.frames;
  for (int frame = frames == 0 ? 0 : 1; frame <= frames; ++frame) {
    require_distinct(frame == 0 ? options.output.paths() : options.output.numbered(frame).paths(),
                     inputs);
  }
  require_distinct(options.core_files.paths(), inputs);
}

ExrMetadata make_metadata(const Options& options, const Scene& scene, const CameraSequence& cameras,
                          const Camera& camera) {
  const glm::dvec3 eye = scene.origin + glm::dvec3(camera.eye());
  glm::mat4 world_to_camera(1.0f);
  const glm::dvec3 axes[] = {camera.right(), camera.up(), camera.forward()};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      world_to_camera[column][row] = static_cast<float>(axes[row][column]);
    }
    world_to_camera[3][row] = static_cast<float>(-glm::dot(axes[row], eye));
  }
  const double height = 2.0 * camera.half_height();
  ExrMetadata metadata{
      .software = kSoftware,
      .scene = options.obj().filename().string(),
      .seed = options.seed,
      .options = cameras.options(),
      .world_to_camera = world_to_camera,
      .screen_window_width = static_cast<float>(height * options.width / options.height)};
  if (options.light.range) set_samples(metadata, *options.light.range);
  return metadata;
}

/// Renders with a progress bar. Throws Interrupted when a signal comes.
Film render_film(const Options& options, const OutputOptions& outputs, const Scene& scene,
                 const NeighborClearances& clearances, const CoreImage& image, const Camera& camera,
                 const ExrMetadata& metadata, const Film* begun, Ranks& ranks, RenderStats& stats) {
  const SampleRange all{0, options.light.samples};
  const auto threads = static_cast<int>(options.threads);
  RenderOptions render_options{.width = options.width,
                               .height = options.height,
                               .window = options.window,
                               .threads = threads,
                               .ranks = &ranks,
                               .samples = options.light.samples,
                               .first_sample = options.light.range.value_or(all).first,
                               .end_sample = options.light.range.value_or(all).end,
                               .begun = begun,
                               .error = options.light.error,
                               .exposure = options.output.display.exposure,
                               .filter = options.light.filter,
                               .seed = options.seed,
                               .channels = options.output.needed_channels(),
                               .integrator = options.light.integrator,
                               .max_depth = options.light.max_depth(),
                               .threshold = options.light.threshold,
                               .ambient = options.light.ambient,
                               .skips = options.light.skips,
                               .point_error = options.light.point_error};
  // What a rank that dies has not brought down is there to go on from.
  if (ranks.count() > 1) render_options.channels.sums = true;
  ProgressBar bar(!options.quiet && ranks.index() == 0,
                  ranks.count() > 1 ? ProgressBar::Style::kLines : ProgressBar::Style::kBar);
  Checkpointer checkpointer(outputs, options.output, metadata, threads, bar);
  if (outputs.save_seconds > 0.0) {
    render_options.snapshot = [&](const Film& film) { checkpointer.save(film); };
    render_options.snapshot_seconds = outputs.save_seconds;
  }
  if (ranks.count() > 1) {
    note_warnings();
    render_options.is_urgent = take_warning;
    render_options.urgent_snapshot = [&](const Film& film) { checkpointer.save_urgently(film); };
  }
  // The threads are deep in a search and will not stop soon: end without them.
  render_options.abandon = [&](const Film& film) {
    bar.erase();
    std::_Exit(run_guarded([&]() -> int { checkpointer.end_interrupted(film); }, 1));
  };
  Film film =
      render(scene, clearances, camera, render_options,
             make_intersector_factory(options, clearances.bvh(), options.light.skips, image), stats,
             [&](double fraction) {
               // Before there is something to save, a signal simply ends the program.
               if (interruption() == 0) note_interruptions();
               bar.update(fraction);
               return interruption() == 0;
             });
  bar.erase();
  if (stats.cancelled) {
    if (ranks.index() != 0) throw Interrupted(interruption(), "rank 0 has the picture");
    checkpointer.end_interrupted(film);
  }
  if (stats.missing_threads > 0) {
    print_warning("only " + std::to_string(options.threads - stats.missing_threads) + " of " +
                  std::to_string(options.threads) + " threads could be started");
  }
  return film;
}

/// Renders one picture and writes it with `report` completed; false if it is a frame whose files
/// are there.
bool render_picture(const Options& options, const OutputOptions& outputs, const Scene& scene,
                    const NeighborClearances& clearances, const CoreImage& image,
                    const CameraSequence& cameras, const Camera& camera, Clock::time_point start,
                    Ranks& ranks, Report& report) {
  const ExrMetadata metadata = make_metadata(options, scene, cameras, camera);
  const bool is_ours = ranks.index() == 0;
  std::optional<Film> begun;
  if (is_ours && !options.resume.empty()) {
    if (options.output.frames == 0) {
      begun = read_unfinished(options, options.resume, metadata);
    } else {
      FoundFrame found = find_frame(options, outputs, metadata);
      if (found.is_finished) return false;
      begun = std::move(found.begun);
    }
  }
  Film film = render_film(options, outputs, scene, clearances, image, camera, metadata,
                          begun ? &*begun : nullptr, ranks, report.render);
  ranks.leave();
  if (!is_ours) return true;
  film.keeps_sums = outputs.needed_channels().sums;

  // All files are made ready before the first takes its name: a full disk changes none of them.
  const Clock::time_point write_start = Clock::now();
  StagedFiles ready = stage_files(outputs, film, metadata, static_cast<int>(options.threads));
  report.pictures = ready.paths;
  report.legends = ready.legends;
  report.write_seconds = seconds_since(write_start);
  report.total_seconds = seconds_since(start);
  if (outputs.stats) ready.files.emplace_back(*outputs.stats, to_json(report));
  for (AtomicFile& file : ready.files) file.commit();
  return true;
}

/// One picture after the other, each by the rank that is free; a line for each.
void render_animation(const Options& options, Scene& scene, const NeighborClearances& clearances,
                      const CoreImage& image, const CameraSequence& cameras, Ranks& ranks,
                      Report& report, std::FILE* console) {
  const int frames = options.output.frames;
  JobQueue jobs(ranks, frames);
  while (const auto job = jobs.next()) {
    const int frame = *job + 1;
    const Clock::time_point start = Clock::now();
    Ranks alone;
    const OutputOptions outputs = options.output.numbered(frame);
    const bool is_new = render_picture(options, outputs, scene, clearances, image, cameras,
                                       cameras.light(frame, scene), start, alone, report);
    if (options.quiet) continue;
    print("frame " + std::to_string(frame) + " of " + std::to_string(frames) + ": " +
              (is_new ? format_duration(report.total_seconds) + ", wrote " + listed(report.pictures)
                      : "kept " + outputs.exr->string()) +
              "\n",
          console);
    flush_standard_output();
  }
}

/// Upwards on the command line, in the scene file, or a guess.
glm::dvec3 environment_up(const Options& options, const Scene& scene) {
  if (options.view.up) return *options.view.up;
  if (options.scene_file && options.scene_file->up) return *options.scene_file->up;
  return guess_up_axis(scene);
}

}  // namespace

void run(const Options& options, Ranks& ranks) {
  const Clock::time_point start = Clock::now();
  const int frames = options.output.frames;
  std::FILE* console = stdout;
  const bool writes = ranks.index() == 0 || frames > 0;
  for (int frame = frames == 0 ? 0 : 1; writes && frame <= frames; ++frame) {
    const OutputOptions outputs = frame == 0 ? options.output : options.output.numbered(frame);
    for (const auto& path : outputs.paths()) {
      require_writable(path);
      // What is for people makes room for what is for programs.
      if (is_standard_output(path)) console = stderr;
    }
  }
  for (const auto& path : options.core_files.paths()) require_writable(path);
  Report report;
  report.options = options;
  report.ranks = ranks.count();

  require_scene(options);
  if (!options.core_files.pixel) prepare_engine(options);
  const LoadOptions load_options{.strict = options.strict,
                                 .keep_instances = true,
                                 .smooth = options.smooth,
                                 .threads = static_cast<int>(options.threads)};
  Scene scene = options.scene_file ? load_scene(*options.scene_file, load_options)
                                   : load_scene(options.scene, load_options);
  if (options.scene_file) add_lights(*options.scene_file, scene);
  if (options.environment) {
    load_environment(*options.environment, environment_up(options, scene), scene);
  }
  report.load_seconds = seconds_since(start);
  report.triangles = triangle_count(scene);
  if (ranks.index() == 0) print_warnings(scene);
  require_inputs_kept(options, scene);

  // Cameras and lights are found before there is a ground, which is not to be framed.
  const CameraSequence cameras(options, scene);
  if (cameras.has_ground()) add_ground(scene, cameras.up());
  report.view = cameras.text();
  resolve_instances(scene, options.instances, options.scene);

  const Clock::time_point tree_start = Clock::now();
  const Bvh bvh(scene, static_cast<int>(options.threads));
  report.tree_seconds = seconds_since(tree_start);
  const NeighborClearances clearances(bvh);
  const CoreImage image = make_memory_image(options, options.core_files, bvh);
  if (const auto& pixel = options.core_files.pixel) {
    const Ray ray = cameras.light(1, scene).ray((pixel->x + 0.5) / options.width,
                                                (pixel->y + 0.5) / options.height, glm::dvec2(0.0));
    if (ranks.index() == 0) {
      print(trace_pixel(options, options.core_files, bvh, image, ray), console);
    }
    return;
  }

  if (frames > 0) {
    render_animation(options, scene, clearances, image, cameras, ranks, report, console);
  } else {
    render_picture(options, options.output, scene, clearances, image, cameras,
                   cameras.light(1, scene), start, ranks, report);
    if (!options.quiet && ranks.index() == 0) print(to_text(report), console);
  }
}

}  // namespace raygate
