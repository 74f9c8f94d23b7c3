#include "host/lab/picture/bench_run.h"

#include <algorithm>
#include <cstring>
#include <ctime>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "host/cli/engines.h"
#include "host/film/display.h"
#include "host/film/exr.h"
#include "host/film/pending_file.h"
#include "host/film/png.h"
#include "host/lab/picture/decision_audit.h"
#include "host/lab/variants/rtl_variant_units.h"
#include "host/find/unit/unit_finder.h"
#include "host/lab/variants/variant_hit_tester.h"
#include "host/light/lights.h"
#include "host/picture/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/io/input_error.h"
#include "host/scene/io/obj_loader.h"

namespace raygate {
namespace {

using nlohmann::json;

/// Takes values out of an object and says which it doesn't know.
class Fields {
 public:
  explicit Fields(const json& object) : object_(object) {
    if (!object.is_object()) throw InputError("a run is " + object.dump() + ", expected an object");
  }

  template <class T>
  void take(const char* name, T& value) {
    if (!object_.contains(name)) return;
    try {
      object_.at(name).get_to(value);
    } catch (const json::exception&) {
      fail(name, "another kind of value");
    }
  }

  void take_number(const char* name, int& value, int low, int high) {
    take(name, value);
    if (value < low || value > high ||
        (object_.contains(name) && !object_[name].is_number_integer())) {
      fail(name, std::to_string(low) + " to " + std::to_string(high));
    }
  }

  void end(const std::vector<std::string>& names) const {
    for (const auto& item : object_.items()) {
      if (std::ranges::find(names, item.key()) == names.end()) {
        std::string expected;
        for (const std::string& name : names) expected += (expected.empty() ? "" : ", ") + name;
        throw InputError("a run has " + item.key() + ", expected " + expected);
      }
    }
  }

  [[noreturn]] void fail(const std::string& name, const std::string& expected) const {
    throw InputError("a run's " + name + " is " +
                     (object_.contains(name) ? object_.at(name).dump() : "not there") +
                     ", expected " + expected);
  }

 private:
  const json& object_;
};

json to_json(const BenchRun& run) {
  json object = {{"scene", run.scene.string()},
                 {"width", run.width},
                 {"height", run.height},
                 {"variant", run.variant},
                 {"engine", run.engine},
                 {"lanes", run.lanes},
                 {"threads", run.threads},
                 {"integrator", run.integrator},
                 {"samples", run.samples},
                 {"depth", run.depth},
                 {"seed", run.seed},
                 {"repeats", run.repeats},
                 {"audit", run.audit}};
  if (!run.picture.empty()) object["picture"] = run.picture;
  return object;
}

/// Binary32 as it stands: what the renderer's own engines are.
bool is_plain(const Variant& variant) { return variant.math == Arithmetic{} && variant.doubts; }

Options options_of(const BenchRun& run, const Variant& variant) {
  const bool serial = variant.unit == Variant::Unit::kSerial;
  Options options;
  options.engine = run.engine == "rtl" ? Engine::kRtl : serial ? Engine::kModel : Engine::kCpu;
  options.unit = serial ? "serial" : "pipeline";
  options.lanes = run.lanes;
  return options;
}

FinderFactory factory_of(const BenchRun& run, const Variant& variant, const Bvh& bvh) {
  if (run.engine != "twin" && run.engine != "unit") {
    return make_finder_factory(options_of(run, variant), bvh);
  }
  const auto caches = std::make_shared<RecordCaches>(bvh);
  return [&variant, &bvh, caches, simulated = run.engine == "unit"] {
    return std::make_unique<UnitFinder>(
        bvh, simulated ? make_rtl_variant_tester(variant) : make_variant_tester(variant), caches);
  };
}

/// What decides, for the audit: the cpu engine's decisions are its reference model's.
std::unique_ptr<HitTester> tester_of(const BenchRun& run, const Variant& variant) {
  if (run.engine == "twin") return make_variant_tester(variant);
  if (run.engine == "unit") return make_rtl_variant_tester(variant);
  Options options = options_of(run, variant);
  if (options.engine == Engine::kCpu) options.engine = Engine::kModel;
  return make_tester(options);
}

IntegratorKind kind_of(const std::string& name) {
  return name == "path"      ? IntegratorKind::kPath
         : name == "whitted" ? IntegratorKind::kWhitted
                             : IntegratorKind::kPrimary;
}

/// A scene that runs share.
struct Stage {
  Scene scene;
  Bvh bvh;
  explicit Stage(const std::filesystem::path& file)
      : scene(load_obj(file, {.skip_degenerate = true})), bvh(scene) {
    light_if_dark(scene, Camera::frame(scene, 4.0 / 3.0));
  }
};

bool same_picture(const Film& a, const Film& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
  };
  return same(a.color, b.color) && same(a.depth, b.depth) && same(a.primitive, b.primitive);
}

/// Seconds that this process has computed, on all processors: others' work does not count.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Processor seconds of a fixed piece of work that no change of this project touches: how fast the
/// machine was in between.
double time_yardstick() {
  const double start = processor_seconds();
  std::uint64_t state = 1;
  double sum = 0.0;
  for (int i = 0; i < 4'000'000; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    sum += 1.0 / static_cast<double>(1 + (state >> 40));
  }
  if (!(sum > 0.0)) throw std::logic_error("the yardstick's sum");  // so that it must be computed
  return processor_seconds() - start;
}

/// One run, from its first picture on.
class Performance {
 public:
  Performance(const BenchRun& run, const Stage& stage)
      : run_(run),
        variant_(variant_named(run.variant)),
        stage_(stage),
        camera_(Camera::frame(stage.scene, static_cast<double>(run.width) / run.height)) {}

  /// Renders once more; what was first is only kept as the picture where there are more repeats.
  void render_once() {
    const RenderOptions options{.width = run_.width,
                                .height = run_.height,
                                .window = {},
                                .threads = run_.threads,
                                .samples = run_.samples,
                                .seed = run_.seed,
                                .integrator = kind_of(run_.integrator),
                                .max_depth = run_.depth};
    const double start = processor_seconds();
    const Film film =
        render(stage_.scene, stage_.bvh, camera_, options, factory_of(run_, variant_, stage_.bvh), stats_);
    const double busy = processor_seconds() - start;
    if (film_ && !same_picture(*film_, film)) {
      throw std::logic_error("two pictures of one run differ: " + to_json(run_).dump());
    }
    if (film_ || run_.repeats == 1) {
      seconds_.push_back(stats_.wall_seconds);
      processor_seconds_.push_back(busy);
      yardstick_seconds_.push_back(time_yardstick());
    }
    if (!film_) film_ = film;
  }

  [[nodiscard]] bool done() const { return static_cast<int>(seconds_.size()) >= run_.repeats; }

  [[nodiscard]] json outcome() const {
    json object = to_json(run_);
    object["command"] = "build/picture_bench --run '" + to_json(run_).dump() + "'";
    object["triangles"] = stage_.scene.triangles.size();
    object["records"] = stats_.find.own_records + stats_.find.common_records;
    object["rays"] = stats_.rays;
    object["shadow_rays"] = stats_.shadow_rays;
    object["tests"] = stats_.find.hit.tests;
    object["unit_tests"] = stats_.find.hit.unit_tests;
    object["edge_doubts"] = stats_.find.hit.edge_doubts;
    object["exact_inside"] = stats_.find.exact_inside;
    object["exact_depth"] = stats_.find.exact_depth;
    object["clocks"] = stats_.find.hit.clocks;
    object["idle_clocks"] = stats_.find.hit.idle_clocks;
    object["output_stalls"] = stats_.find.hit.output_stalls;
    object["seconds"] = seconds_;
    object["processor_seconds"] = processor_seconds_;
    object["yardstick_seconds"] = yardstick_seconds_;
    object["thread_seconds"] = {{"boxes", stats_.find.traverse},
                                {"hit_tests", stats_.find.hit_tests},
                                {"records", stats_.find.record},
                                {"shading", stats_.shade_seconds}};
    if (run_.audit) object["decisions"] = audit();
    return object;
  }

  void write_picture() const {
    if (run_.picture.empty()) return;
    const ExrMetadata metadata{.software = "raygate picture_bench",
                               .scene = run_.scene.filename().string(),
                               .seed = run_.seed};
    PendingFile exr(run_.picture + ".exr", encode_exr(*film_, metadata));
    PendingFile png(run_.picture + ".png", encode_png(to_display(*film_)));
    exr.commit();
    png.commit();
  }

 private:
  [[nodiscard]] json audit() const {
    const auto tester = tester_of(run_, variant_);
    const DecisionAudit audit =
        audit_decisions(stage_.bvh, camera_, run_.width, run_.height, variant_, *tester);
    const auto errors = [](const ErrorSummary& summary) {
      // JSON has no infinity: null stands for it.
      return json{{"p50", summary.p50}, {"p99", summary.p99}, {"max", summary.max}};
    };
    return {{"tests", audit.tests},
            {"doubts", audit.doubts},
            {"wrong_hits", audit.wrong_hits},
            {"wrong_misses", audit.wrong_misses},
            {"rays", audit.rays},
            {"wrong_rays", audit.wrong_rays},
            {"hits", audit.hits},
            {"t_ulp", errors(audit.t_ulp)},
            {"point_ulp", errors(audit.point_ulp)}};
  }

  const BenchRun& run_;
  const Variant& variant_;
  const Stage& stage_;
  Camera camera_;
  RenderStats stats_;
  std::optional<Film> film_;
  std::vector<double> seconds_, processor_seconds_, yardstick_seconds_;
};

}  // namespace

BenchRun parse_run(const json& object) {
  BenchRun run;
  Fields fields(object);
  std::string scene;
  fields.take("scene", scene);
  if (scene.empty()) fields.fail("scene", "an OBJ file");
  run.scene = scene;
  fields.take_number("width", run.width, 1, 65536);
  fields.take_number("height", run.height, 1, 65536);
  fields.take("variant", run.variant);
  fields.take("engine", run.engine);
  fields.take_number("lanes", run.lanes, 1, 8);
  fields.take_number("threads", run.threads, 1, 256);
  fields.take("integrator", run.integrator);
  fields.take_number("samples", run.samples, 1, 1 << 20);
  fields.take_number("depth", run.depth, 0, 1000);
  fields.take("seed", run.seed);
  fields.take_number("repeats", run.repeats, 1, 1000);
  fields.take("audit", run.audit);
  fields.take("picture", run.picture);
  fields.end({"scene", "width", "height", "variant", "engine", "lanes", "threads", "integrator",
              "samples", "depth", "seed", "repeats", "audit", "picture"});
  const Variant& variant = variant_named(run.variant);
  const bool of_the_renderer = run.engine == "cpu" || run.engine == "rtl";
  if (!of_the_renderer && run.engine != "twin" && run.engine != "unit") {
    fields.fail("engine", "cpu, rtl, twin or unit");
  }
  if (of_the_renderer && !is_plain(variant)) {
    fields.fail("engine", "twin or unit for " + run.variant);
  }
  if (run.engine == "unit" && !variant.has_hardware()) {
    fields.fail("engine", "twin: no hardware takes the parameters of " + run.variant);
  }
  if (run.integrator != "primary" && run.integrator != "whitted" && run.integrator != "path") {
    fields.fail("integrator", "primary, whitted or path");
  }
  const bool several_lanes = run.engine == "rtl" && variant.unit == Variant::Unit::kPipeline;
  if ((run.lanes & (run.lanes - 1)) != 0) fields.fail("lanes", "1, 2, 4 or 8");
  if (run.lanes != 1 && !several_lanes) fields.fail("lanes", "1, but for the pipelined rtl");
  return run;
}

json measure(const std::vector<BenchRun>& runs, void (*progress)(const std::string& line)) {
  std::map<std::filesystem::path, std::unique_ptr<Stage>> stages;
  std::vector<std::unique_ptr<Performance>> performances;
  for (const BenchRun& run : runs) {
    std::unique_ptr<Stage>& stage = stages[run.scene];
    if (!stage) stage = std::make_unique<Stage>(run.scene);
    performances.push_back(std::make_unique<Performance>(run, *stage));
  }
  for (bool busy = true; busy;) {
    busy = false;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (performances[i]->done()) continue;
      progress(runs[i].scene.stem().string() + " " + runs[i].variant + " " + runs[i].engine);
      performances[i]->render_once();
      busy = true;
    }
  }
  json rows = json::array();
  for (const auto& performance : performances) {
    performance->write_picture();
    rows.push_back(performance->outcome());
  }
  return rows;
}

}  // namespace raygate
