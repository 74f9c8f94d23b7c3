// The reference model of the ray core finds the hits of CpuIntersector, bit for bit. Exact cores
// have no doubts. The box unit omits no box that a ray enters in rational arithmetic.
#include "host/intersect/core/core_intersector.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/base/input_error.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/core/test/box_cases.h"
#include "host/intersect/core/test/core_cases.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/intersector.h"
#include "host/intersect/unit/test/model_intersector.h"

namespace raygate {
namespace {

using test::bodies;
using test::Random;
using test::some_rays;

class CoreIntersectorTest : public testing::Test {
 protected:
  explicit CoreIntersectorTest(std::vector<Corners> mesh = bodies()) : mesh_(std::move(mesh)) {}

  /// Throws EngineMismatch if the core's hits differ from CpuIntersector's.
  void check(const std::vector<Ray>& rays, const RayQuery& query, int stack_depth,
             bool exact = false) {
    auto unit = std::make_unique<ReferenceCore>(stack_depth, exact);
    const ReferenceCore& core = *unit;
    auto tested = std::make_unique<CoreIntersector>(bvh_, image_, std::move(unit));
    const CoreIntersector& core_intersector = *tested;
    CheckIntersector intersector(bvh_, std::move(tested), std::make_unique<CpuIntersector>(bvh_));
    std::vector<NearestHit> hits(rays.size());
    test::find(intersector, rays, query, hits);
    for (const NearestHit& hit : hits) found_ += hit.primitive != NearestHit::kNone;
    counters_ = core.counters();
    const IntersectCounters host = core_intersector.counters();
    EXPECT_TRUE(!exact || host.exact_inside + host.exact_depth == 0u);
  }

  /// Returns the primitive index of a triangle of the mesh.
  [[nodiscard]] std::uint32_t primitive_of(std::size_t triangle) const {
    std::uint32_t primitive = 0;
    while (bvh_.triangle_of(primitive) != triangle) ++primitive;
    return primitive;
  }

  std::vector<Corners> mesh_;
  Bvh bvh_{test::scene_of(mesh_)};
  std::shared_ptr<const MemoryImage> image_ = std::make_shared<MemoryImage>(bvh_);
  Random random_;
  CoreCounters counters_;
  int found_ = 0;
};

TEST_F(CoreIntersectorTest, NearestHitsAreTheCpuIntersectors) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 20'000);
  check(rays, {}, 8);
  EXPECT_GT(found_, 19'000);
  EXPECT_GT(counters_.edge_doubts, 100u);
  EXPECT_GT(counters_.depth_doubts, 100u);
  EXPECT_EQ(counters_.overflows, 0u);
  EXPECT_LT(counters_.tests, rays.size() * mesh_.size() / 16) << "boxes cull";
}

TEST_F(CoreIntersectorTest, AShortStackCostsNoHits) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 5'000);
  check(rays, {}, 1);
  EXPECT_GT(counters_.overflows, 1'000u);
  EXPECT_EQ(counters_.rays, rays.size());
}

TEST_F(CoreIntersectorTest, LimitsIgnoredTrianglesAndFirstHitsCount) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 10'000);
  std::vector<float> limits, enough;
  std::vector<std::uint32_t> ignored;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    limits.push_back(random_.below(4) == 0 ? std::numeric_limits<float>::infinity()
                                           : random_.uniform(0.01f, 3.0f));
    enough.push_back(random_.below(2) == 0 ? limits.back() : 0.5f * limits.back());
    ignored.push_back(static_cast<std::uint32_t>(random_.below(static_cast<int>(mesh_.size()))));
  }
  check(rays, {.t_max = limits}, 8);
  EXPECT_GT(found_, 1'000);
  check(rays, {.t_max = limits, .skip_ids = ignored}, 8);
  const std::uint64_t nodes = counters_.nodes;
  check(rays, {.t_max = limits, .skip_ids = ignored, .any_hit_before = enough}, 8);
  EXPECT_LT(counters_.nodes, nodes);
}

// float32 cannot tell on which side of a plane a very near origin is, so each ray has a doubt.
TEST_F(CoreIntersectorTest, TheTriangleThatARayLeavesIsNoDoubt) {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> sources;
  const auto count = static_cast<int>(test::sphere(2).size());  // the first of the mesh
  for (int i = 0; i < 10'000; ++i) {
    const auto triangle = static_cast<std::size_t>(random_.below(count));
    const Corners& t = mesh_[triangle];
    Ray& ray = rays.emplace_back(Ray{glm::vec3((t[0] + t[1] + t[2]) / 3.0),
                                     scaled_direction(glm::dvec3(random_.point(1.0f)))});
    if (is_ahead(ray, t)) ray.direction = -ray.direction;
    sources.push_back(primitive_of(triangle));
  }
  check(rays, {}, 8);
  EXPECT_GT(counters_.edge_doubts, 9'000u);
  check(rays, {.source_ids = sources}, 8);
  EXPECT_LT(counters_.edge_doubts, 100u);
}

TEST_F(CoreIntersectorTest, TheWorkOfEachRayIsCounted) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 50);
  std::vector<RayWork> work(rays.size());
  check(rays, {.work = work}, 8);
  std::uint64_t tests = 0;
  for (const RayWork& ray : work) tests += ray.tests;
  EXPECT_GT(tests, 0u);
  EXPECT_EQ(tests, counters_.tests);
}

/// Tests with a mesh in which every hit is a tie.
class ExactCoreTest : public CoreIntersectorTest {
 protected:
  ExactCoreTest() : CoreIntersectorTest(doubled()) {}

  /// Returns the bodies, then all of their triangles again with the corners in another order.
  static std::vector<Corners> doubled() {
    std::vector<Corners> mesh = test::bodies();
    const std::size_t count = mesh.size();
    for (std::size_t i = 0; i < count; ++i) mesh.push_back({mesh[i][1], mesh[i][2], mesh[i][0]});
    return mesh;
  }
};

TEST_F(ExactCoreTest, NearestHitsAreTheCpuIntersectors) {
  check(some_rays(mesh_, random_, 10'000), {}, 8, true);
  EXPECT_GT(found_, 9'500);
  EXPECT_GT(counters_.edge_doubts, 1'000u);
  EXPECT_GT(counters_.depth_doubts, 5'000u);
}

TEST_F(ExactCoreTest, LimitsSkippedTrianglesFirstHitsAndSourcesCount) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 5'000);
  std::vector<NearestHit> nearest(rays.size());
  CpuIntersector(bvh_).nearest(rays, {}, nearest);
  std::vector<float> limits;
  std::vector<std::uint32_t> skipped;
  for (const NearestHit& hit : nearest) {
    // Most limits are at the hit or within a few floats on either side.
    float limit = 1.0f;
    if (hit.primitive != NearestHit::kNone) {
      limit =
          static_cast<float>(hit_distance(rays[limits.size()], bvh_.corners_of(hit.primitive)).low);
    }
    for (int n = random_.below(3); n > 0; --n) limit = std::nextafter(limit, 0.0f);
    for (int n = random_.below(3); n > 0; --n) limit = std::nextafter(limit, 2.0f * limit);
    limits.push_back(random_.below(8) == 0 ? std::numeric_limits<float>::infinity() : limit);
    skipped.push_back(
        hit.primitive != NearestHit::kNone && random_.below(2) == 0
            ? hit.primitive
            : static_cast<std::uint32_t>(random_.below(static_cast<int>(mesh_.size()))));
  }
  check(rays, {.t_max = limits}, 8, true);
  EXPECT_GT(found_, 1'000);
  EXPECT_LT(found_, 4'500);
  check(rays, {.t_max = limits, .skip_ids = skipped}, 8, true);
  check(rays, {.t_max = limits, .skip_ids = skipped, .any_hit_before = limits}, 8, true);
  std::vector<std::uint32_t> sources;
  for (const Ray& ray : rays) {
    const auto primitive =
        static_cast<std::uint32_t>(random_.below(static_cast<int>(mesh_.size())));
    const bool is_hit = hits_triangle(ray, bvh_.corners_of(primitive));
    sources.push_back(is_hit ? NearestHit::kNone : primitive);
  }
  check(rays, {.t_max = limits, .source_ids = sources}, 8, true);
}

/// t is fewer than 2^t_error floats from the exact t, also for exact hits; kNoT: t is unknown.
TEST_F(ExactCoreTest, DistancesHoldTheirBounds) {
  const std::vector<Ray> rays = some_rays(mesh_, random_, 5'000);
  ReferenceCore core(ReferenceCore::kStackDepth, true);
  int without = 0, with = 0;
  for (const Ray& ray : rays) {
    const CoreRay sent{.ray = ray};
    std::vector<CoreResult> results;
    core.trace(image_->lines(), {&sent, 1}, results);
    ASSERT_EQ(results.size(), 1u) << "one word a ray";
    const CoreResult& end = results[0];
    if (!end.found) continue;
    if (end.t_error == CoreResult::kNoT) {
      EXPECT_EQ(end.t, 0.0f);
      EXPECT_EQ(end.point, glm::vec3(0.0f));
      ++without;
      continue;
    }
    const auto word = std::bit_cast<std::int32_t>(end.t), error = std::int32_t{1} << end.t_error;
    const Interval t = hit_distance(ray, bvh_.corners_of(image_->primitive_at(end.triangle)));
    EXPECT_GT(t.high, std::bit_cast<float>(std::max(word - error, 0)));
    EXPECT_LT(t.low, std::bit_cast<float>(std::min(word + error, 0x7F800000)));
    ++with;
  }
  EXPECT_GT(without, 50);
  EXPECT_GT(with, 3'000);
}

/// A core whose memory lacks its last line; if `cyclic`, the root is also below itself.
class BrokenMemory : public ReferenceCore {
 public:
  explicit BrokenMemory(bool cyclic) : cyclic_(cyclic) {}

  void trace(std::span<const MemoryLine> lines, std::span<const CoreRay> rays,
             std::vector<CoreResult>& results) override {
    std::vector<MemoryLine> broken(lines.begin(), lines.end() - 1);
    if (cyclic_) {
      NodeLine root(lines[MemoryImage::kRoot]);
      root.base = MemoryImage::kRoot;
      root.child[0].kind = NodeLine::kInner;
      broken.front() = root.line();
    }
    ReferenceCore::trace(broken, rays, results);
  }

 private:
  bool cyclic_;
};

TEST_F(CoreIntersectorTest, ErrorsOfTheCoreAreInputErrors) {
  std::vector<Ray> rays = some_rays(mesh_, random_, 100);
  // A ray that starts close to the triangle of the last line.
  const Corners t = widened(TriangleLine(image_->lines().back()).corners);
  const glm::dvec3 normal = glm::normalize(triangle_normal(t));
  rays.push_back(
      {glm::vec3((t[0] + t[1] + t[2]) / 3.0 + 1e-3 * normal), scaled_direction(-normal)});
  std::vector<NearestHit> hits(rays.size());
  const auto said = [&](bool cyclic) {
    CoreIntersector intersector(bvh_, image_, std::make_unique<BrokenMemory>(cyclic));
    try {
      intersector.nearest(rays, {}, hits);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(said(false),
            "ray core's memory: no line " + std::to_string(image_->lines().size() - 1));
  EXPECT_EQ(said(true), "ray core's memory: a node is below itself, or below more than 47 others");
}

TEST(MemoryImage, OfNothingIsANodeWithoutChildren) {
  const Bvh bvh(Scene{});
  const auto image = std::make_shared<const MemoryImage>(bvh);
  ASSERT_EQ(image->lines().size(), 1u);
  CoreIntersector intersector(bvh, image, std::make_unique<ReferenceCore>());
  const Ray ray{glm::vec3(0), glm::vec3(1, 0, 0)};
  NearestHit hit;
  intersector.nearest({&ray, 1}, {}, {&hit, 1});
  EXPECT_EQ(hit.primitive, NearestHit::kNone);
}

TEST(MemoryImage, LinesHoldWhatTheyAreMadeOf) {
  NodeLine node;
  node.origin = {1.0f, -2.0f, 3.0f};
  node.exponent = {1, 254, 127};
  node.base = 0x8000001;
  for (std::uint32_t i = 0; i < NodeLine::kChildren; ++i) {
    node.child[i] = {
        i + 2, {static_cast<std::uint8_t>(i), 1, 255}, {static_cast<std::uint8_t>(i + 9), 2, 255}};
  }
  EXPECT_EQ(NodeLine(node.line()).line().words, node.line().words);
  EXPECT_EQ(NodeLine(node.line()).child[6].high[0], 15);
  EXPECT_EQ(NodeLine(node.line()).base, 0x8000001u);
}

/// A core that returns the same result for all rays.
class WildCore : public CoreUnit {
 public:
  explicit WildCore(const CoreResult& word) : word_(word) {}
  void trace(std::span<const MemoryLine>, std::span<const CoreRay>,
             std::vector<CoreResult>& results) override {
    results.push_back(word_);
  }
  [[nodiscard]] CoreCounters counters() const override { return {}; }

 private:
  CoreResult word_;
};

TEST_F(CoreIntersectorTest, RefusesWordsAboutWhatItDidNotGive) {
  using Kind = CoreResult::Kind;
  const std::vector<Ray> rays = some_rays(mesh_, random_, 1);
  const auto take = [&](const CoreResult& word) {
    CoreIntersector intersector(bvh_, image_, std::make_unique<WildCore>(word));
    std::vector<NearestHit> hits(1);
    intersector.nearest(rays, {}, hits);
  };
  EXPECT_NO_THROW(take({.kind = Kind::kEnd, .tag = 0}));
  EXPECT_THROW(take({.kind = Kind::kEnd, .tag = 1}), std::runtime_error);
  for (const std::uint32_t triangle :
       {MemoryImage::kRoot, static_cast<std::uint32_t>(image_->lines().size()), ~0u}) {
    EXPECT_THROW(take({.kind = Kind::kDoubt, .triangle = triangle}), std::runtime_error);
    EXPECT_THROW(take({.kind = Kind::kEnd, .found = true, .triangle = triangle}),
                 std::runtime_error);
  }
}

/// Returns whether the ray, for 0 <= t <= limit, meets the child's box; `first` is the smallest t.
bool enters(const BoxCase& box, const NodeLine::Child& child, mpq_class& first) {
  mpq_class low = 0, high = -1;  // -1: no limit
  if (std::isfinite(box.limit)) high = mpq_class(box.limit);
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const mpq_class cell(std::ldexp(1.0, box.node.exponent[at] - 127));
    const mpq_class origin(box.ray.origin[k]), direction(box.ray.direction[k]);
    mpq_class near = mpq_class(box.node.origin[k]) + child.low[at] * cell - origin;
    mpq_class far = mpq_class(box.node.origin[k]) + child.high[at] * cell - origin;
    if (direction == 0) {
      if (near > 0 || far < 0) return false;
      continue;
    }
    near /= direction;
    far /= direction;
    if (near > far) std::swap(near, far);
    if (near > low) low = near;
    if (high < 0 || far < high) {
      if (far < 0) return false;
      high = far;
    }
  }
  first = low;
  return low <= high;
}

TEST(ReferenceBoxUnit, LeavesOutNoBoxThatARayEnters) {
  const std::uint32_t seed = 20261122;
  BoxCases cases(seed);
  std::uint64_t entered = 0, given = 0, boxes = 0, most = 0;
  for (int i = 0; i < 100'000; ++i) {
    const BoxCase box = cases.next();
    const BoxGroup group = enter_boxes(box.node, box.read());
    std::uint32_t offset = 0;
    for (const NodeLine::Child& child : box.node.child) {
      const std::uint32_t here = offset;
      offset += child.size();
      if (child.kind == NodeLine::kAbsent) continue;
      ++boxes;
      const auto* const end = group.entry.begin() + group.size;
      const auto* const entry = std::find_if(
          group.entry.begin(), end, [&](const BoxGroup::Entry& e) { return e.offset == here; });
      given += entry != end;
      mpq_class first;
      if (!enters(box, child, first)) continue;
      ++entered;
      ASSERT_NE(entry, end) << "seed " << seed << ", case " << i << ", child at " << here;
      mpq_class enter(entry->enter);
      const int unit = static_cast<int>(group.exponent) - 127 - 12;
      if (unit >= 0)
        mpq_mul_2exp(enter.get_mpq_t(), enter.get_mpq_t(), static_cast<unsigned long>(unit));
      if (unit < 0)
        mpq_div_2exp(enter.get_mpq_t(), enter.get_mpq_t(), static_cast<unsigned long>(-unit));
      ASSERT_LE(enter, first) << "seed " << seed << ", case " << i << ", child at " << here;
      EXPECT_FALSE(is_beyond(group, *entry, box.limit));
    }
    most = std::max<std::uint64_t>(most, static_cast<std::uint64_t>(group.size));
    for (int n = 1; n < group.size; ++n) {
      ASSERT_LE(group.entry[static_cast<std::size_t>(n - 1)].enter,
                group.entry[static_cast<std::size_t>(n)].enter);
    }
  }
  EXPECT_EQ(most, 7u);
  EXPECT_GT(entered, boxes / 16);
  EXPECT_LT(given, entered + boxes / 16);  // few false hits
}

}  // namespace
}  // namespace raygate
