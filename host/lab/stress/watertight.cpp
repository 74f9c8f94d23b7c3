#include "host/lab/stress/watertight.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/bvh/traversal.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/hit_tester.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "host/intersect/unit/unit_intersector.h"
#include "host/lab/stress/meshes.h"
#include "host/lab/stress/random.h"
#include "host/lab/stress/subjects.h"
#include "host/scene/camera.h"
#include "sim/rtl_burst_unit.h"
#include "sim/rtl_core.h"

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
  std::vector<glm::vec3> vertices{{0, 0, -1}, {0, 1, -1}, {1, 0, -1}, {1, 1, -1}};
  std::vector<std::array<std::size_t, 3>> triangles{{0, 1, 2}, {3, 2, 1}};
  while (static_cast<int>(triangles.size()) < count) {
    const auto n = static_cast<std::size_t>(random.below(static_cast<int>(triangles.size())));
    const auto [p, q, r] = triangles[n];
    const auto along = [&] { return static_cast<float>(random.uniform(0.01, 0.99)); };
    const glm::vec3 edge = glm::mix(vertices[p], vertices[q], along());
    glm::vec3 inner = glm::mix(edge, vertices[r], along());
    inner.z = -along();
    const std::size_t fresh = vertices.size();
    vertices.push_back(inner);
    triangles[n] = {p, q, fresh};
    triangles.push_back({q, r, fresh});
    triangles.push_back({r, p, fresh});
  }
  for (const auto& [a, b, c] : triangles) {
    test.mesh.triangles.push_back({vertices[a], vertices[b], vertices[c]});
  }
  const int side = std::clamp(static_cast<int>(std::sqrt(count)), 16, 256);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      test.rays.push_back(ray_from({(x + 0.5) / side, (y + 0.5) / side, 0.0}, {0, 0, -1}));
    }
  }
  return test;
}

Watertight singlehit(int count) {
  Watertight test{"singlehit", {}, {}};
  const auto rim = [count](int i) {
    const double angle = 2.0 * std::numbers::pi * (i % count) / count;
    return glm::vec3(std::sin(angle), std::cos(angle), 0.0);
  };
  const glm::dvec3 eye(0, 0, -1);
  test.rays.push_back(ray_from(eye, {0, 0, 1}));
  for (int i = 0; i < count; ++i) {
    test.mesh.triangles.push_back({glm::vec3(0.0f), rim(i), rim(i + 1)});
    test.rays.push_back(ray_from(eye, 0.5 * glm::dvec3(rim(i)) - eye));
  }
  return test;
}

enum class Targets { kAnywhere, kEdges, kVertices };

Watertight from_inside(const char* name, const Placement& placement, int count, Targets aim,
                       Random& random) {
  Watertight test{name, *sphere(5, placement), {}};
  const auto& triangles = test.mesh.triangles;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 origin = 0.25 * placement.scale * random.point() + placement.shift;
    const Corners& t =
        triangles[static_cast<std::size_t>(random.below(static_cast<int>(triangles.size())))];
    const double along = aim == Targets::kEdges ? random.uniform(0, 1) : 0.0;
    const glm::dvec3 target = glm::mix(glm::dvec3(t[0]), glm::dvec3(t[1]), along);
    test.rays.push_back(ray_from(origin, aim == Targets::kAnywhere
                                             ? random.unit()
                                             : target - glm::dvec3(glm::vec3(origin))));
  }
  return test;
}

/// Returns the number of hits of each ray; 0 or 1 for hit tests that find only the nearest hit.
using CountHits = std::function<std::vector<std::uint32_t>(std::span<const Ray>)>;

/// A hit test, such as an engine, and its maximum number of rays, which is small for simulations.
struct Contestant {
  std::string name;
  bool is_exact, finds_all;
  std::size_t most_rays;
  std::function<CountHits(const Bvh&)> make;
};

CountHits count_nearest(const std::shared_ptr<Intersector>& intersector) {
  return [intersector](std::span<const Ray> rays) {
    std::vector<NearestHit> hits(rays.size());
    intersector->nearest(rays, {}, hits);
    std::vector<std::uint32_t> counts(rays.size());
    std::ranges::transform(hits, counts.begin(), [](const NearestHit& hit) {
      return hit.primitive == NearestHit::kNone ? 0u : 1u;
    });
    return counts;
  };
}

/// Returns a mask of the children whose boxes a ray may enter, including all rounding.
LaneMask boxes_entered(const Ray& ray, const Bvh::Node& node) {
  constexpr double kWide = 1e-6;
  LaneMask met = 0;
  for (int i = 0; i < Bvh::kWidth; ++i) {
    const auto [low, high] = node.box(i);
    if (low.x > high.x) continue;
    double first = 0.0, last = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double origin = ray.origin[k], direction = ray.direction[k];
      const double margin = kWide * (std::abs(origin) + std::abs(low[k]) + std::abs(high[k]));
      double near = low[k] - margin - origin, far = high[k] + margin - origin;
      if (direction == 0.0) {
        if (near > 0.0 || far < 0.0) last = -1.0;
        continue;
      }
      near /= direction;
      far /= direction;
      first = std::max(first, std::min(near, far));
      last = std::min(last, std::max(near, far));
    }
    if (first <= last) met |= 1u << i;
  }
  return met;
}

CountHits count_by(TriangleTest* test, const Bvh& bvh) {
  return [test, &bvh](std::span<const Ray> rays) {
    std::vector<std::uint32_t> counts;
    for (const Ray& ray : rays) {
      std::uint32_t& count = counts.emplace_back(0);
      const auto boxes = [&](const Bvh::Node& node) { return boxes_entered(ray, node); };
      any_leaf(bvh, boxes, [&](const Bvh::Child& leaf) {
        for (std::uint32_t i = 0; i < leaf.count; ++i) {
          count += test(ray.origin, ray.direction, bvh.corners_of(leaf.first + i)).hit;
        }
        return false;
      });
    }
    return counts;
  };
}

std::vector<Contestant> contestants() {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max(), kSome = 8192;
  const auto unit = [](auto make_unit) {
    return [make_unit](const Bvh& bvh) {
      return count_nearest(
          std::make_shared<UnitIntersector>(bvh, std::make_shared<PipelineHitTester>(make_unit())));
    };
  };
  std::vector<Contestant> all;
  all.push_back({"cpu", true, true, kAll, [](const Bvh& bvh) -> CountHits {
                   return [&bvh](std::span<const Ray> rays) {
                     std::vector<std::uint32_t> counts;
                     std::vector<NearestHit> hits;
                     RayWork work;
                     for (const Ray& ray : rays) {
                       all_hits(bvh, ray, std::numeric_limits<float>::infinity(), hits, work);
                       counts.push_back(static_cast<std::uint32_t>(hits.size()));
                     }
                     return counts;
                   };
                 }});
  all.push_back(
      {"model", true, false, kAll, unit([] { return std::make_unique<ReferenceBurstUnit>(); })});
  all.push_back(
      {"rtl", true, false, kSome, unit([] { return std::make_unique<RtlBurstUnit>(1); })});
  all.push_back({"rtl exact core", true, false, kSome, [](const Bvh& bvh) {
                   return count_nearest(std::make_shared<CoreIntersector>(
                       bvh, std::make_shared<const MemoryImage>(bvh),
                       std::shared_ptr<CoreUnit>(make_rtl_core({}, {}, {.exact = true}))));
                 }});
  const std::pair<const char*, TriangleTest*> others[] = {{"Moeller-Trumbore", moeller_trumbore},
                                                          {"Woop 2013", woop}};
  for (const auto& [name, test] : others) {
    all.push_back(
        {name, false, true, kAll, [test = test](const Bvh& bvh) { return count_by(test, bvh); }});
  }
  return all;
}

Row row_of(const std::string& test, const std::string& by, std::size_t triangles, bool is_exact,
           bool finds_all, std::span<const std::uint32_t> counts) {
  const auto escapes = std::ranges::count(counts, 0u);
  const auto doubles = std::ranges::count_if(counts, [](std::uint32_t count) { return count > 1; });
  return {{"table", "watertight"},  {"test", test},
          {"triangles", triangles}, {"by", by},
          {"exact", is_exact},      {"rays", counts.size()},
          {"escapes", escapes},     {"double_hits", finds_all ? Row(doubles) : Row(nullptr)}};
}

}  // namespace

std::vector<Row> watertight_rows(const WatertightOptions& asked) {
  std::vector<Row> rows;
  std::vector<Watertight> tests;
  for (int seed = 1; seed <= asked.seeds; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    tests.push_back(nomiss(asked.triangles, random));
  }
  Random random(1);
  const Placement far{glm::dvec3(2.0), {148376.0, 1234.0, -223423.0}};
  constexpr int kMostInFan = 1024;  // in larger fans, each ray meets most of the long boxes
  tests.push_back(singlehit(std::min(asked.triangles, kMostInFan)));
  tests.push_back(from_inside("sphere", far, asked.triangles, Targets::kAnywhere, random));
  tests.push_back(from_inside("edges", {}, asked.triangles, Targets::kEdges, random));
  tests.push_back(from_inside("vertices", {}, asked.triangles, Targets::kVertices, random));
  // Tests with the same name are combined into one row.
  for (std::size_t first = 0; first < tests.size();) {
    std::size_t end = first;
    std::vector<Contestant> all = contestants();
    std::vector<std::vector<std::uint32_t>> counts(all.size());
    std::vector<std::string> embrees;
    std::vector<std::vector<std::uint32_t>> embree_counts;
    for (; end < tests.size() && tests[end].name == tests[first].name; ++end) {
      const Watertight& test = tests[end];
      const Scene scene = scene_of(test.mesh);
      const Bvh bvh(scene);
      for (std::size_t i = 0; i < all.size(); ++i) {
        const std::size_t rest = all[i].most_rays - std::min(all[i].most_rays, counts[i].size());
        const auto found =
            all[i].make(bvh)(std::span(test.rays).first(std::min(test.rays.size(), rest)));
        counts[i].insert(counts[i].end(), found.begin(), found.end());
      }
      std::size_t i = 0;
      for (auto& [name, found] : embree_hit_counts(scene, test.rays)) {
        if (end == first) embrees.push_back(name), embree_counts.emplace_back();
        embree_counts[i].insert(embree_counts[i].end(), found.begin(), found.end());
        ++i;
      }
    }
    const Watertight& test = tests[first];
    const auto add = [&](const std::string& name, bool is_exact, bool finds_all,
                         const auto& found) {
      rows.push_back(
          row_of(test.name, name, test.mesh.triangles.size(), is_exact, finds_all, found));
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      add(all[i].name, all[i].is_exact, all[i].finds_all, counts[i]);
    }
    for (std::size_t i = 0; i < embrees.size(); ++i) {
      add(embrees[i], false, true, embree_counts[i]);
    }
    first = end;
  }
  return rows;
}

bool is_watertight(const Row& row) {
  return row["escapes"] == 0 && (row["double_hits"].is_null() || row["double_hits"] == 0);
}

}  // namespace raygate::lab
