// Rays a second of the `cpu` engine and of Embree 3, in one run: a table. Nothing passes or fails
// here. The peers take turns, so that whatever else the machine does meets them alike; compare the
// rows and columns of one table.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>

#include "host/lab/rays/peer.h"
#include "host/lab/rays/ray_sets.h"
#include "host/scene/io/obj_loader.h"

namespace raygate::rays {
namespace {

struct Options {
  std::vector<std::string> scenes;
  int size = 1024;
  int repeats = 7;
  bool alone = false;
  std::string only;  // one set of rays; empty: all
};

/// Seconds that this thread has run: what other programs take does not count.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Seconds of one peer's repeats, sorted.
using Times = std::vector<double>;

double median(const Times& times) { return times[times.size() / 2]; }

/// How far the middle half of the times spreads, as a part of the median.
double spread(const Times& times) {
  return (times[times.size() * 3 / 4] - times[times.size() / 4]) / median(times);
}

/// The part of the rays about which two peers say the same: which triangle, or whether any.
double agreement(const Found& a, const Found& b) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.triangle.size(); ++i) same += a.triangle[i] == b.triangle[i];
  return static_cast<double>(same) / static_cast<double>(a.triangle.size());
}

/// Times all peers on a set, prints their rows, and gives what the first one found; without
/// repeats, that alone.
Found bench(const std::string& scene, std::span<const std::unique_ptr<Peer>> peers,
            const RaySet& set, int repeats) {
  std::vector<Found> found(peers.size());
  std::vector<Times> times(peers.size());
  for (std::size_t i = 0; i < peers.size(); ++i) {
    peers[i]->prepare(set);
    found[i].triangle.resize(set.rays.size());
    found[i].t.resize(set.rays.size());
  }
  if (repeats == 0) {
    peers[0]->run(found[0]);
    return found[0];
  }
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const double start = thread_seconds();
      peers[i]->run(found[i]);
      times[i].push_back(thread_seconds() - start);
    }
  }
  for (Times& t : times) std::ranges::sort(t);
  for (std::size_t i = 0; i < peers.size(); ++i) {
    std::printf("%-12s %-10s %-16s %8.2f %5.0f %% %8.2f %11.5f %%\n", scene.c_str(),
                set.name.c_str(), peers[i]->name().c_str(),
                static_cast<double>(set.rays.size()) / median(times[i]) * 1e-6,
                100.0 * spread(times[i]), median(times[i]) / median(times[0]),
                100.0 * agreement(found[0], found[i]));
  }
  std::fflush(stdout);
  return found[0];
}

void bench(const std::filesystem::path& file, const Options& options) {
  const Scene scene = load_obj(file);
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(make_raygate(scene));
  if (!options.alone) {
    for (auto& peer : make_embrees(scene)) peers.push_back(std::move(peer));
  }
  const std::string name = file.stem().string();
  const RaySet primary = primary_rays(scene, options.size);
  const auto wanted = [&](const char* set) { return options.only.empty() || options.only == set; };
  const Found seen = bench(name, peers, primary, wanted("primary") ? options.repeats : 0);
  if (wanted("shadow")) bench(name, peers, shadow_rays(scene, primary, seen), options.repeats);
  if (wanted("scattered")) {
    bench(name, peers, scattered_rays(scene, primary, seen), options.repeats);
  }
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Rays a second, on one thread, of the cpu engine and of Embree 3.");
  app.add_option("scenes", options.scenes, "OBJ files")->required();
  app.add_option("--size", options.size, "pixels along each side; a multiple of 128")
      ->check(CLI::Range(128, 8192));
  app.add_option("--repeats", options.repeats, "of each set of rays by each peer")
      ->check(CLI::Range(1, 1000));
  app.add_option("--only", options.only, "primary, shadow or scattered; all, if not given")
      ->check(CLI::IsMember({"primary", "shadow", "scattered"}));
  app.add_flag("--alone", options.alone, "leave Embree out");
  CLI11_PARSE(app, argc, argv);
  options.size -= options.size % 128;
  std::printf(
      "%dx%d, one thread, medians of %d runs, seconds of CPU. ratio: raygate's rays a second by "
      "theirs;\nagreed: rays of which raygate, whose decisions are exact, says the same.\n",
      options.size, options.size, options.repeats);
  std::printf("%-12s %-10s %-16s %8s %7s %8s %13s\n", "scene", "rays", "by", "Mrays/s", "spread",
              "ratio", "agreed");
  for (const std::string& scene : options.scenes) bench(scene, options);
  return 0;
}

}  // namespace
}  // namespace raygate::rays

int main(int argc, char** argv) {
  try {
    return raygate::rays::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
