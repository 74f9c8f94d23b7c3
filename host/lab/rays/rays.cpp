// Rays per second of the `cpu` engine and of Embree 3, in one run. Nothing passes or fails here.
// The peers take turns, so that whatever else the machine does meets them alike; compare the rows
// of one table.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "host/lab/commands.h"
#include "host/lab/rays/peer.h"
#include "host/lab/rays/ray_sets.h"
#include "host/lab/results.h"
#include "host/lab/timing.h"
#include "host/scene/io/scene_loader.h"

namespace raygate::lab {
namespace {

struct Options {
  std::vector<std::string> scenes;
  int size = 1024, repeats = 7;
  bool alone = false;
  std::string only;  // one set of rays; empty: all
};

/// The part of the rays about which two peers say the same: which triangle, or whether any.
double agreement(const Found& a, const Found& b) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.triangle.size(); ++i) same += a.triangle[i] == b.triangle[i];
  return static_cast<double>(same) / static_cast<double>(a.triangle.size());
}

class Bench {
 public:
  Bench(const Options& options, const std::filesystem::path& results)
      : options_(options), results_(results) {}

  void scene(const std::filesystem::path& file) {
    const Scene scene = load_obj(file);
    name_ = file.stem().string();
    peers_.clear();
    peers_.push_back(make_raygate(scene));
    if (!options_.alone) {
      for (auto& peer : make_embrees(scene)) peers_.push_back(std::move(peer));
    }
    const auto repeats = [&](const RaySet& set) {
      return options_.only.empty() || options_.only == set.name ? options_.repeats : 0;
    };
    const RaySet camera = camera_rays(scene, options_.size);
    const Found seen = run(camera, repeats(camera));
    for (const RaySet& set :
         {light_rays(scene, camera, seen), scattered_rays(scene, camera, seen)}) {
      if (repeats(set) != 0) run(set, repeats(set));
    }
  }

 private:
  /// Times all peers on a set and gives what the first one found; without repeats, that alone.
  Found run(const RaySet& set, int repeats) {
    std::vector<Found> found(peers_.size());
    std::vector<std::vector<double>> times(peers_.size());
    const auto once = [&](std::size_t i) {
      const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
      peers_[i]->run(found[i]);
      times[i].push_back(seconds_of(CLOCK_THREAD_CPUTIME_ID) - start);
    };
    for (std::size_t i = 0; i < peers_.size(); ++i) {
      peers_[i]->prepare(set);
      found[i].triangle.resize(set.rays.size());
      found[i].t.resize(set.rays.size());
    }
    if (repeats == 0) once(0);
    for (int repeat = 0; repeat < repeats; ++repeat) {
      for (std::size_t i = 0; i < peers_.size(); ++i) once(i);
    }
    for (std::size_t i = 0; repeats != 0 && i < peers_.size(); ++i) {
      const Row row = {
          {"table", "rays"},
          {"scene", name_},
          {"rays", set.name},
          {"by", peers_[i]->name()},
          {"mrays_per_second", static_cast<double>(set.rays.size()) / median(times[i]) * 1e-6},
          {"spread_percent", 100.0 * spread(times[i])},
          {"raygate_over_peer", median(times[i]) / median(times[0])},
          {"agreed_percent", 100.0 * agreement(found[0], found[i])}};
      table_.print(row);
      Row kept = row;
      kept.update(machine_kind());
      results_.add(kept);
    }
    return found[0];
  }

  const Options& options_;
  Results results_;
  std::string name_;
  std::vector<std::unique_ptr<Peer>> peers_;
  TextTable table_{{{"scene", "scene", -1, 12},
                    {"rays", "rays", -1, 10},
                    {"by", "by", -1, 15},
                    {"mrays_per_second", "Mrays/s", 2},
                    {"spread_percent", "spread, %", 1},
                    {"raygate_over_peer", "raygate over it", 2},
                    {"agreed_percent", "agreed, %", 5}}};
};

}  // namespace

void add_rays(CLI::App& lab, Common& common) {
  auto* app = lab.add_subcommand("rays", "rays per second of the cpu engine and of Embree 3");
  const auto options = std::make_shared<Options>();
  app->add_option("scenes", options->scenes, "OBJ files")->required();
  app->add_option("--size", options->size, "pixels along each side; a multiple of 128")
      ->check(CLI::Range(128, 8192));
  app->add_option("--repeats", options->repeats, "of each set of rays by each peer")
      ->check(CLI::Range(1, 1000));
  app->add_option("--only", options->only, "camera, light or scattered; all, if not given")
      ->check(CLI::IsMember({"camera", "light", "scattered"}));
  app->add_flag("--alone", options->alone, "leave Embree out");
  app->callback([options, &common] {
    options->size -= options->size % 128;
    const Row machine = machine_kind();
    std::printf(
        "%s, widest vectors %s; the cpu engine uses %s, Embree the widest that it knows.\n"
        "%dx%d pixels, one thread, medians of %d runs in processor time. agreed: rays of which\n"
        "raygate, whose decisions are exact, says the same.\n",
        machine["processor"].get<std::string>().c_str(),
        machine["machine_vectors"].get<std::string>().c_str(),
        machine["engine_vectors"].get<std::string>().c_str(), options->size, options->size,
        options->repeats);
    Bench bench(*options, common.results);
    for (const std::string& scene : options->scenes) bench.scene(scene);
  });
}

}  // namespace raygate::lab
