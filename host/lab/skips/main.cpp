// What each skip saves: every scene with all skips, and with each one switched off by itself. The
// pictures must be the same bytes. One thread, CPU engine; compare rows of one run.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string>

#include "host/cli/engines.h"
#include "host/cli/format.h"
#include "host/cli/light_options.h"
#include "host/light/lights.h"
#include "host/picture/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/io/obj_loader.h"

namespace raygate {
namespace {

constexpr int kWidth = 320, kHeight = 200;  // as the paper's scene is made for
// Without culling every ray is tested against every polygon: no more of these than one can wait
// for.
constexpr double kMaxTests = 3e8;

bool same(const Film& a, const Film& b) {
  return std::memcmp(a.color.data(), b.color.data(), a.color.size() * sizeof a.color[0]) == 0;
}

/// A run's counts; seconds are those of the fastest of three.
struct Run {
  Film film;
  RenderStats stats;
};

Run timed(const Scene& scene, const Bvh& bvh, const Camera& camera, const Options& options) {
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
    run.film = render(scene, bvh, camera, render_options, make_finder_factory(options, bvh), run.stats);
    if (i == 0 || run.stats.wall_seconds < best.stats.wall_seconds) best = std::move(run);
    if (best.stats.wall_seconds > 5.0) break;
  }
  return best;
}

void print_row(const std::string& name, const RenderStats& stats, const RenderStats& base) {
  std::printf("  %-24s %12s %14s %14s %12s %8.2f\n", name.c_str(), format_count(stats.rays).c_str(),
              format_count(stats.find.hit.tests).c_str(), format_count(stats.find.own_records + stats.find.common_records).c_str(),
              format_duration(stats.wall_seconds).c_str(), stats.wall_seconds / base.wall_seconds);
}

/// False when a skip changed the picture.
bool bench(const std::filesystem::path& file) {
  Scene scene = load_obj(file);
  const Bvh bvh(scene);
  const Camera camera = Camera::frame(scene, static_cast<double>(kWidth) / kHeight);
  light_if_dark(scene, camera);
  Options options;
  options.engine = Engine::kCpu;
  timed(scene, bvh, camera, options);  // warms up
  const Run all = timed(scene, bvh, camera, options);
  const double every_test =
      static_cast<double>(all.stats.rays) * static_cast<double>(scene.triangles.size());
  std::printf("\n%s: %s polygons; %s tests of %s: %.0f times fewer\n", file.stem().string().c_str(),
              format_count(scene.triangles.size()).c_str(),
              format_count(all.stats.find.hit.tests).c_str(),
              format_count(static_cast<std::uint64_t>(every_test)).c_str(),
              every_test / static_cast<double>(all.stats.find.hit.tests));
  std::printf("  %-24s %12s %14s %14s %12s %8s\n", "", "rays", "tests", "records", "time", "");
  print_row("all skips", all.stats, all.stats);
  // It tests what is in a leaf one by one, where the cpu engine tests four polygons at a time.
  Options simulated = options;
  simulated.engine = Engine::kRtl;
  const Run unit = timed(scene, bvh, camera, simulated);
  print_row("the simulated unit", unit.stats, all.stats);
  bool fine = same(unit.film, all.film);
  for (const SkipName& skip : kSkipNames) {
    const std::string name = std::string("without ") + skip.name;
    if (skip.on == &Skips::divisions) continue;  // the pipelined unit has no such switch
    if (skip.on == &Skips::culling && every_test > kMaxTests) {
      std::printf("  %-24s %12s %14s   (not run)\n", name.c_str(),
                  format_count(all.stats.rays).c_str(),
                  format_count(static_cast<std::uint64_t>(every_test)).c_str());
      continue;
    }
    Options one = options;
    one.light.skips.*skip.on = false;
    const Run run = timed(scene, bvh, camera, one);
    print_row(name, run.stats, all.stats);
    if (!same(run.film, all.film)) {
      std::printf("  the picture is another one\n");
      fine = false;
    }
  }
  std::fflush(stdout);
  return fine;
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: skip_bench SCENE.obj...\n", stderr);
    return 2;
  }
  std::printf("%dx%d, whitted, one thread, engine cpu; the last column is time against all skips\n",
              raygate::kWidth, raygate::kHeight);
  bool fine = true;
  try {
    for (int i = 1; i < argc; ++i) fine = raygate::bench(argv[i]) && fine;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return fine ? 0 : 1;
}
