// The simulated ray core finds the hits that CpuIntersector finds, under any delays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <tuple>

#include "Vray_core_shared.h"
#include "Vray_core_small.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/core/core_intersector.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/core_cases.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/intersector.h"
#include "sim/core_model.h"
#include "sim/rtl_core.h"

namespace raygate {
namespace {

using test::bodies;
using test::Random;
using test::some_rays;

class RayCoreTest : public testing::Test {
 protected:
  /// Throws if the core, with the host's help, and CpuIntersector differ.
  void check(const std::vector<Ray>& rays, RayQuery query, std::unique_ptr<CoreUnit> core) {
    const CoreUnit& unit = *core;
    CheckIntersector intersector(bvh_,
                                 std::make_unique<CoreIntersector>(bvh_, image_, std::move(core)),
                                 std::make_unique<CpuIntersector>(bvh_));
    std::vector<NearestHit> hits(rays.size());
    query.with_points = query.any_hit_before.empty() && query.skip_ids.empty();
    intersector.nearest(rays, query, hits);
    counters_ = unit.counters();
  }

  Bvh bvh_{test::scene_of(bodies())};
  std::shared_ptr<const MemoryImage> image_ = std::make_shared<MemoryImage>(bvh_);
  Random random_;
  CoreCounters counters_;
};

/// A pipelined core, or a core with few shared floating-point cores (parameter Clocks > 1).
class EachRayCoreTest : public RayCoreTest, public testing::WithParamInterface<bool> {
 protected:
  std::unique_ptr<CoreUnit> core(const MemoryTiming& timing = {}, const CoreStalls& stalls = {}) {
    if (GetParam()) return std::make_unique<CoreModel<Vray_core_shared>>(timing, stalls);
    return make_rtl_core(timing, stalls);
  }
};

INSTANTIATE_TEST_SUITE_P(Arithmetic, EachRayCoreTest, testing::Values(false, true),
                         [](const auto& kind) { return kind.param ? "InTurns" : "InPipelines"; });

TEST_F(RayCoreTest, NearestHitsAreTheCpuIntersectors) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 10'000);
  check(rays, {}, make_rtl_core());
  EXPECT_GT(counters_.edge_doubts, 50u);
  EXPECT_GT(counters_.depth_doubts, 50u);
  EXPECT_LT(counters_.lines, (counters_.nodes + counters_.tests) / 8) << "caches hold the scene";
  EXPECT_LT(counters_.clocks, counters_.nodes * 5 / 4) << "a node in nearly every clock";
}

TEST_F(RayCoreTest, ANodeAndATriangleAreTakenInEachOfTheirTurns) {
  constexpr std::uint64_t kClocks = 11;  // parameter Clocks of Vray_core_shared
  check(some_rays(bodies(), random_, 3'000), {},
        std::make_unique<CoreModel<Vray_core_shared>>(MemoryTiming{}));
  const std::uint64_t turns = std::max(counters_.nodes, counters_.tests);
  EXPECT_GE(counters_.clocks, kClocks * turns);
  EXPECT_LT(counters_.clocks, kClocks * turns * 5 / 4);
}

TEST_F(RayCoreTest, CoresShareAMemory) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 1'000);
  const auto clocks = [&](const MemoryTiming& timing, const CoreSet& set) {
    check(rays, {}, make_rtl_core(timing, {}, set));
    EXPECT_GE(counters_.rays, rays.size());
    return static_cast<double>(counters_.clocks);
  };
  const double one = clocks({}, {}), three = clocks({}, {.cores = 3});
  EXPECT_LT(three, 0.45 * one);
  const MemoryTiming narrow{.bytes = 1};  // a line every 64 clocks
  const double alone = clocks(narrow, {});
  EXPECT_GT(clocks(narrow, {.cores = 3}), 0.45 * alone) << "there is contention";
  EXPECT_GT(counters_.waits, counters_.lines);
}

/// After resets in mid-run, at any clock, later rays have the right hits.
TEST_F(RayCoreTest, ResetsInMidRunLeaveNothing) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 100);
  std::vector<CoreRay> abandoned;
  for (const Ray& ray : rays) abandoned.push_back({.ray = ray});
  const MemoryTiming timing{.latency = 20, .disorder = 100, .not_taken = 64};
  const auto run = [&](auto core) {
    for (int resets = random_.below(4); resets >= 0; --resets) {
      core->abandon(image_->lines(), abandoned, static_cast<unsigned>(1 + random_.below(1'500)));
    }
    check(rays, {}, std::move(core));
  };
  const CoreStalls stalls{.not_taken = 100};
  for (int round = 0; round < 8; ++round) {
    run(std::make_unique<CoreModel<Vray_core_small>>(timing, stalls));
    run(std::make_unique<CoreModel<Vray_core_shared>>(timing, stalls));
  }
}

/// The same core traces different scenes, one after the other.
TEST_F(RayCoreTest, ScenesFollowEachOther) {
  const Bvh other{test::scene_of(test::box(glm::vec3(-0.7f), glm::vec3(0.6f)))};
  const MemoryImage image(other);
  const std::vector<Ray> rays = some_rays(bodies(), random_, 200);
  CoreModel<Vray_core_small> core({});
  std::size_t found[2]{}, compared = 0;
  for (int turn = 0; turn < 6; ++turn) {
    const MemoryImage& now = turn % 2 == 0 ? *image_ : image;
    std::vector<CoreRay> sent;
    for (const Ray& ray : rays)
      sent.push_back({.ray = ray, .tag = static_cast<std::uint32_t>(sent.size())});
    std::vector<CoreResult> results;
    core.trace(now.lines(), sent, results);
    std::map<std::uint32_t, std::vector<CoreResult>> words;
    for (const CoreResult& result : results) words[result.tag].push_back(result);
    for (const CoreRay& ray : sent) {
      std::vector<CoreResult> expected;
      ReferenceCore().trace(now.lines(), {&ray, 1}, expected);
      if (expected.size() != 1 || words[ray.tag].size() != 1) continue;
      ASSERT_EQ(words[ray.tag][0].found, expected[0].found);
      if (expected[0].found) {
        ASSERT_EQ(words[ray.tag][0].t, expected[0].t);
      }
      found[turn % 2] += expected[0].found;
      ++compared;
    }
  }
  EXPECT_GT(compared, 600u);
  EXPECT_NE(found[0], found[1]);
}

TEST_F(RayCoreTest, ArithmeticsGiveTheSame) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 500);
  check(rays, {}, make_rtl_core({}, {}, {.exact = true}));
  const CoreCounters behavioural = counters_;
  check(rays, {}, make_rtl_core({}, {}, {.exact = true, .arith = Arith::kStructural}));
  EXPECT_EQ(counters_.clocks, behavioural.clocks);
  EXPECT_EQ(counters_.tests, behavioural.tests);
}

TEST_P(EachRayCoreTest, WaitsChangeNothing) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 2'000);
  for (const MemoryTiming& timing :
       {MemoryTiming{.latency = 1}, MemoryTiming{.latency = 200, .disorder = 300, .seed = 1},
        MemoryTiming{.latency = 50, .bytes = 16, .not_taken = 64, .seed = 2},
        MemoryTiming{.latency = 20, .cache_lines = 16, .cache_latency = 2}}) {
    check(rays, {}, core(timing, {.no_ray = 32, .not_taken = 200, .seed = 3}));
    check(rays, {}, core(timing));
  }
}

TEST_P(EachRayCoreTest, LimitsIgnoredTrianglesAndFirstHitsCount) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 3'000);
  std::vector<float> limits, enough;
  std::vector<std::uint32_t> ignored;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    limits.push_back(random_.below(4) == 0 ? std::numeric_limits<float>::infinity()
                                           : random_.uniform(0.01f, 3.0f));
    enough.push_back(random_.below(2) == 0 ? limits.back() : 0.5f * limits.back());
    ignored.push_back(
        static_cast<std::uint32_t>(random_.below(static_cast<int>(bvh_.primitive_count()))));
  }
  check(rays, {.t_max = limits}, core());
  check(rays, {.t_max = limits, .skip_ids = ignored}, core());
  const std::uint64_t triangles = counters_.tests;
  check(rays, {.t_max = limits, .skip_ids = ignored, .any_hit_before = enough}, core());
  EXPECT_LT(counters_.tests, triangles);
}

/// A prefetched line may arrive after the last ray has ended. The core must report such lines as
/// outstanding; otherwise CoreModel throws.
TEST_F(RayCoreTest, MemoryIsAtRestWhenTheCoreSaysSo) {
  CoreModel<Vray_core_small> core({.latency = 1, .disorder = 1'000, .seed = 4});
  for (const Ray& ray : some_rays(bodies(), random_, 100)) {
    const CoreRay sent{.ray = ray};
    std::vector<CoreResult> results;
    core.trace(image_->lines(), {&sent, 1}, results);
    ASSERT_FALSE(results.empty());
  }
}

/// Final results, including P, equal those of the reference model in all words but the number of
/// tests. Exception: rays for which either core reported a doubt, because doubts depend on the
/// order of tests.
TEST_P(EachRayCoreTest, EndsAreTheReferences) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 2'000);
  std::vector<CoreRay> sent;
  for (const Ray& ray : rays)
    sent.push_back({.ray = ray, .tag = static_cast<std::uint32_t>(sent.size())});
  std::vector<CoreResult> got, expected;
  const test::FarLines far(*image_);
  core({.latency = 50})->trace(far.lines(), sent, got);
  ReferenceCore().trace(far.lines(), sent, expected);
  std::vector<bool> open(sent.size());
  const auto ends = [&](const std::vector<CoreResult>& results) {
    std::vector<CoreResult> ends(sent.size());
    for (const CoreResult& result : results) {
      if (result.kind == CoreResult::Kind::kEnd) {
        ends[result.tag] = result;
      } else {
        open[result.tag] = true;
      }
    }
    return ends;
  };
  const auto a = ends(got), b = ends(expected);
  int same = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool agree = a[i].found == b[i].found && (!a[i].found || a[i].triangle == b[i].triangle);
    ASSERT_TRUE(agree || open[i]) << i;
    if (!agree || !a[i].found) continue;
    ++same;
    ASSERT_EQ(a[i].t, b[i].t) << i;
    ASSERT_EQ(a[i].t_error, b[i].t_error) << i;
    ASSERT_EQ(a[i].point, b[i].point) << i;
  }
  EXPECT_GT(same, 1'500);
}

/// The traversal of a ray that hits nothing does not depend on timing: the core enters the same
/// nodes and tests the same triangles as the reference model.
TEST_P(EachRayCoreTest, RaysThatHitNothingWalkAsTheReferences) {
  std::vector<CoreRay> all, sent;
  for (const Ray& ray : some_rays(bodies(), random_, 3'000)) {
    CoreRay& one = all.emplace_back(CoreRay{.ray = ray});
    one.tag = static_cast<std::uint32_t>(all.size() - 1);
    if (one.tag % 4 != 0) one.t_max = random_.uniform(0.01f, 3.0f);
  }
  std::vector<CoreResult> results;
  const test::FarLines far(*image_);
  ReferenceCore().trace(far.lines(), all, results);
  for (const CoreResult& result : results) {
    if (result.kind == CoreResult::Kind::kEnd && !result.found) sent.push_back(all[result.tag]);
  }
  ASSERT_GT(sent.size(), 500u);
  const auto tests = [&](CoreUnit& unit) {
    std::vector<CoreResult> words;
    std::vector<std::uint32_t> tests(all.size());
    unit.trace(far.lines(), sent, words);
    for (const CoreResult& result : words) {
      if (result.kind == CoreResult::Kind::kEnd) tests[result.tag] = result.tests;
    }
    return tests;
  };
  ReferenceCore reference;
  const std::unique_ptr<CoreUnit> simulated = core();
  EXPECT_EQ(tests(*simulated), tests(reference));
  EXPECT_EQ(simulated->counters().nodes, reference.counters().nodes);
  EXPECT_EQ(simulated->counters().tests, reference.counters().tests);
}

/// Counters agree with each other and with the results.
TEST_F(RayCoreTest, EventsAreCounted) {
  std::vector<CoreRay> sent;
  for (const Ray& ray : some_rays(bodies(), random_, 2'000)) {
    sent.push_back({.ray = ray, .tag = static_cast<std::uint32_t>(sent.size())});
  }
  CoreModel<Vray_core_small> small({.latency = 3, .not_taken = 128});
  const std::unique_ptr<CoreUnit> large = make_rtl_core({.latency = 3, .not_taken = 128});
  for (CoreUnit* unit : {static_cast<CoreUnit*>(&small), large.get()}) {
    std::vector<CoreResult> results;
    unit->trace(image_->lines(), sent, results);
    const CoreCounters counters = unit->counters();
    const auto number = [&](CoreResult::Kind kind) {
      return static_cast<std::uint64_t>(std::ranges::count(results, kind, &CoreResult::kind));
    };
    std::uint64_t tests = 0;
    for (const CoreResult& result : results) {
      if (result.kind == CoreResult::Kind::kEnd) tests += result.tests;
    }
    EXPECT_EQ(counters.rays, sent.size());
    EXPECT_EQ(counters.rays, number(CoreResult::Kind::kEnd));
    EXPECT_EQ(counters.tests, tests);
    EXPECT_EQ(counters.tests, counters.hits + counters.misses + counters.edge_doubts);
    EXPECT_EQ(counters.overflows != 0, unit == &small);
    EXPECT_GE(number(CoreResult::Kind::kDoubt), counters.depth_doubts);
    EXPECT_GE(counters.edge_doubts + counters.depth_doubts, number(CoreResult::Kind::kDoubt));
    EXPECT_GT(counters.nodes, counters.rays);
    EXPECT_GT(counters.misses, counters.hits);
    EXPECT_GT(counters.waits, counters.lines / 4);
    EXPECT_LT(counters.waits, 4 * counters.lines);
  }
}

/// A ray passes through the boxes of more than 2^16 triangles, and misses all of them.
TEST_F(RayCoreTest, EveryTestIsCounted) {
  std::vector<Corners> mesh;
  for (int n = 0; n < 70'000; ++n) {
    const float x = 1e-4f * static_cast<float>(n);
    mesh.push_back({glm::vec3(x, -1, 1), glm::vec3(x, 1, 1), glm::vec3(x, 1, -0.5f)});
  }
  const Bvh bvh(test::scene_of(mesh));
  const MemoryImage image(bvh);
  const CoreRay ray{.ray = {glm::vec3(-1, 0, 0), glm::vec3(1, 0, 0)}};
  std::vector<CoreResult> results;
  make_rtl_core({.latency = 1})->trace(image.lines(), {&ray, 1}, results);
  EXPECT_EQ(results.back().tests, mesh.size());
}

/// Traces rays with `unit` in a memory of these lines. Returns the final results by tag.
std::map<std::uint32_t, CoreResult> ends_of(CoreUnit& unit, std::span<const MemoryLine> lines,
                                            const std::vector<CoreRay>& rays) {
  std::vector<CoreResult> results;
  unit.trace(lines, rays, results);
  std::map<std::uint32_t, CoreResult> ends;
  for (const CoreResult& result : results) {
    if (result.kind == CoreResult::Kind::kEnd) ends[result.tag] = result;
  }
  return ends;
}

std::vector<CoreRay> numbered(const std::vector<Ray>& rays) {
  std::vector<CoreRay> sent;
  for (const Ray& ray : rays)
    sent.push_back({.ray = ray, .tag = static_cast<std::uint32_t>(sent.size())});
  return sent;
}

/// A node is its own child: without the check, rays that enter the node would never end.
TEST_F(RayCoreTest, ANodeBelowItselfIsAnError) {
  NodeLine node(image_->lines()[MemoryImage::kRoot]);
  node.base = MemoryImage::kRoot;
  for (NodeLine::Child& child : node.child) child.kind = NodeLine::kAbsent;
  node.child[0] = {NodeLine::kInner, {0, 0, 0}, {255, 255, 255}};
  const std::vector<MemoryLine> lines(41, node.line());
  const std::vector<CoreRay> rays = numbered(some_rays(bodies(), random_, 300));
  ReferenceCore reference;
  CoreModel<Vray_core_small> small({.latency = 3});
  const auto expected = ends_of(reference, lines, rays);
  const std::unique_ptr<CoreUnit> large = make_rtl_core();
  for (CoreUnit* unit : {static_cast<CoreUnit*>(&small), large.get()}) {
    std::size_t cycles = 0;
    const std::uint64_t nodes = reference.counters().nodes;
    for (const auto& [tag, end] : ends_of(*unit, lines, rays)) {
      ASSERT_EQ(end.error, expected.at(tag).error) << tag;
      cycles += end.error == CoreResult::Error::kCycle;
    }
    EXPECT_GT(cycles, rays.size() / 2);
    EXPECT_EQ(unit->counters().nodes, nodes);
  }
}

/// Rays that need a line that memory lacks end with an error, all other rays with their hits. After
/// an error the line is read again, successfully if memory has it by then.
TEST_F(RayCoreTest, LinesThatMemoryLacksAreErrors) {
  const std::vector<CoreRay> rays = numbered(some_rays(bodies(), random_, 2'000));
  const std::span<const MemoryLine> lines = image_->lines();
  ReferenceCore reference;
  const auto whole = ends_of(reference, lines, rays);
  const std::unique_ptr<CoreUnit> unit = make_rtl_core();
  for (const std::size_t part : {2, 3, 4}) {
    const auto some = lines.first(lines.size() * part / 5);
    const auto expected = ends_of(reference, some, rays);
    std::size_t errors = 0, found = 0;
    for (const auto& [tag, end] : ends_of(*unit, some, rays)) {
      if (!expected.at(tag).found && expected.at(tag).error == CoreResult::Error::kNone) {
        ASSERT_EQ(end.error, CoreResult::Error::kNone) << tag;
      }
      if (end.error != CoreResult::Error::kNone) {
        ASSERT_EQ(end.error, CoreResult::Error::kMemory) << tag;
        ASSERT_GE(end.line, some.size());
        ASSERT_LT(end.line, lines.size());
        ++errors;
        continue;
      }
      ASSERT_EQ(end.found, whole.at(tag).found) << tag;
      found += end.found;
    }
    EXPECT_GT(errors, 100u);
    EXPECT_GT(found, 50u);
    for (const auto& [tag, end] : ends_of(*unit, lines, rays)) {
      ASSERT_EQ(end.error, CoreResult::Error::kNone) << tag;
    }
  }
}

TEST_F(RayCoreTest, DirectionsThatAreNotScaledAreErrors) {
  std::vector<CoreRay> rays = numbered(some_rays(bodies(), random_, 700));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (CoreRay& ray : rays) {
    glm::vec3& direction = ray.ray.direction;
    switch (ray.tag % 7) {
      case 1:
        direction *= 2.0f;
        break;
      case 2:
        direction *= 0.5f;
        break;
      case 3:
        direction = glm::vec3(0.0f);
        break;
      case 4:
        direction[static_cast<int>(ray.tag / 7 % 3)] = kInfinity;
        break;
      case 5:
        direction[static_cast<int>(ray.tag / 7 % 3)] = std::nanf("");
        break;
      default:
        break;
    }
  }
  ReferenceCore reference;
  const auto expected = ends_of(reference, image_->lines(), rays);
  const auto ends = ends_of(*make_rtl_core(), image_->lines(), rays);
  for (const CoreRay& ray : rays) {
    const bool scaled = ray.tag % 7 == 0 || ray.tag % 7 == 6;
    ASSERT_EQ(ends.at(ray.tag).error,
              scaled ? CoreResult::Error::kNone : CoreResult::Error::kDirection);
    ASSERT_EQ(ends.at(ray.tag).error, expected.at(ray.tag).error);
  }
}

TEST_F(RayCoreTest, AShortStackCostsNoHits) {
  const std::vector<Ray> rays = some_rays(bodies(), random_, 1'000);
  check(rays, {},
        std::make_unique<CoreModel<Vray_core_small>>(MemoryTiming{.latency = 3},
                                                     CoreStalls{.not_taken = 64}));
  EXPECT_GT(counters_.overflows, 100u);
  EXPECT_EQ(counters_.rays, rays.size());
}

/// Returns a chain of nodes with a triangle at the end. Each node also has an empty child.
std::vector<MemoryLine> chain(std::uint32_t nodes) {
  std::vector<MemoryLine> lines;
  for (std::uint32_t n = 0; n < nodes; ++n) {
    NodeLine node;
    node.origin = glm::vec3(-1.0f);
    node.exponent = {120, 120, 120};
    node.base = 2 * n + 1;
    const bool is_last = n + 1 == nodes;
    node.child[0] = {.kind = is_last ? 1 : NodeLine::kInner, .high = {255, 255, 255}};
    if (!is_last) node.child[1] = {.kind = NodeLine::kInner, .high = {255, 255, 255}};
    lines.push_back(node.line());
    if (n != 0) lines.push_back(NodeLine().line());
  }
  TriangleLine triangle;
  triangle.index = static_cast<std::uint32_t>(lines.size());
  triangle.corners = {glm::vec3(0, -1, -1), glm::vec3(0, 1, 0), glm::vec3(0, -1, 1)};
  lines.push_back(triangle.line());
  return lines;
}

/// Rays that all need the shared stack use the stack one after the other.
TEST_F(RayCoreTest, TreesAreAsDeepAsTheImagesOrAnError) {
  std::vector<CoreRay> rays;
  for (std::uint32_t n = 0; n < 100; ++n) {
    rays.push_back({.ray = {{-3.0f, 0.001f * static_cast<float>(n), 0.0f}, {1, 0, 0}}, .tag = n});
  }
  for (const int nodes : {MemoryImage::kMostDepth, MemoryImage::kMostDepth + 1}) {
    const std::vector<MemoryLine> lines = chain(static_cast<std::uint32_t>(nodes));
    ReferenceCore reference;
    const auto expected = ends_of(reference, lines, rays);
    CoreModel<Vray_core_small> small({.latency = 3});
    const std::unique_ptr<CoreUnit> large = make_rtl_core();
    for (CoreUnit* unit : {static_cast<CoreUnit*>(&small), large.get()}) {
      const auto ends = ends_of(*unit, lines, rays);
      for (const CoreRay& ray : rays) {
        const CoreResult& end = ends.at(ray.tag);
        ASSERT_EQ(end.error, nodes == MemoryImage::kMostDepth ? CoreResult::Error::kNone
                                                              : CoreResult::Error::kCycle);
        ASSERT_EQ(end.error, expected.at(ray.tag).error);
        ASSERT_EQ(end.found, nodes == MemoryImage::kMostDepth);
        if (end.found) {
          ASSERT_EQ(end.triangle, expected.at(ray.tag).triangle);
        }
      }
      EXPECT_EQ(unit->counters().overflows, rays.size());
    }
  }
}

/// Hits of thin triangles by grazing rays are reported as doubts if their error is too large. Each
/// ray meets one triangle, so that results do not depend on the order of tests.
TEST_P(EachRayCoreTest, HitsOfNeedlesAreTheReferences) {
  std::vector<Corners> needles;
  std::vector<Ray> rays;
  for (int n = 0; n < 1'200; ++n) {
    const glm::vec3 middle(16.0f * static_cast<float>(n), random_.uniform(), random_.uniform());
    const glm::vec3 along = random_.point(), across = random_.point();
    const int width = random_.below(17), grazing = random_.below(17 - width);
    const Corners& needle = needles.emplace_back(
        Corners{middle - along, middle + along, middle + std::ldexp(1.0f, -width) * across});
    const glm::vec3 origin =
        middle + 0.7f * across + std::ldexp(1.0f, -grazing) * glm::cross(along, across);
    glm::dvec3 way(0.0);
    for (const glm::dvec3& corner : needle) way += corner - glm::dvec3(origin);
    rays.push_back({origin, scaled_direction(way)});
  }
  const Bvh bvh(test::scene_of(needles));
  const MemoryImage image(bvh);
  using Words = std::tuple<std::uint32_t, CoreResult::Kind, std::uint32_t, float, std::uint32_t>;
  const auto words = [&](CoreUnit& unit) {
    std::vector<CoreResult> results;
    unit.trace(image.lines(), numbered(rays), results);
    std::vector<Words> words;
    for (const CoreResult& result : results) {
      const bool is_valid = result.found || result.kind == CoreResult::Kind::kDoubt;
      words.emplace_back(result.tag, result.kind, is_valid ? result.triangle : 0, result.t,
                         result.t_error);
    }
    std::ranges::sort(words);
    return words;
  };
  ReferenceCore reference;
  EXPECT_EQ(words(*core()), words(reference));
  EXPECT_GT(reference.counters().edge_doubts, 10u);
  EXPECT_GT(reference.counters().hits, 10u);
}

/// Counters for fixed rays equal recorded values. Many faults of arbitration, prefetch and caches
/// affect only these counters. After an intended change of the hardware, record the new values and
/// repeat `make bench ONLY=core PUBLISH=1`.
TEST_F(RayCoreTest, EventsAreTheRecorded) {
  std::vector<CoreRay> rays = test::fixed_rays(3'000);
  const auto events = [&](std::span<const MemoryLine> lines) {
    return test::events(*make_rtl_core({.latency = 50, .disorder = 40, .not_taken = 32}), lines,
                        rays);
  };
  EXPECT_EQ(events(test::FarLines(*image_).lines()),
            (std::vector<std::uint64_t>{26'485, 25'759, 14'554, 2'549, 0}));
  const Bvh larger{test::scene_of(test::sphere(4))};  // than the caches
  EXPECT_EQ(events(MemoryImage(larger).lines()),
            (std::vector<std::uint64_t>{27'680, 21'080, 7'145, 15'520, 0}));
  std::vector<Corners> row;  // of distances that grow by powers of two: a deep tree
  for (std::uint32_t n = 0; n < 600; ++n) {
    const float x = std::ldexp(1.0f + 0.02f * static_cast<float>(n % 15), static_cast<int>(n / 15));
    const glm::vec3 corner(x, test::fixed(n, 0.618034), test::fixed(n, 0.414214));
    row.push_back({corner, corner + glm::vec3(0, 0.2f, 0.1f), corner + glm::vec3(0, 0.1f, 0.2f)});
  }
  const Bvh deep{test::scene_of(row)};
  for (CoreRay& ray : rays) {
    ray.ray = {{-1.0, test::fixed(ray.tag, 0.618034), test::fixed(ray.tag, 0.414214)}, {1, 0, 0}};
    ray.t_max = std::numeric_limits<float>::infinity();
  }
  rays.resize(300);
  EXPECT_EQ(events(MemoryImage(deep).lines()),
            (std::vector<std::uint64_t>{157'896, 17'815, 7'267, 2'011, 0}));
  rays.resize(130);
  EXPECT_EQ(events(chain(12)), (std::vector<std::uint64_t>{35'364, 2'891, 130, 24, 0}));
}

}  // namespace
}  // namespace raygate
