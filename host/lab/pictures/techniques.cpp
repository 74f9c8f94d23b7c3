// What each technique of the path tracer gains: the same pictures with each one changed by itself,
// time against error. One thread, CPU engine; compare rows of one run.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "host/cli/camera_sequence.h"
#include "host/cli/engines.h"
#include "host/cli/options.h"
#include "host/lab/commands.h"
#include "host/lab/timing.h"
#include "host/light/integrator_options.h"
#include "host/render/renderer.h"
#include "host/scene/io/scene_file.h"
#include "host/scene/io/scene_loader.h"

namespace raygate::lab {
namespace {

struct Named {
  const char* name;
  PathOptions path;
  bool is_timed = true;  ///< false: it is made so as to be compared, not so as to be quick
};
const Named kTechniques[] = {
    {"as it is", {}},
    {"lights by power alone", {.lights = LightSampling::kPower}, false},
    {"lights not as the sky", {.limits_mis_weight = false}},
    {"roulette below 1/2", {.roulette_threshold = 0.5f}},
    {"roulette below 1/16", {.roulette_threshold = 0.0625f}},
    {"roulette below 1/64", {.roulette_threshold = 0.015625f}},
    {"no roulette", {.roulette_threshold = 0.0f}},
};

/// What is measured, besides the scene.
struct Plan {
  std::vector<std::string> scenes;
  int side = 128, samples = 32, reference = 1024, repeats = 3;
};

/// A scene, its camera and its lights, as ./render has them.
class Set {
 public:
  Set(const std::string& file, const Plan& plan) : plan_(plan), options_(options_of(file, plan)) {
    scene_ = load_scene(options_.scene_file.value_or(SceneFile{.obj = options_.scene}));
    cameras_ = std::make_unique<CameraSequence>(options_, scene_);
    bvh_ = std::make_unique<Bvh>(scene_);
    prepared_ = std::make_unique<PreparedScene>(scene_, *bvh_);
  }

  [[nodiscard]] std::string name() const { return options_.scene.stem().string(); }

  [[nodiscard]] Film film(const PathOptions& techniques, int samples, int seed,
                          RenderStats& stats) const {
    const CameraSequence::Frame& frame = cameras_->frame(1);
    const RenderOptions options{.width = plan_.side,
                                .height = plan_.side,
                                .window = {},
                                .samples = samples,
                                .filter = ReconstructionFilter::kBox,
                                .seed = static_cast<std::uint64_t>(seed),
                                .integrator = IntegratorKind::kPath,
                                .max_depth = options_.render.depth(),
                                .lights = frame.lights,
                                .path = techniques};
    return render(*prepared_, frame.camera, options,
                  make_intersector_factory(options_, *bvh_, options_.render.skips), stats);
  }

 private:
  static raygate::Options options_of(const std::string& file, const Plan& plan) {
    const std::string size = std::to_string(plan.side) + "x" + std::to_string(plan.side);
    const char* const words[] = {"lab",          file.c_str(), "--engine", "cpu",
                                 "--integrator", "path",       "--size",   size.c_str()};
    return parse_options(static_cast<int>(std::size(words)), words);
  }

  const Plan& plan_;
  raygate::Options options_;
  Scene scene_;
  std::unique_ptr<CameraSequence> cameras_;
  std::unique_ptr<Bvh> bvh_;
  std::unique_ptr<PreparedScene> prepared_;
};

/// Over pixels and colours, scene-linear.
double mean_squared_error(const Film& film, const Film& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < film.color.size(); ++i) {
    const glm::dvec3 apart = glm::dvec3(film.color[i]) - glm::dvec3(reference.color[i]);
    sum += glm::dot(apart, apart);
  }
  return sum / (3.0 * static_cast<double>(film.color.size()));
}

void measure(const Set& set, const Plan& plan, Results& results) {
  constexpr int kReferenceSeed = 1000;
  RenderStats stats;
  const Film reference = set.film({}, plan.reference, kReferenceSeed, stats);
  constexpr std::size_t kCount = std::size(kTechniques);
  std::vector<double> seconds[kCount];
  double errors[kCount] = {};
  std::uint64_t rays[kCount] = {};
  for (int repeat = 0; repeat < plan.repeats; ++repeat) {
    for (std::size_t i = 0; i < kCount; ++i) {
      const Film film = set.film(kTechniques[i].path, plan.samples, repeat, stats);
      seconds[i].push_back(stats.processor_seconds);
      errors[i] += mean_squared_error(film, reference) / plan.repeats;
      rays[i] = stats.rays;
    }
  }
  for (std::size_t i = 0; i < kCount; ++i) {
    const double time = median(seconds[i]) / median(seconds[0]), error = errors[i] / errors[0];
    Row row = {{"table", "techniques"}, {"scene", set.name()}, {"technique", kTechniques[i].name},
               {"rays", rays[i]},       {"mse", errors[i]},    {"error_over_first", error}};
    const bool timed = kTechniques[i].is_timed;
    row["seconds"] = timed ? Row(median(seconds[i])) : Row();
    row["time_over_first"] = timed ? Row(time) : Row();
    row["time_mse_over_first"] = timed ? Row(time * error) : Row();
    results.add(std::move(row));
  }
}

}  // namespace

void add_techniques(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand("techniques", "what each technique of the path tracer gains");
  const auto plan = std::make_shared<Plan>();
  app->add_option("scenes", plan->scenes, "scene files")->required();
  app->add_option("--side", plan->side, "width and height, pixels (128)")
      ->check(CLI::Range(1, 4096));
  app->add_option("--spp", plan->samples, "samples per pixel (32)")->check(CLI::Range(1, 65536));
  app->add_option("--reference", plan->reference,
                  "samples of the picture they are held against (1024)")
      ->check(CLI::Range(1, 1 << 20));
  app->add_option("--repeats", plan->repeats, "other seeds, of which times are medians (3)")
      ->check(CLI::Range(1, 1000));
  app->callback([plan, &outcome] {
    for (const std::string& scene : plan->scenes)
      measure(Set(scene, *plan), *plan, outcome.results);
  });
}

}  // namespace raygate::lab
