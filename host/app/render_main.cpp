// The program `render`: a scene in, pictures and statistics out.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/app/console.h"
#include "host/app/engines.h"
#include "host/app/load.h"
#include "host/app/options.h"
#include "host/app/output_files.h"
#include "host/app/picture_server.h"
#include "host/app/process.h"
#include "host/app/report.h"
#include "host/app/version.h"
#include "host/base/input_error.h"
#include "host/bvh/bvh.h"
#include "host/exact/ieee_floats.h"
#include "host/film/display.h"
#include "host/film/film.h"
#include "host/film/merge.h"
#include "host/light/prepared_scene.h"
#include "host/render/renderer.h"
#include "host/scene/instances.h"
#include "host/scene/view.h"

namespace raygate {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns a warning without its place, quoted names and numbers.
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

/// Prints the scene's warnings: the first of each kind and the number of the others, or `all`.
void print_warnings(const Scene& scene, bool all) {
  std::set<std::string> seen;
  std::map<std::string, int> more;  // by kind, without the first
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

/// One run of the program.
class Run {
 public:
  explicit Run(const Options& options) : options_(options) {}

  /// Renders what the options ask for, or serves it. Prints warnings and progress on standard error
  /// and the summary on standard output. Throws InputError for errors of the user,
  /// EngineMismatch, and other exceptions for internal errors; then no output file has
  /// changed. Throws Interrupted after the unfinished pictures were written.
  void operator()() {
    if (!options_.serve) check_outputs();
    report_.options = options_;
    scene_ = load(options_.scene_file,
                  {.strict = options_.strict,
                   .keep_instances = true,
                   .smooth = options_.smooth,
                   .smooth_by_default = options_.is_bare_model},
                  options_.environment, options_.camera.up);
    report_.load_seconds = seconds_since(start_);
    report_.triangles = triangle_count(scene_);
    report_.rounding = scene_.rounding;
    scene_digest_ = digest_of(scene_);
    print_warnings(scene_, options_.verbose);
    require_inputs_kept();

    // The ground is added after framing, so that it is not framed.
    const RenderSettings& settings = options_.render;
    const double aspect = static_cast<double>(settings.width) / settings.height;
    const Framing framing = frame_picture(options_.camera, scene_, aspect);
    const Scene unframed = options_.serve ? scene_ : Scene();
    if (framing.has_ground) add_ground(scene_, framing.up);
    report_.view = framing.text;
    if (settings.caustics == Caustics::kOn &&
        (framing.lights || framing.camera.projection() != Projection::kPerspective)) {
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
      return serve_pictures(options_, {unframed, prepared, framing.has_ground});
    }
    image_ = make_memory_image(options_, bvh);
    if (is_rendering) {
      render_picture(prepared, framing);
    } else {
      write_core_files(bvh, framing.camera);
    }
  }

 private:
  void check_outputs() {
    for (const auto& path : options_.output.paths()) {
      require_writable(path);
      // The summary makes way for outputs that go to standard output.
      if (is_standard_output(path)) console_ = stderr;
    }
    for (const auto& path : options_.core_files.paths()) require_writable(path);
  }

  /// Throws InputError if an output would replace a file that the scene was read from.
  void require_inputs_kept() const {
    std::vector<std::filesystem::path> inputs = scene_.files;
    inputs.push_back(options_.scene);
    require_distinct(options_.output.paths(), inputs);
    require_distinct(options_.core_files.paths(), inputs);
    // Only the EXR may replace the film that it resumes.
    if (options_.resume.empty()) return;
    OutputOptions others = options_.output;
    others.exr.reset();
    const std::vector<std::filesystem::path> resumed = {options_.resume};
    require_distinct(others.paths(), resumed);
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

  void render_picture(const PreparedScene& prepared, const Framing& framing) {
    const OutputOptions& outputs = options_.output;
    const ExrMetadata metadata = make_metadata(framing);
    std::optional<Film> unfinished;
    if (!options_.resume.empty()) {
      unfinished = read_unfinished(options_, options_.resume, metadata);
    }
    const RenderJob job{prepared, framing.camera, options_.render, framing.lights,
                        unfinished ? &*unfinished : nullptr};
    const Film film = render_monitored(job, metadata);
    const std::string blank = why_blank(film, outputs.display);
    if (!blank.empty()) print_warning(blank);

    // All files are staged before the first takes its name: a full disk changes none of them.
    const Clock::time_point write_start = Clock::now();
    StagedFiles staged = stage_files(outputs, film, metadata, options_.threads);
    report_.pictures = staged.paths;
    report_.legends = staged.legends;
    report_.write_seconds = seconds_since(write_start);
    report_.total_seconds = seconds_since(start_);
    if (outputs.stats) staged.files.emplace_back(*outputs.stats, to_json(report_));
    for (AtomicFile& file : staged.files) file.commit();
    if (!options_.quiet) print(to_text(report_), console_);
  }

  /// Renders with a progress bar and checkpoints. Throws Interrupted when a signal comes.
  Film render_monitored(const RenderJob& job, const ExrMetadata& metadata) {
    ProgressBar bar(!options_.quiet);
    Checkpointer checkpointer(options_.output, metadata, options_.threads, bar);
    RenderMonitor monitor;
    monitor.progress = [&](double fraction) {
      // Until the first call there is nothing to save, and a signal ends the program.
      if (interruption() == 0) note_interruptions();
      bar.update(fraction);
      return interruption() == 0;
    };
    if (options_.output.save_seconds > 0.0) {
      monitor.snapshot = [&](const Film* film) { checkpointer.save(film); };
      monitor.snapshot_seconds = options_.output.save_seconds;
    }
    // The threads may be deep in a search: end without them.
    monitor.abandon = [&](const Film& film) {
      bar.erase();
      std::_Exit(run_guarded([&]() -> int { checkpointer.end_interrupted(film); }, 1));
    };
    RenderStats& stats = report_.render;
    Film film = render(
        job, make_intersector_factory(options_, job.prepared.bvh, options_.render.skips, image_),
        stats, monitor);
    bar.erase();
    if (stats.cancelled) checkpointer.end_interrupted(film);
    if (stats.missing_threads > 0) {
      print_warning("only " + std::to_string(options_.threads - stats.missing_threads) + " of " +
                    std::to_string(options_.threads) + " threads could be started");
    }
    return film;
  }

  [[nodiscard]] ExrMetadata make_metadata(const Framing& framing) const {
    const Camera& camera = framing.camera;
    const RenderSettings& render = options_.render;
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
        .scene = options_.scene_file.obj.filename().string(),
        .seed = render.seed,
        .options = picture_options(options_, framing),
        .world_to_camera = world_to_camera,
        .screen_window_width = static_cast<float>(height * render.width / render.height)};
    metadata.options.emplace_back(kSceneAttribute, scene_digest_);
    if (render.end_sample > 0) set_samples(metadata, {render.first_sample, render.end_sample});
    return metadata;
  }

  const Clock::time_point start_ = Clock::now();
  const Options& options_;
  std::FILE* console_ = stdout;  // where the summary goes
  Scene scene_;
  std::string scene_digest_;                  // of the files, without default lights and ground
  std::shared_ptr<const MemoryImage> image_;  // of a ray core
  Report report_;
};

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  using namespace raygate;
  return run_guarded(
      [&] {
        require_ieee_floats();
        choose_vectors();
        const Options options = parse_options({argv + 1, argv + argc});
        if (options.information.empty()) {
          Run{options}();
        } else {
          print(options.information);
        }
        return 0;
      },
      1);
}
