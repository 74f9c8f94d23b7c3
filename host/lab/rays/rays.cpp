// Rays per second of the `cpu` engine and of Embree, on one thread, as medians of processor time.
// Each run of Embree follows a run of raygate. Changes in the machine's speed affect both, so the
// ratio of the two is less noisy than either. Compare only rows of one run.
#include "host/lab/rays/rays.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>

#include "host/base/vectors.h"
#include "host/bvh/bvh.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/lab/lab.h"
#include "host/scene/io/scene_loader.h"

namespace raygate::lab {
namespace {

/// This project as a peer, used as by the renderer: traces the rays of one tile at a time, resolves
/// doubts of float32 by exact arithmetic, and computes P for every nearest hit.
class RaygatePeer : public Peer {
 public:
  explicit RaygatePeer(const Scene& scene) : Peer("raygate"), bvh_(scene) {}

  void prepare(const RaySet& set) override { set_ = &set; }

  void run(Found& found) override {
    CpuIntersector intersector(bvh_);
    const std::size_t rays = set_->rays.size();
    std::vector<NearestHit> hits(intersector.traits().batch);
    for (std::size_t first = 0; first < rays; first += hits.size()) {
      const std::size_t count = std::min(hits.size(), rays - first);
      set_->find(intersector, first, std::span(hits).first(count));
      for (std::size_t i = 0; i < count; ++i) {
        found.triangle[first + i] = triangle_of(hits[i]);
        found.t[first + i] = static_cast<float>(hits[i].t.low);
      }
    }
  }

 private:
  [[nodiscard]] std::uint32_t triangle_of(const NearestHit& hit) const {
    // Branchless, as a branch on the ray's hit would be unpredictable.
    const std::uint32_t found = hit.primitive != NearestHit::kNone ? 1 : 0;
    static_assert(Found::kNone == ~std::uint32_t{0});
    const std::uint32_t triangle = bvh_.triangle_of(hit.primitive & (0 - found));
    return (set_->any_hit ? Found::kSome : triangle) | (found - 1);
  }

  Bvh bvh_;
  const RaySet* set_ = nullptr;
};

struct RaysOptions {
  std::vector<std::string> scenes;
  int size = 1024, repeats = 17;
  std::string embree4;  // path of Embree 4's library; empty: none
};

/// Returns the fraction of rays with equal results: the triangle, or whether any is hit.
double agreement(const Found& a, const Found& b) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.triangle.size(); ++i) same += a.triangle[i] == b.triangle[i];
  return static_cast<double>(same) / static_cast<double>(a.triangle.size());
}

/// Prints the rows of a set: times of raygate, which is peers[0], and of all other peers in turn.
void measure(const RaySet& set, const std::string& scene,
             const std::vector<std::unique_ptr<Peer>>& peers, int repeats) {
  std::vector<Found> found(peers.size(), Found(set.rays.size()));
  std::vector<std::vector<double>> times(peers.size()), ratios(peers.size());
  for (const auto& peer : peers) peer->prepare(set);
  const auto time = [&](std::size_t i) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    peers[i]->run(found[i]);
    return times[i].emplace_back(seconds_of(CLOCK_THREAD_CPUTIME_ID) - start);
  };
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 1; i < peers.size(); ++i) {
      const double ours = time(0);
      ratios[i].push_back(time(i) / ours);
    }
  }
  ratios[0] = {1.0};
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const double middle = quantile(times[i], 0.5);
    print({{"table", "rays"},
           {"scene", scene},
           {"rays", set.name},
           {"by", peers[i]->name},
           {"mrays_per_second", static_cast<double>(set.rays.size()) / middle * 1e-6},
           {"raygate_over_peer", quantile(ratios[i], 0.5)},
           {"lower_quartile", quantile(ratios[i], 0.25)},
           {"upper_quartile", quantile(ratios[i], 0.75)},
           {"repeats", repeats},
           {"agreed_percent", 100.0 * agreement(found[0], found[i])},
           {"machine_vectors", name_of(widest_vectors())},
           {"engine_vectors", name_of(vectors_in_use())}});
  }
}

void run(const RaysOptions& options) {
  for (const std::filesystem::path file : options.scenes) {
    const Scene scene = load_obj(file, {.vertices = Vertices::kBinary32});
    std::vector<std::unique_ptr<Peer>> peers;
    peers.push_back(make_raygate(scene));
    std::ranges::move(make_embrees(scene), std::back_inserter(peers));
    if (!options.embree4.empty()) {
      std::ranges::move(make_embrees4(scene, options.embree4), std::back_inserter(peers));
    }
    for (const RaySet& set : ray_sets(scene, options.size - options.size % 128)) {
      measure(set, file.stem().string(), peers, options.repeats);
    }
  }
}

}  // namespace

std::unique_ptr<Peer> make_raygate(const Scene& scene) {
  return std::make_unique<RaygatePeer>(scene);
}

void add_rays(CLI::App& lab) {
  auto* app = lab.add_subcommand("rays", "rays per second of the cpu engine and of Embree");
  const auto options = std::make_shared<RaysOptions>();
  app->add_option("scenes", options->scenes, "OBJ files")->required();
  app->add_option("--size", options->size, "pixels along each side; a multiple of 128")
      ->check(CLI::Range(128, 8192));
  app->add_option("--repeats", options->repeats, "of each set of rays by each peer")
      ->check(CLI::Range(1, 1000));
  app->add_option("--embree4", options->embree4, "the shared library of Embree 4, to compare, too")
      ->check(CLI::ExistingFile);
  app->callback([options] { run(*options); });
}

}  // namespace raygate::lab
