// Rays per second of the `cpu` engine and of Embree, on one thread, as medians of processor time.
// The peers take turns, so that changes in the machine's speed affect them alike. Compare only rows
// of the same run.
#include "host/lab/rays/rays.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "host/lab/commands.h"
#include "host/lab/timing.h"
#include "host/scene/io/scene_loader.h"

namespace raygate::lab {
namespace {

struct RaysOptions {
  std::vector<std::string> scenes;
  int size = 1024, repeats = 15;
  std::string embree4;  // path of its library; empty: none
};

/// Returns the fraction of rays with equal results: the triangle, or whether any is hit.
double agreement(const Found& a, const Found& b) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.triangle.size(); ++i) same += a.triangle[i] == b.triangle[i];
  return static_cast<double>(same) / static_cast<double>(a.triangle.size());
}

/// Times all peers on a set, in turns.
void measure(const RaySet& set, const std::string& scene,
             const std::vector<std::unique_ptr<Peer>>& peers, int repeats, Results& results) {
  std::vector<Found> found(peers.size(), Found(set.rays.size()));
  std::vector<std::vector<double>> times(peers.size());
  for (const auto& peer : peers) peer->prepare(set);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
      peers[i]->run(found[i]);
      times[i].push_back(seconds_of(CLOCK_THREAD_CPUTIME_ID) - start);
    }
  }
  for (std::size_t i = 0; i < peers.size(); ++i) {
    Row row = {{"table", "rays"},
               {"scene", scene},
               {"rays", set.name},
               {"by", peers[i]->name()},
               {"mrays_per_second", static_cast<double>(set.rays.size()) / median(times[i]) * 1e-6},
               {"spread_percent", 100.0 * spread(times[i])},
               {"raygate_over_peer", median(times[i]) / median(times[0])},
               {"agreed_percent", 100.0 * agreement(found[0], found[i])}};
    row.update(machine_kind());
    results.add(std::move(row));
  }
}

void run(const RaysOptions& options, Results& results) {
  for (const std::filesystem::path file : options.scenes) {
    const Scene scene = load_obj(file);
    std::vector<std::unique_ptr<Peer>> peers;
    peers.push_back(make_raygate(scene));
    std::ranges::move(make_embrees(scene), std::back_inserter(peers));
    if (!options.embree4.empty()) {
      std::ranges::move(make_embrees4(scene, options.embree4), std::back_inserter(peers));
    }
    for (const RaySet& set : ray_sets(scene, options.size - options.size % 128)) {
      measure(set, file.stem().string(), peers, options.repeats, results);
    }
  }
}

}  // namespace

void add_rays(CLI::App& lab, Outcome& outcome) {
  auto* app = lab.add_subcommand("rays", "rays per second of the cpu engine and of Embree");
  const auto options = std::make_shared<RaysOptions>();
  app->add_option("scenes", options->scenes, "OBJ files")->required();
  app->add_option("--size", options->size, "pixels along each side; a multiple of 128")
      ->check(CLI::Range(128, 8192));
  app->add_option("--repeats", options->repeats, "of each set of rays by each peer")
      ->check(CLI::Range(1, 1000));
  app->add_option("--embree4", options->embree4, "the shared library of Embree 4, to compare, too")
      ->check(CLI::ExistingFile);
  app->callback([options, &outcome] { run(*options, outcome.results); });
}

}  // namespace raygate::lab
