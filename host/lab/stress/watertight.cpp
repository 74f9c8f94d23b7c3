// Public acceptance tests of watertightness, for engines and other ray tracers' hit tests.
//
// nomiss: from the Vulkan conformance tests (ray_tracing_pipeline.watertightness.nomiss). A square
//   of two triangles is refined to N triangles by points at random heights in random triangles.
//   Every ray of a grid along -z (256 x 256 for 65,536 triangles) must hit.
// singlehit: from the same tests. A closed fan of up to 1,024 triangles, and rays from its axis to
//   its centre and to the middle of every inner edge. The original counts repeated hits of one
//   triangle as duplicates; here, more than one hit is a duplicate.
// sphere: from Embree (tutorials/verify, watertight). Random rays from around the centre of a
//   sphere far from the origin must hit.
// edges, vertices: as in Woop, Benthin and Wald 2013. Rays from inside a sphere at its edges and
//   vertices must hit.
//
// Vertices are binary32, or binary64 for the engines that take them. The random numbers and the
// sphere's triangles differ from the originals.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/lab/stress/stress.h"
#include "host/scene/camera.h"

namespace raygate::lab {
namespace {

/// A mesh, and rays that must hit it exactly once.
struct Watertight {
  std::string name;
  Mesh mesh;
  std::vector<Ray> rays;
};

Ray ray_from(const glm::dvec3& origin, const glm::dvec3& direction) {
  return {glm::vec3(origin), scaled_direction(direction)};
}

Watertight nomiss(int count, Random& random) {
  Watertight test{"nomiss", {}, {}};
  std::vector<glm::dvec3> vertices{{0, 0, -1}, {0, 1, -1}, {1, 0, -1}, {1, 1, -1}};
  std::vector<std::array<std::size_t, 3>> triangles{{0, 1, 2}, {3, 2, 1}};
  while (static_cast<int>(triangles.size()) < count) {
    const auto n = static_cast<std::size_t>(random.below(static_cast<int>(triangles.size())));
    const auto [p, q, r] = triangles[n];
    const auto along = [&] { return random.uniform(0.01, 0.99); };
    const glm::dvec3 edge = glm::mix(vertices[p], vertices[q], along());
    glm::dvec3 inner = glm::mix(edge, vertices[r], along());
    inner.z = -along();
    const std::size_t fresh = vertices.size();
    vertices.push_back(random.vertex(inner));
    triangles[n] = {p, q, fresh};
    triangles.push_back({q, r, fresh});
    triangles.push_back({r, p, fresh});
  }
  for (const auto& [a, b, c] : triangles) {
    test.mesh.push_back({vertices[a], vertices[b], vertices[c]});
  }
  const int side = std::clamp(static_cast<int>(std::sqrt(count)), 16, 256);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      test.rays.push_back(ray_from({(x + 0.5) / side, (y + 0.5) / side, 0.0}, {0, 0, -1}));
    }
  }
  return test;
}

Watertight singlehit(int count, const Random& random) {
  Watertight test{"singlehit", {}, {}};
  const auto rim = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * (i % count) / count;
    return random.vertex({std::sin(angle), std::cos(angle), 0.0});
  };
  const glm::dvec3 eye(0, 0, -1);
  test.rays.push_back(ray_from(eye, {0, 0, 1}));
  for (int i = 0; i < count; ++i) {
    test.mesh.push_back({glm::dvec3(0.0), rim(i), rim(i + 1)});
    test.rays.push_back(ray_from(eye, 0.5 * rim(i) - eye));
  }
  return test;
}

enum class Targets { kAnywhere, kEdges, kVertices };

Watertight from_inside(const char* name, Placement placement, int count, Targets aim,
                       Random& random) {
  placement.binary64 = random.binary64_vertices;
  Watertight test{name, *sphere(5, placement), {}};
  const Mesh& triangles = test.mesh;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 origin = 0.25 * placement.scale * random.point() + placement.shift;
    const Corners& t =
        triangles[static_cast<std::size_t>(random.below(static_cast<int>(triangles.size())))];
    const double along = aim == Targets::kEdges ? random.uniform(0, 1) : 0.0;
    const glm::dvec3 target = glm::mix(t[0], t[1], along);
    test.rays.push_back(ray_from(origin, aim == Targets::kAnywhere
                                             ? random.unit()
                                             : target - glm::dvec3(glm::vec3(origin))));
  }
  return test;
}

/// Numbers of hits, by ray.
using Counts = std::vector<std::uint32_t>;

/// A hit test, such as an engine, and the counts of its hits.
struct Contestant {
  std::string name;
  bool is_exact, finds_all;
  Counts counts{};
};

/// Counts nearest hits: 0 or 1 per ray.
Counts count_nearest(Intersector& intersector, std::span<const Ray> rays) {
  std::vector<NearestHit> hits(rays.size());
  intersector.nearest(rays, {}, hits);
  Counts counts;
  for (const NearestHit& hit : hits) counts.push_back(hit.primitive == NearestHit::kNone ? 0 : 1);
  return counts;
}

Counts count_all(const Bvh& bvh, std::span<const Ray> rays) {
  Counts counts;
  std::vector<NearestHit> hits;
  RayWork work;
  for (const Ray& ray : rays) {
    all_hits(bvh, ray, std::numeric_limits<float>::infinity(), hits, work);
    counts.push_back(static_cast<std::uint32_t>(hits.size()));
  }
  return counts;
}

/// Adds the counts of all hit tests for one mesh: the cpu engine, hit tests that find the nearest
/// hit only, and Embree. Simulated hardware takes only the first kSimulated rays.
void add_counts(const Watertight& test, std::vector<Contestant>& all) {
  constexpr std::size_t kSimulated = 8192;
  const Scene scene = test::scene_of(test.mesh);
  const Bvh bvh(scene);
  const auto add = [&](const std::string& name, bool is_exact, bool finds_all, const auto& count,
                       std::size_t most = std::numeric_limits<std::size_t>::max()) {
    auto mine = std::ranges::find(all, name, &Contestant::name);
    if (mine == all.end()) mine = all.insert(mine, {name, is_exact, finds_all});
    const std::size_t left = most - std::min(most, mine->counts.size());
    const Counts found = count(std::span(test.rays).first(std::min(test.rays.size(), left)));
    mine->counts.insert(mine->counts.end(), found.begin(), found.end());
  };
  add("cpu", true, true, [&](std::span<const Ray> rays) { return count_all(bvh, rays); });
  for (const SubjectKind& kind : engine_subjects()) {
    if (kind.name != "model" && kind.name != "rtl" && kind.name != "rtl exact core") continue;
    if (!kind.binary64 && !scene.rests.empty()) continue;
    const auto count = [&](std::span<const Ray> rays) {
      return count_nearest(*kind.engine()(bvh), rays);
    };
    add(kind.name, true, false, count,
        kind.simulated ? kSimulated : std::numeric_limits<std::size_t>::max());
  }
  if (!scene.rests.empty()) return;
  for (const auto& [name, counts] : embree_hit_counts(scene, test.rays)) {
    add(name, false, true, [&](std::span<const Ray>) { return counts; });
  }
}

}  // namespace

std::vector<Row> watertight_rows(int triangles, int seeds) {
  std::vector<Watertight> tests;
  for (const bool binary64 : {false, true}) {
    const std::size_t first = tests.size();
    for (int seed = 1; seed <= seeds; ++seed) {
      Random random(static_cast<std::uint64_t>(seed));
      random.binary64_vertices = binary64;
      tests.push_back(nomiss(triangles, random));
    }
    Random random(1);
    random.binary64_vertices = binary64;
    const Placement far{glm::dvec3(2.0), {148376.0, 1234.0, -223423.0}},
        third{glm::dvec3(1.0 / 3.0)};
    constexpr int kMostInFan = 1024;  // larger fans are slow: each ray meets most boxes
    tests.push_back(singlehit(std::min(triangles, kMostInFan), random));
    tests.push_back(from_inside("sphere", far, triangles, Targets::kAnywhere, random));
    tests.push_back(from_inside("edges", third, triangles, Targets::kEdges, random));
    tests.push_back(from_inside("vertices", third, triangles, Targets::kVertices, random));
    for (std::size_t i = first; i < tests.size() && binary64; ++i) tests[i].name += " 64";
  }
  std::vector<Row> rows;
  std::vector<Contestant> all;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    add_counts(tests[i], all);
    // Tests with the same name share their rows.
    if (i + 1 < tests.size() && tests[i + 1].name == tests[i].name) continue;
    for (const Contestant& by : all) {
      const auto doubles = std::ranges::count_if(by.counts, [](auto n) { return n > 1; });
      rows.push_back({{"table", "watertight"},
                      {"test", tests[i].name},
                      {"triangles", tests[i].mesh.size()},
                      {"by", by.name},
                      {"exact", by.is_exact},
                      {"rays", by.counts.size()},
                      {"escapes", std::ranges::count(by.counts, 0u)},
                      {"double_hits", by.finds_all ? Row(doubles) : Row(nullptr)}});
    }
    all.clear();
  }
  return rows;
}

void add_watertight(CLI::App& lab) {
  struct Asked {
    int triangles = 65536, seeds = 10;
  };
  auto* app = lab.add_subcommand("watertight", "public tests of watertightness");
  const auto asked = std::make_shared<Asked>();
  app->add_option("--triangles", asked->triangles, "triangles of a mesh, and rays")
      ->check(CLI::Range(4, 1 << 20));
  app->add_option("--seeds", asked->seeds, "meshes of nomiss")->check(CLI::Range(1, 100));
  app->callback([asked] {
    for (const Row& row : watertight_rows(asked->triangles, asked->seeds)) print(row);
  });
}

}  // namespace raygate::lab
