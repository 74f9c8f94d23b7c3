// What each engine takes for each scene: a table of one run, on one thread. Nothing passes or
// fails here; compare rows of one table, as other machines and other loads give other times.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "host/cli/engines.h"
#include "host/cli/format.h"
#include "host/cli/report.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/obj_loader.h"

namespace raygate {
namespace {

constexpr int kWidth = 320, kHeight = 240;

void print_row(const std::string& scene, std::size_t triangles, const Options& options,
               const RenderStats& stats) {
  const auto unit_tests = static_cast<double>(stats.hit.unit_tests);
  const auto per_second = [](double count, double seconds) {
    return format_count(seconds > 0.0 ? static_cast<std::uint64_t>(count / seconds) : 0);
  };
  std::printf("%-12s %9s %-8s %-6s %9.3f %12s %14s %10s\n", scene.c_str(),
              format_count(triangles).c_str(), options.unit.c_str(),
              to_string(options.engine).c_str(), stats.wall_seconds,
              per_second(static_cast<double>(stats.rays), stats.wall_seconds).c_str(),
              per_second(unit_tests, stats.hit_seconds).c_str(),
              stats.hit.clocks > 0 ? format_fixed(clocks_per_test(stats.hit), 2).c_str() : "-");
}

void bench(const std::filesystem::path& file) {
  const Scene scene = load_obj(file);
  const Bvh bvh(scene);
  const Camera camera = Camera::frame(scene, static_cast<double>(kWidth) / kHeight);
  for (const char* unit : {"pipeline", "serial"}) {
    for (const Engine engine : {Engine::kCpu, Engine::kRtl}) {
      Options options;
      options.unit = unit;
      options.engine = engine;
      RenderStats stats;
      const RenderOptions render_options{
          .width = kWidth, .height = kHeight, .window = {}, .threads = 1, .seed = 0};
      (void)render(scene, bvh, camera, render_options, make_tester_factory(options), stats);
      print_row(file.stem().string(), scene.triangles.size(), options, stats);
    }
  }
}

}  // namespace
}  // namespace raygate

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: scene_bench SCENE.obj...\n", stderr);
    return 2;
  }
  std::printf("%dx%d, one thread. Tests: of the unit, in the time of the hit tests alone.\n",
              raygate::kWidth, raygate::kHeight);
  std::printf("%-12s %9s %-8s %-6s %9s %12s %14s %10s\n", "scene", "triangles", "unit", "engine",
              "seconds", "rays/s", "tests/s", "clocks");
  try {
    for (int i = 1; i < argc; ++i) raygate::bench(argv[i]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
