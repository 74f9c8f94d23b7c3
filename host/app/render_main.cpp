// The program `render`: reads a scene, writes pictures and statistics.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
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
  const glm::dmat3 turn = glm::transpose(glm::dmat3(camera.right(), camera.up(), camera.forward()));
  glm::mat4 world_to_camera{glm::mat3(turn)};
  world_to_camera[3] = glm::vec4(-(turn * eye), 1.0f);
  Options same = options;
  same.camera = framing.request;
  const double height = 2.0 * camera.half_height();
  const auto values = option_values(std::move(same), kInExr);
  ExrMetadata metadata{
      .attributes = {values.begin(), values.end()},
      .world_to_camera = world_to_camera,
      .screen_window_width = static_cast<float>(height * render.width / render.height)};
  metadata.attributes.insert({{"software", kSoftware},
                              {"scene", options.scene_file.obj.filename().string()},
                              {"seed", std::to_string(render.seed)},
                              {kSceneAttribute, digest}});
  if (render.end_sample > 0) set_samples(metadata, {render.first_sample, render.end_sample});
  return metadata;
}

/// Reads a film to resume, with the channels that this run's outputs need. `metadata` describes
/// this run. Throws InputError if the file cannot be read, has no sums, or shows another picture.
/// Only --spp may be larger in this run.
Film read_unfinished(const Options& options, const ExrMetadata& metadata) {
  const std::string name = options.resume.string();
  FilmFile file = read_film(options.resume);
  Film& film = file.film;
  const SampleRange there = samples_of(file.metadata), wanted = samples_of(metadata);
  if (there.first != wanted.first || there.end > wanted.end) {
    const bool is_longer = there.first == wanted.first && options.render.end_sample == 0;
    throw InputError(name + ": found samples " + to_string(there) + ", expected the first of " +
                     to_string(wanted) +
                     (is_longer ? "; try --spp " + std::to_string(there.end) : ""));
  }
  // A single sample is at its pixel's centre; the first of several samples is not.
  const auto samples = file.metadata.attributes.find("spp");
  if (samples != file.metadata.attributes.end() && samples->second != "1") {
    samples->second = std::to_string(options.render.samples);
  }
  const RenderSettings& render = options.render;
  if (const auto difference = different_picture(file, metadata, render.width, render.height))
    throw InputError(name + ": found " + *difference + " as this run has it");
  if (film.window != render.window)
    throw InputError(name + ": found another crop, expected that of this run");
  // A film of one pixel with all fields that this run needs.
  Film needed = make_film(1, 1, {0, 0, 1, 1}, options.output.needed_channels());
  add_sums(needed, render.error > 0.0);
  for_each_field(
      [&](const FilmField& field, const auto& wanted, auto& values) {
        if (wanted.empty()) values.clear();
        if (!values.empty() || wanted.empty()) return;
        throw InputError(name + ": found no channel " + std::string(field.layer) +
                         ", expected it as --channels names it");
      },
      needed, film);
  return film;
}

/// Renders with a progress line. Saves the unfinished picture periodically. After a signal, saves
/// it unless all pixels are misses, and throws Interrupted.
Film render_monitored(const Options& options, const RenderJob& job, ExrMetadata metadata,
                      const IntersectorFactory& make_intersector, RenderStats& stats) {
  ProgressLine line(!options.quiet);
  metadata.attributes[kPartialAttribute] = kPartial;
  const OutputOptions& outputs = options.output;
  const auto write = [&](const Film& film) {
    for (AtomicFile& file : stage_files(outputs, film, metadata, options.threads).files) {
      file.commit();
    }
  };
  const auto end_interrupted = [&](const Film& film) {
    const int signal = interruption();
    const auto is_miss = [](const glm::vec4& color) { return color.a == 0.0f; };
    if (std::ranges::all_of(film.color, is_miss)) throw Interrupted(signal, "no file was changed");
    write(film);
    std::string outcome = "wrote what there was: " + listed(outputs.pictures());
    if (const auto& taken = film.sums.samples; !taken.empty()) {
      const auto [least, most] = std::ranges::minmax(taken);
      outcome += " (" + std::to_string(least) + " to " + std::to_string(most) + " of " +
                 std::to_string(options.render.samples) + " samples per pixel)";
    }
    outcome += film.keeps_sums && outputs.exr
                   ? "; --resume " + outputs.exr->string() + " goes on from there"
                   : "; only a run with --channels sums can be resumed";
    throw Interrupted(signal, outcome);
  };
  std::string last_trouble;
  RenderMonitor monitor;
  monitor.progress = [&](double fraction) {
    // Until the first call there is nothing to save, and a signal ends the program.
    if (interruption() == 0) note_interruptions();
    line.update(fraction);
    return interruption() == 0;
  };
  if (outputs.save_seconds > 0.0) {
    monitor.snapshot = [&](const Film* film) {  // null: no memory for a copy
      std::string trouble;
      try {
        if (film == nullptr) throw std::bad_alloc();
        write(*film);
      } catch (const std::bad_alloc&) {
        trouble = listed(outputs.pictures()) + ": cannot write: out of memory";
      } catch (const std::exception& error) {
        trouble = error.what();
      }
      if (!trouble.empty() && trouble != last_trouble) {
        line.erase();
        print_warning(trouble + "; the render goes on, and the next save tries again");
      }
      last_trouble = trouble;
    };
    monitor.snapshot_seconds = outputs.save_seconds;
  }
  // The threads may be stuck in a long search. So the process ends without them.
  monitor.abandon = [&](const Film& film) {
    line.erase();
    std::_Exit(run_guarded([&]() -> int {
      end_interrupted(film);
      return 0;
    }));
  };
  Film film = render(job, make_intersector, stats, monitor);
  line.erase();
  if (stats.cancelled) end_interrupted(film);
  if (stats.missing_threads > 0) {
    print_warning("only " + std::to_string(options.threads - stats.missing_threads) + " of " +
                  std::to_string(options.threads) + " threads could be started");
  }
  return film;
}

/// Renders a picture, or serves the page of --serve. Prints the summary on standard output, or on
/// standard error if standard output is an output file. If run() throws, no output file has
/// changed, except that unfinished pictures are written before Interrupted.
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
  bool is_lit = scene.environment || !scene.directional_lights.empty() ||
                std::ranges::any_of(scene.materials, emits);
  for (const PointLight& light : scene.lights) is_lit = is_lit || light.spot;
  if (is_lit && std::ranges::count(scene.materials, 10, &Material::illumination_model) > 0) {
    scene.warnings.emplace_back("illum 10: matches the background under point lights alone");
  }
  print_warnings(scene.warnings, options.verbose);
  std::vector<std::filesystem::path> inputs = scene.files;
  inputs.push_back(options.scene);
  check_outputs(options, std::move(inputs));

  // The ground is added after framing, so it has no effect on the camera.
  const RenderSettings& settings = options.render;
  const Framing framing =
      frame_picture(options.camera, scene, static_cast<double>(settings.width) / settings.height);
  const Scene unframed = options.serve ? scene : Scene();
  if (framing.has_ground) add_ground(scene, framing.up);
  report.view = framing.text;
  resolve_instances(scene, options.instances, options.scene);
  lap.lap();
  const Bvh bvh(scene, options.threads);
  report.tree_seconds = lap.lap();
  const PreparedScene prepared(scene, bvh);
  if (options.serve) return serve_pictures(options, {unframed, prepared, framing.has_ground});

  const auto image = make_memory_image(options, bvh);
  if (!core_files.image.empty()) {
    AtomicFile(core_files.image, image->bytes()).commit();
    print("wrote " + printable(core_files.image.string()) + ", " +
              format_count(image->lines().size(), "line") + ", relative to " +
              list_text({scene.origin.x, scene.origin.y, scene.origin.z}) + "\n",
          console);
  }
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
