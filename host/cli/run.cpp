#include "host/cli/run.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/base/input_error.h"
#include "host/bvh/bvh.h"
#include "host/cli/camera_sequence.h"
#include "host/cli/engines.h"
#include "host/cli/format.h"
#include "host/cli/output_files.h"
#include "host/cli/picture_server.h"
#include "host/cli/process.h"
#include "host/cli/progress_bar.h"
#include "host/cli/report.h"
#include "host/film/display.h"
#include "host/film/environment_file.h"
#include "host/film/film.h"
#include "host/film/merge.h"
#include "host/light/prepared_scene.h"
#include "host/options/version.h"
#include "host/ranks/ranks.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/instances.h"
#include "host/scene/io/scene_file.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/scene.h"
#include "host/scene/view.h"

namespace raygate {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A warning without its place, names and numbers.
std::string kind_of(const std::string& warning) {
  const std::size_t colon = warning.find(": ");
  std::string kind;
  bool is_quoted = false;
  for (std::size_t i = colon == std::string::npos ? 0 : colon; i < warning.size(); ++i) {
    const char c = warning[i];
    if (c == '\'') is_quoted = !is_quoted;
    if (!is_quoted && !(c >= '0' && c <= '9')) kind += c;
  }
  return kind;
}

/// Each once; of those of one kind the first, and how many there are, or `all`.
void print_warnings(const Scene& scene, bool all) {
  std::set<std::string> seen;
  std::map<std::string, int> more;  // of each kind
  std::vector<const std::string*> first;
  for (const std::string& warning : scene.warnings) {
    if (!seen.insert(warning).second) continue;
    const auto [kind, is_new] = more.try_emplace(all ? warning : kind_of(warning), 0);
    if (is_new) {
      first.push_back(&warning);
    } else {
      ++kind->second;
    }
  }
  for (const std::string* warning : first) {
    const int count = more[all ? *warning : kind_of(*warning)];
    print_warning(
        *warning +
        (count == 0 ? "" : " (and " + format_count(count) + " more such; --verbose lists them)"));
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

/// Upwards on the command line, in the scene file, or a guess.
glm::dvec3 environment_up(const Options& options, const Scene& scene) {
  if (options.camera.up) return *options.camera.up;
  if (options.scene_file && options.scene_file->up) return *options.scene_file->up;
  return guess_up_axis(scene);
}

Scene load(const Options& options) {
  require_scene(options);
  const LoadOptions load_options{.strict = options.strict,
                                 .keep_instances = true,
                                 .smooth = options.smooth,
                                 .smooth_if_unsaid = options.is_bare_model,
                                 .threads = options.threads};
  Scene scene =
      load_scene(options.scene_file.value_or(SceneFile{.obj = options.scene}), load_options);
  require_numbers(scene, options.scene);
  if (options.environment) {
    load_environment(*options.environment, environment_up(options, scene), scene);
  }
  return scene;
}

/// A run of the program: a scene, and the pictures of it.
class Run {
 public:
  Run(const Options& options, Ranks& ranks) : options_(options), ranks_(ranks) {
    const int frames = options.output.frames;
    if (frames == 0) outputs_.push_back(options.output);
    for (int frame = 1; frame <= frames; ++frame) {
      outputs_.push_back(options.output.numbered(frame));
    }
  }

  void operator()() {
    if (!options_.serve) check_outputs();
    report_.options = options_;
    report_.ranks = ranks_.count();
    scene_ = load(options_);
    report_.load_seconds = seconds_since(start_);
    report_.triangles = triangle_count(scene_);
    report_.rounding = scene_.rounding;
    scene_digest_ = digest_of(scene_);
    if (ranks_.index() == 0) print_warnings(scene_, options_.verbose);
    require_inputs_kept();

    // Cameras and lights are found before there is a ground, which is not to be framed.
    const CameraSequence cameras(options_, scene_);
    const Scene unframed = options_.serve ? scene_ : Scene();
    if (cameras.has_ground()) add_ground(scene_, cameras.up());
    report_.view = cameras.text();
    if (options_.render.caustics == Caustics::kOn &&
        (cameras.frame(1).lights ||
         cameras.frame(1).camera.projection() != Projection::kPerspective)) {
      throw InputError("--caustics on: expected a perspective camera and a scene with lights");
    }
    resolve_instances(scene_, options_.instances, options_.scene);

    const bool is_rendering = options_.core_files.paths().empty();
    if (is_rendering) prepare_engine(options_);
    const Clock::time_point tree_start = Clock::now();
    const Bvh bvh(scene_, options_.threads);
    report_.tree_seconds = seconds_since(tree_start);
    const PreparedScene prepared(scene_, bvh);
    if (options_.serve) {
      if (ranks_.index() == 0) serve_pictures(options_, {unframed, prepared, cameras.has_ground()});
      return;
    }
    image_ = make_memory_image(options_, bvh);
    if (!is_rendering) {
      if (ranks_.index() == 0) write_core_files(bvh, cameras.frame(1).camera);
    } else if (options_.output.frames > 0) {
      render_animation(prepared, cameras);
    } else {
      render_picture(prepared, cameras, 1, ranks_, start_);
      if (!options_.quiet && ranks_.index() == 0) print(to_text(report_), console_);
    }
  }

 private:
  void check_outputs() {
    for (const OutputOptions& outputs : outputs_) {
      if (ranks_.index() != 0 && options_.output.frames == 0) break;  // rank 0 writes
      for (const auto& path : outputs.paths()) {
        require_writable(path);
        // What is for people makes room for what is for programs.
        if (is_standard_output(path)) console_ = stderr;
      }
    }
    for (const auto& path : options_.core_files.paths()) require_writable(path);
  }

  /// No output may take the place of a file that the scene was read from.
  void require_inputs_kept() const {
    std::vector<std::filesystem::path> inputs = scene_.files;
    inputs.push_back(options_.scene);
    for (const OutputOptions& outputs : outputs_) require_distinct(outputs.paths(), inputs);
    require_distinct(options_.core_files.paths(), inputs);
    // A film may take the place of the one that it goes on from; nothing else may.
    if (options_.resume.empty()) return;
    OutputOptions besides = options_.output;
    besides.exr.reset();
    const std::vector<std::filesystem::path> resumed = {options_.resume};
    require_distinct(besides.paths(), resumed);
    require_distinct(options_.core_files.paths(), resumed);
  }

  void write_core_files(const Bvh& bvh, const Camera& camera) const {
    const CoreFileOptions& files = options_.core_files;
    if (!files.image.empty()) print(dump_image(files, *image_), console_);
    if (!files.pixel) return;
    const glm::ivec2& pixel = *files.pixel;
    const Ray ray = camera.ray((pixel.x + 0.5) / options_.render.width,
                               (pixel.y + 0.5) / options_.render.height, glm::dvec2(0.0));
    print(trace_pixel(options_, files, bvh, image_, ray), console_);
  }

  /// One picture after the other, each by the rank that is free; a line for each.
  void render_animation(const PreparedScene& prepared, const CameraSequence& cameras) {
    const int frames = options_.output.frames;
    JobQueue jobs(ranks_, frames);
    while (const auto job = jobs.next()) {
      const int frame = *job + 1;
      Ranks alone;
      const bool is_new = render_picture(prepared, cameras, frame, alone, Clock::now());
      if (options_.quiet) continue;
      print("frame " + std::to_string(frame) + " of " + std::to_string(frames) + ": " +
                (is_new ? format_duration(report_.total_seconds) + ", wrote " +
                              listed(report_.pictures)
                        : "kept " + outputs_of(frame).exr->string()) +
                "\n",
            console_);
      flush_standard_output();
    }
  }

  /// Renders a picture, numbered from 1, and writes it with the report completed; false if it is a
  /// frame whose files are there.
  bool render_picture(const PreparedScene& prepared, const CameraSequence& cameras, int number,
                      Ranks& ranks, Clock::time_point start) {
    const auto& [camera, lights] = cameras.frame(number);
    const OutputOptions& outputs = outputs_of(number);
    const ExrMetadata metadata = make_metadata(cameras, camera);
    std::optional<Film> unfinished;
    if (ranks.index() == 0 && !options_.resume.empty()) {
      if (options_.output.frames == 0) {
        unfinished = read_unfinished(options_, options_.resume, metadata);
      } else {
        FoundFrame found = find_frame(options_, outputs, metadata);
        if (found.is_finished) return false;
        if (!found.damage.empty()) print_warning(found.damage + "; the frame is rendered again");
        unfinished = std::move(found.unfinished);
      }
    }
    RenderOptions render_options = options_.render;
    render_options.threads = options_.threads;
    render_options.lights = lights;
    render_options.ranks = &ranks;
    render_options.unfinished = unfinished ? &*unfinished : nullptr;
    render_options.exposure = options_.output.display.exposure;
    render_options.channels = outputs.needed_channels();
    // What a rank that dies has not sent is there to resume from.
    // So is what a resumed render has reached when it is interrupted again.
    if (ranks.count() > 1 || unfinished) render_options.channels.sums = true;
    Film film = render_monitored(prepared, camera, render_options, outputs, metadata);
    ranks.leave();
    if (ranks.index() != 0) return true;
    film.keeps_sums = outputs.needed_channels().sums;
    const std::string blank = why_blank(film, outputs.display);
    if (!blank.empty() && number == 1) print_warning(blank);

    // All files are staged before the first takes its name: a full disk changes none of them.
    const Clock::time_point write_start = Clock::now();
    StagedFiles staged = stage_files(outputs, film, metadata, options_.threads);
    report_.pictures = staged.paths;
    report_.legends = staged.legends;
    report_.write_seconds = seconds_since(write_start);
    report_.total_seconds = seconds_since(start);
    if (outputs.stats) staged.files.emplace_back(*outputs.stats, to_json(report_));
    for (AtomicFile& file : staged.files) file.commit();
    return true;
  }

  /// Renders with a progress bar and checkpoints. Throws Interrupted when a signal comes.
  Film render_monitored(const PreparedScene& prepared, const Camera& camera,
                        const RenderOptions& options, const OutputOptions& outputs,
                        const ExrMetadata& metadata) {
    const bool has_ranks = options.ranks->count() > 1, is_first = options.ranks->index() == 0;
    ProgressBar bar(!options_.quiet && is_first,
                    has_ranks ? ProgressBar::Style::kLines : ProgressBar::Style::kBar);
    Checkpointer checkpointer(outputs, options_.output, metadata, options_.threads, bar);
    RenderMonitor monitor;
    monitor.progress = [&](double fraction) {
      // Before there is something to save, a signal simply ends the program.
      if (interruption() == 0) note_interruptions();
      bar.update(fraction);
      return interruption() == 0;
    };
    if (outputs.save_seconds > 0.0) {
      monitor.snapshot = [&](const Film* film) { checkpointer.save(film); };
      monitor.snapshot_seconds = outputs.save_seconds;
    }
    if (has_ranks) {
      note_warnings();
      monitor.is_urgent = take_warning;
      monitor.urgent_snapshot = [&](const Film* film) { checkpointer.save_urgently(film); };
    }
    // The threads are deep in a search and will not stop soon: end without them.
    monitor.abandon = [&](const Film& film) {
      bar.erase();
      std::_Exit(run_guarded([&]() -> int { checkpointer.end_interrupted(film); }, 1));
    };
    RenderStats& stats = report_.render;
    Film film = render(prepared, camera, options,
                       make_intersector_factory(options_, prepared.bvh, options.skips, image_),
                       stats, monitor);
    bar.erase();
    if (stats.cancelled) {
      if (!is_first) throw Interrupted(interruption(), "rank 0 has the picture");
      checkpointer.end_interrupted(film);
    }
    if (stats.missing_threads > 0) {
      print_warning("only " + std::to_string(options_.threads - stats.missing_threads) + " of " +
                    std::to_string(options_.threads) + " threads could be started");
    }
    return film;
  }

  [[nodiscard]] ExrMetadata make_metadata(const CameraSequence& cameras,
                                          const Camera& camera) const {
    const RenderOptions& render = options_.render;
    const glm::dvec3 eye = scene_.origin + glm::dvec3(camera.eye());
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
        .scene = options_.obj().filename().string(),
        .seed = render.seed,
        .options = cameras.options(),
        .world_to_camera = world_to_camera,
        .screen_window_width = static_cast<float>(height * render.width / render.height)};
    metadata.options.emplace_back(kSceneAttribute, scene_digest_);
    if (render.end_sample > 0) set_samples(metadata, {render.first_sample, render.end_sample});
    return metadata;
  }

  [[nodiscard]] const OutputOptions& outputs_of(int number) const {
    return outputs_[static_cast<std::size_t>(number - 1)];
  }

  const Clock::time_point start_ = Clock::now();
  const Options& options_;
  Ranks& ranks_;
  std::vector<OutputOptions> outputs_;  // of each picture
  std::FILE* console_ = stdout;
  Scene scene_;
  std::string scene_digest_;                  // of the files, without default lights and ground
  std::shared_ptr<const MemoryImage> image_;  // of a ray core
  Report report_;
};

}  // namespace

void run(const Options& options, Ranks& ranks) { Run(options, ranks)(); }

}  // namespace raygate
