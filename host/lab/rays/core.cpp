// Clocks, and memory lines and bytes read, per ray of the simulated ray core: by kind of ray or for
// an image, and by memory latency. A result that differs from the cpu engine's ends the run.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "host/intersect/check_intersector.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/intersector.h"
#include "host/lab/lab.h"
#include "host/lab/rays/rays.h"
#include "host/light/lights.h"
#include "host/render/renderer.h"
#include "host/scene/camera.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/view.h"
#include "sim/rtl_core.h"

namespace raygate::lab {
namespace {

struct Options {
  std::vector<std::string> scenes;
  std::vector<int> latencies = {1, 50, 200};
  std::vector<std::string> kinds = {"camera", "light", "scattered"};
  int size = 128;
  bool exact = false;
};

/// Traces rays, and returns their number.
using Trace = std::function<std::size_t(const IntersectorFactory&)>;

constexpr std::pair<const char*, IntegratorKind> kPictures[] = {
    {"whitted", IntegratorKind::kWhitted}, {"path", IntegratorKind::kPath}};

/// Measures one kind of rays with every memory latency.
void measure(const Options& options, const std::string& scene, const std::string& kind,
             const Bvh& bvh, const std::shared_ptr<const MemoryImage>& image, const Trace& trace) {
  for (const int latency : options.latencies) {
    const std::shared_ptr<CoreUnit> core =
        make_rtl_core({.latency = latency}, {}, {.exact = options.exact});
    const auto count = static_cast<double>(trace([&] {
      return std::make_unique<CheckIntersector>(bvh,
                                                std::make_unique<CoreIntersector>(bvh, image, core),
                                                std::make_unique<CpuIntersector>(bvh));
    }));
    const CoreCounters counters = core->counters();
    const auto a_ray = [&](std::uint64_t of) { return static_cast<double>(of) / count; };
    const auto percent = [&](std::uint64_t clocks) {
      return 100.0 * a_ray(clocks) / a_ray(counters.clocks);
    };
    print({{"table", "core"},
           {"scene", scene},
           {"rays", kind},
           {"exact", options.exact},
           {"latency", latency},
           {"clocks_per_ray", a_ray(counters.clocks)},
           {"lines_per_ray", a_ray(counters.lines)},
           {"bytes_per_ray", 64.0 * a_ray(counters.lines)},
           {"nodes_percent", percent(counters.nodes)},
           {"triangles_percent", percent(counters.tests)},
           {"exact_percent", percent(counters.exact_clocks)},
           {"doubts_per_1000", 1e3 * a_ray(counters.edge_doubts)},
           {"near_ties_per_1000", 1e3 * a_ray(counters.depth_doubts)}});
  }
}

void run(const Options& options, const std::filesystem::path& file) {
  const Scene scene = load_obj(file, {.vertices = Vertices::kBinary32});
  const Bvh bvh(scene);
  const auto image = std::make_shared<const MemoryImage>(bvh);
  const auto measure_kind = [&](const std::string& kind, const Trace& trace) {
    if (std::ranges::count(options.kinds, kind) == 0) return;
    measure(options, file.stem().string(), kind, bvh, image, trace);
  };
  for (const RaySet& set : ray_sets(scene, options.size - options.size % 128)) {
    measure_kind(set.name, [&](const IntersectorFactory& make_intersector) {
      std::vector<NearestHit> hits(set.rays.size());
      set.find(*make_intersector(), 0, hits);
      return hits.size();
    });
  }
  for (const auto& [kind, integrator] : kPictures) {
    measure_kind(kind, [&](const IntersectorFactory& make_intersector) {
      const Camera camera = front_camera(scene, 1.0);
      RenderSettings settings;
      settings.width = settings.height = options.size;
      settings.samples = 1;
      settings.integrator = integrator;
      RenderStats stats;
      const PreparedScene prepared(scene, bvh);
      (void)render({prepared, camera, settings, default_lights(scene, camera)}, make_intersector,
                   stats);
      return static_cast<std::size_t>(stats.rays);
    });
  }
}

}  // namespace

void add_core(CLI::App& lab) {
  auto* app = lab.add_subcommand("core", "clocks, lines and bytes a ray of the simulated ray core");
  const auto options = std::make_shared<Options>();
  app->add_option("scenes", options->scenes, "OBJ files")->required();
  app->add_option("--size", options->size, "pixels along each side; a multiple of 128")
      ->check(CLI::Range(128, 8192));
  app->add_option("--latency", options->latencies, "of memory, in clocks; several may be given")
      ->check(CLI::Range(1, 10'000));
  app->add_option("--kinds", options->kinds,
                  "of rays: camera, light, scattered; all of a picture: whitted, path")
      ->check(CLI::IsMember({"camera", "light", "scattered", "whitted", "path"}));
  app->add_flag("--exact", options->exact, "cores settle doubts; else the host does");
  app->callback([options] {
    for (const std::string& scene : options->scenes) run(*options, scene);
  });
}

}  // namespace raygate::lab
