// What each skip saves: every scene with all skips, and with each one switched off by itself. The
// pictures must be the same bytes. One thread, CPU engine; compare rows of one run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>

#include "host/cli/engines.h"
#include "host/cli/options.h"
#include "host/lab/commands.h"
#include "host/lab/pictures/lit_scene.h"
#include "host/lab/results.h"
#include "host/render/renderer.h"

namespace raygate::lab {
namespace {

constexpr int kWidth = 320, kHeight = 200;  // as the paper's scene is made for
// Without culling every ray is tested against every polygon: with more tests than these, nobody
// can wait for the picture.
constexpr double kMaxTests = 3e8;

bool same(const Film& a, const Film& b) {
  return std::memcmp(a.color.data(), b.color.data(), a.color.size() * sizeof a.color[0]) == 0;
}

/// The fastest of three pictures.
struct Run {
  Film film;
  RenderStats stats;
};

Run timed(const LitScene& stage, const Options& options) {
  const RenderOptions render_options{.width = kWidth,
                                     .height = kHeight,
                                     .window = {},
                                     .samples = options.light.samples,
                                     .integrator = options.light.integrator,
                                     .max_depth = options.light.max_depth(),
                                     .skips = options.light.skips};
  Run best;
  for (int i = 0; i < 3; ++i) {
    Run run;
    run.film = render(stage.scene, stage.bvh, stage.camera(kWidth, kHeight), render_options,
                      make_intersector_factory(options, stage.bvh, options.light.skips), run.stats);
    if (i == 0 || run.stats.wall_seconds < best.stats.wall_seconds) best = std::move(run);
    if (best.stats.wall_seconds > 5.0) break;
  }
  return best;
}

/// All of one scene's rows.
class SceneRows {
 public:
  SceneRows(const LitScene& stage, Results& results, TextTable& table)
      : stage_(stage), results_(results), table_(table) {}

  /// False when a skip changed the picture.
  bool run() {
    Options options;
    options.engine = Engine::kCpu;
    timed(stage_, options);  // warms up
    all_ = timed(stage_, options);
    bool fine = add("all skips", all_);
    // The unit tests what is in a leaf one by one, where the cpu engine tests four polygons at
    // once.
    Options simulated = options;
    simulated.engine = Engine::kRtl;
    fine = add("the simulated unit", timed(stage_, simulated)) && fine;
    for (const SkipName& skip : kSkipNames) {
      if (skip.on == &Skips::divisions) continue;  // the pipelined unit has no such switch
      if (skip.on == &Skips::culling && every_test() > kMaxTests) continue;
      Options one = options;
      one.light.skips.*skip.on = false;
      fine = add(std::string("without ") + skip.name, timed(stage_, one)) && fine;
    }
    return fine;
  }

 private:
  /// Tests if every ray were tested against every polygon, as in the paper.
  [[nodiscard]] double every_test() const {
    return static_cast<double>(all_.stats.rays) *
           static_cast<double>(stage_.scene.triangles.size());
  }

  /// Whether the picture is the one with all skips.
  bool add(const std::string& what, const Run& run) {
    const bool fine = same(run.film, all_.film);
    const Row row = {
        {"table", "skips"},
        {"scene", stage_.name},
        {"polygons", stage_.scene.triangles.size()},
        {"what", what},
        {"rays", run.stats.rays},
        {"tests", run.stats.intersect.hit.tests},
        {"times_fewer_tests", every_test() / static_cast<double>(run.stats.intersect.hit.tests)},
        {"records", run.stats.intersect.own_records + run.stats.intersect.common_records},
        {"milliseconds", 1e3 * run.stats.wall_seconds},
        {"time_over_all_skips", run.stats.wall_seconds / all_.stats.wall_seconds},
        {"picture", fine ? "same" : "ANOTHER"}};
    results_.add(row);
    table_.print(row);
    return fine;
  }

  const LitScene& stage_;
  Results& results_;
  TextTable& table_;
  Run all_;
};

}  // namespace

void add_skips(CLI::App& lab, Common& common) {
  auto* app = lab.add_subcommand("skips", "tests and time that each skip saves");
  const auto scenes = std::make_shared<std::vector<std::string>>();
  app->add_option("scenes", *scenes, "OBJ files")->required();
  app->callback([scenes, &common] {
    std::printf(
        "%dx%d, whitted, one thread, engine cpu. times fewer: than every ray of the first row on\n"
        "every polygon, as in the paper; \"without culling\" is left out where that is too many.\n",
        kWidth, kHeight);
    Results results(common.results);
    TextTable table({{"scene", "scene", -1, 14},
                     {"polygons", "polygons"},
                     {"what", "what", -1, 22},
                     {"rays", "rays", -1, 9},
                     {"tests", "tests", -1, 11},
                     {"times_fewer_tests", "times fewer", 0},
                     {"records", "records", -1, 9},
                     {"milliseconds", "time, ms", 1},
                     {"time_over_all_skips", "over all skips", 2},
                     {"picture", "picture"}});
    for (const std::string& scene : *scenes) {
      if (!SceneRows(LitScene(scene), results, table).run()) common.status = 1;
    }
  });
}

}  // namespace raygate::lab
