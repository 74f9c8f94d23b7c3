#include "host/lab/pictures/picture_run.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "host/app/engines.h"
#include "host/base/input_error.h"
#include "host/bvh/bvh.h"
#include "host/film/atomic_file.h"
#include "host/film/compare.h"
#include "host/film/display.h"
#include "host/intersect/unit/unit_intersector.h"
#include "host/lab/pictures/decision_audit.h"
#include "host/lab/timing.h"
#include "host/lab/variants/rtl_variant_units.h"
#include "host/light/lights.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/view.h"
#include "host/variants/variant_hit_tester.h"

namespace raygate::lab {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PictureRun, scene, section, width, height, variant, engine,
                                   lanes, threads, integrator, samples, depth, seed, point_error,
                                   repeats, audit, picture, against)

namespace {

Row row_of(const PictureRun& run) { return nlohmann::json(run); }

constexpr std::pair<const char*, IntegratorKind> kIntegrators[] = {
    {"primary", IntegratorKind::kPrimary},
    {"whitted", IntegratorKind::kWhitted},
    {"path", IntegratorKind::kPath}};

[[noreturn]] void fail(const char* name, const Row& found, const std::string& expected) {
  throw InputError(std::string("a run's ") + name + " is " + found.dump() + ", expected " +
                   expected);
}

/// Returns whether a variant is plain binary32, as used by the renderer's own engines.
bool is_plain(const Variant& variant) {
  return variant.math == Arithmetic{} && variant.doubts && variant.brought.empty();
}

EngineOptions options_of(const PictureRun& run, const Variant& variant) {
  const bool serial = variant.unit == Variant::Unit::kSerial;
  EngineOptions options;
  options.engine = run.engine == "rtl" ? Engine::kRtl : serial ? Engine::kModel : Engine::kCpu;
  options.unit = serial ? "serial" : "pipeline";
  options.lanes = run.lanes;
  return options;
}

std::unique_ptr<HitTester> tester_of(const PictureRun& run, const Variant& variant) {
  return run.engine == "unit" ? make_rtl_variant_tester(variant) : make_variant_tester(variant);
}

IntersectorFactory factory_of(const PictureRun& run, const Variant& variant, const Bvh& bvh) {
  if (run.engine == "cpu" || run.engine == "rtl") {
    return make_intersector_factory(options_of(run, variant), bvh);
  }
  const auto caches = std::make_shared<RecordCaches>(bvh);
  return [&run, &variant, &bvh, caches] {
    return std::make_unique<UnitIntersector>(bvh, tester_of(run, variant), caches);
  };
}

bool same_picture(const Film& a, const Film& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
  };
  return same(a.color, b.color) && same(a.depth, b.depth) && same(a.primitive, b.primitive);
}

/// A scene with its BVH and lights, shared by several runs.
struct LitScene {
  Scene scene;
  Bvh bvh;
  std::optional<CameraLights> lights;

  explicit LitScene(const std::filesystem::path& file)
      : scene(load_obj(file)),
        bvh(scene),
        lights(default_lights(scene, front_camera(scene, 4.0 / 3.0))) {}

  /// Returns a camera that shows the whole scene.
  [[nodiscard]] Camera camera(int width, int height) const {
    return front_camera(scene, static_cast<double>(width) / height);
  }
};

/// Returns red, green and blue, for comparison.
ChannelPicture light_of(const Film& film) {
  ChannelPicture picture{film.width, film.height, film.window, {"R", "G", "B"}, {}};
  for (int k = 0; k < 3; ++k) {
    std::vector<double>& channel = picture.channels.emplace_back();
    for (const glm::vec4& color : film.color) channel.push_back(color[k]);
  }
  return picture;
}

/// Returns the processor time of a fixed workload, which measures the current machine speed.
double time_yardstick() {
  const double start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  std::uint64_t state = 1;
  double sum = 0.0;
  for (int i = 0; i < 4'000'000; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    sum += 1.0 / static_cast<double>(1 + (state >> 40));
  }
  // Prevents elimination by the compiler.
  if (!(sum > 0.0)) throw std::logic_error("the yardstick's sum");
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
}

/// A run that is executed repeatedly.
class TimedRun {
 public:
  TimedRun(const PictureRun& run, const LitScene& stage)
      : run_(run),
        variant_(variant_named(run.variant)),
        stage_(stage),
        camera_(stage.camera(run.width, run.height)) {}

  /// Renders once more. If there are several repeats, the first one is not timed.
  void render_once() {
    RenderSettings options;
    options.width = run_.width;
    options.height = run_.height;
    options.threads = run_.threads;
    options.samples = run_.samples;
    options.seed = run_.seed;
    options.integrator = std::ranges::find(kIntegrators, run_.integrator, [](const auto& kind) {
                           return std::string(kind.first);
                         })->second;
    options.max_depth = run_.depth;
    options.point_error = run_.point_error < 0.0 ? std::numeric_limits<float>::max()
                                                 : static_cast<float>(run_.point_error);
    const PreparedScene prepared(stage_.scene, stage_.bvh);
    const Film film = render({prepared, camera_, options, stage_.lights},
                             factory_of(run_, variant_, stage_.bvh), stats_);
    if (film_ && !same_picture(*film_, film)) {
      throw std::logic_error("two pictures of one run differ: " + row_of(run_).dump());
    }
    if (film_ || run_.repeats == 1) {
      seconds_.push_back(stats_.wall_seconds);
      processor_seconds_.push_back(stats_.processor_seconds);
      yardstick_seconds_.push_back(time_yardstick());
    }
    if (!film_) film_ = film;
  }

  [[nodiscard]] bool done() const { return static_cast<int>(seconds_.size()) >= run_.repeats; }
  [[nodiscard]] const PictureRun& run() const { return run_; }
  [[nodiscard]] const Film& film() const { return *film_; }

  [[nodiscard]] Row row() const {
    Row row = {{"table", "pictures"}};
    row.update(row_of(run_));
    row.update(Row{{"command", "build/lab pictures --run '" + row_of(run_).dump() + "'"},
                   {"triangles", stage_.scene.triangles.size()},
                   {"records", stats_.intersect.own_records + stats_.intersect.common_records},
                   {"rays", stats_.rays},
                   {"shadow_rays", stats_.shadow_rays},
                   {"tests", stats_.intersect.hit.tests},
                   {"unit_tests", stats_.intersect.hit.unit_tests},
                   {"edge_doubts", stats_.intersect.hit.edge_doubts},
                   {"exact_inside", stats_.intersect.exact_inside},
                   {"exact_depth", stats_.intersect.exact_depth},
                   {"point_doubts", stats_.point_doubts},
                   {"clocks", stats_.intersect.hit.clocks},
                   {"idle_clocks", stats_.intersect.hit.idle_clocks},
                   {"output_stalls", stats_.intersect.hit.output_stalls},
                   {"seconds", seconds_},
                   {"processor_seconds", processor_seconds_},
                   {"yardstick_seconds", yardstick_seconds_},
                   {"thread_seconds",
                    {{"boxes", stats_.intersect.traverse},
                     {"hit_tests", stats_.intersect.hit_tests},
                     {"records", stats_.intersect.record},
                     {"shading", stats_.shade_seconds}}}});
    if (run_.audit) {
      row["decisions"] = audit_decisions(stage_.bvh, camera_, run_.width, run_.height, variant_,
                                         *tester_of(run_, variant_));
    }
    return row;
  }

  void write_picture() const {
    if (run_.picture.empty()) return;
    AtomicFile(run_.picture + ".png", encode_png(to_display(*film_))).commit();
  }

 private:
  const PictureRun& run_;
  const Variant& variant_;
  const LitScene& stage_;
  Camera camera_;
  RenderStats stats_;
  std::optional<Film> film_;
  std::vector<double> seconds_, processor_seconds_, yardstick_seconds_;
};

/// Returns error measures of an image against its reference; psnr is null for equal images.
Row difference(const Film& film, const Film& reference) {
  const Comparison comparison = compare(light_of(film), light_of(reference));
  return {{"differing_pixels", comparison.differing},
          {"rmse", comparison.rmse},
          {"psnr_db", comparison.psnr},
          {"ssim", comparison.ssim ? Row(*comparison.ssim) : Row()}};
}

}  // namespace

PictureRun parse_run(const Row& object) {
  const Row row = with_usual(object, row_of(PictureRun{}), "a run");
  const auto run = nlohmann::json(row).get<PictureRun>();
  if (run.scene.empty()) fail("scene", run.scene, "an OBJ file");
  in_range("width", run.width, 1, 65536);
  in_range("height", run.height, 1, 65536);
  in_range("threads", run.threads, 1, 256);
  in_range("samples", run.samples, 1, 1 << 20);
  in_range("depth", run.depth, 0, 1000);
  in_range("repeats", run.repeats, 1, 1000);
  const Variant& variant = variant_named(run.variant);
  const bool of_the_renderer = run.engine == "cpu" || run.engine == "rtl";
  if (!of_the_renderer && run.engine != "model" && run.engine != "unit") {
    fail("engine", run.engine, "cpu, rtl, model or unit");
  }
  if (of_the_renderer && !is_plain(variant)) {
    fail("engine", run.engine, "model or unit for " + run.variant);
  }
  if (run.engine == "unit" && !variant.has_hardware()) {
    fail("engine", run.engine, "model: no hardware takes the parameters of " + run.variant);
  }
  if (std::ranges::none_of(kIntegrators,
                           [&](const auto& kind) { return run.integrator == kind.first; })) {
    fail("integrator", run.integrator, "primary, whitted or path");
  }
  const bool several_lanes = run.engine == "rtl" && variant.unit == Variant::Unit::kPipeline;
  if (run.lanes != 1 && run.lanes != 2 && run.lanes != 4 && run.lanes != 8) {
    fail("lanes", run.lanes, "1, 2, 4 or 8");
  }
  if (run.lanes != 1 && !several_lanes) fail("lanes", run.lanes, "1, but for the pipelined rtl");
  return run;
}

std::vector<Row> measure(const std::vector<PictureRun>& runs) {
  std::map<std::string, LitScene> scenes;
  std::deque<TimedRun> timed_runs;
  for (const PictureRun& run : runs) {
    timed_runs.emplace_back(run, scenes.try_emplace(run.scene, run.scene).first->second);
  }
  for (bool busy = true; busy;) {
    busy = false;
    for (TimedRun& timed : timed_runs) {
      if (timed.done()) continue;
      const PictureRun& run = timed.run();
      std::fprintf(stderr, "%s %s %s\n", run.scene.c_str(), run.variant.c_str(),
                   run.engine.c_str());
      timed.render_once();
      busy = true;
    }
  }
  std::vector<Row> rows;
  for (const TimedRun& timed : timed_runs) {
    timed.write_picture();
    Row& row = rows.emplace_back(timed.row());
    const std::string& against = timed.run().against;
    if (against.empty()) continue;
    const auto reference = std::ranges::find_if(
        timed_runs, [&](const TimedRun& other) { return other.run().picture == against; });
    if (reference == timed_runs.end()) fail("against", against, "another run's picture");
    row.update(difference(timed.film(), reference->film()));
  }
  return rows;
}

}  // namespace raygate::lab
