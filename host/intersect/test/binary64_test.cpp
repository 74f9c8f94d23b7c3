// Compares all searches, for scenes and rays in binary64, with the exact predicates, which
// exact_test compares with rationals.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <tuple>

#include "host/exact/test/meshes.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/intersect/unit/test/model_intersector.h"

namespace raygate {
namespace {

using test::Random;

/// Returns a coordinate that binary32 rounds to `x`.
double near(float x, Random& random) {
  const double exact = x == 0.0f ? 0.0 : with_rest(x, random.below(1 << 30) - (1 << 29));
  return static_cast<float>(exact) == x ? exact : double{x};
}

/// Moves the corners of a mesh by less than binary32 resolves. Equal corners stay equal.
std::vector<Corners> in_binary64(std::vector<Corners> mesh, Random& random) {
  std::map<std::tuple<double, double, double>, glm::dvec3> moved;
  for (Corners& triangle : mesh) {
    for (glm::dvec3& corner : triangle) {
      const auto [at, is_new] = moved.try_emplace({corner.x, corner.y, corner.z}, corner);
      for (int k = 0; k < 3 && is_new; ++k) {
        at->second[k] = near(static_cast<float>(corner[k]), random);
      }
      corner = at->second;
    }
  }
  return mesh;
}

/// Rays, and the same rays rounded to binary32.
struct Rays {
  std::vector<ExactRay> exact;
  std::vector<Ray> rounded;

  void add(const glm::dvec3& origin, glm::dvec3 direction, bool is_binary64) {
    const glm::vec3 scaled = scaled_direction(direction);
    direction *= std::exp2(std::round(std::log2(largest(scaled) / largest(direction))));
    rounded.push_back({glm::vec3(origin), scaled});
    exact.push_back(is_binary64 ? ExactRay(origin, direction) : ExactRay(rounded.back()));
  }
};

class Binary64 : public testing::Test {
 protected:
  /// Returns rays aimed at corners, edges and insides. Half start nearby, some of them at a corner.
  Rays some_rays(const std::vector<Corners>& mesh, int count, bool is_binary64, bool is_common) {
    Rays rays;
    const float size = 2.0f * static_cast<float>(largest(mesh[0][0]));
    const glm::vec3 corner(mesh[0][0]);
    const float extent = 4.0f * largest(glm::vec3(mesh[0][1]) - corner);
    glm::dvec3 origin(random_.below(2) == 0 ? random_.point(size) : corner + random_.point(extent));
    while (static_cast<int>(rays.exact.size()) < count) {
      const auto any = [&] {
        return mesh[static_cast<std::size_t>(random_.below(static_cast<int>(mesh.size())))];
      };
      const Corners t = any();
      const double u = random_.below(3) == 0 ? 0.0 : random_.uniform(0, 1);
      const double v = random_.below(3) == 0 ? 0.0 : random_.uniform(0, 1);
      const glm::dvec3 aim = glm::mix(glm::mix(t[0], t[1], u), t[2], v);
      if (!is_common) {
        const glm::vec3 start =
            random_.below(2) == 0 ? random_.point(size) : corner + random_.point(extent);
        for (int k = 0; k < 3; ++k) origin[k] = near(start[k], random_);
        if (random_.below(8) == 0) origin = any()[0];
      }
      if (aim != origin) rays.add(origin, aim - origin, is_binary64);
    }
    return rays;
  }

  /// Returns the nearest hit's triangle, or -1, and the number of hits, by the predicates alone.
  static std::pair<int, std::size_t> expected(const std::vector<Corners>& mesh,
                                              const ExactRay& ray) {
    int nearest = -1;
    std::size_t count = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (!hits_triangle(ray, mesh[i])) continue;
      ++count;
      if (nearest < 0 || compare_hits(ray, mesh[i], mesh[static_cast<std::size_t>(nearest)]) < 0) {
        nearest = static_cast<int>(i);
      }
    }
    return {nearest, count};
  }

  void expect_right(const std::vector<Corners>& mesh, bool is_binary64, bool is_common) {
    const Scene scene = test::scene_of(mesh);
    const Bvh bvh(scene);
    for (std::uint32_t i = 0; i < mesh.size(); ++i) {
      ASSERT_EQ(bvh.corners_of(i), mesh[bvh.triangle_of(i)]);
    }
    const Rays rays = some_rays(mesh, 200, is_binary64, is_common);
    std::vector<NearestHit> nearest(rays.rounded.size()), any(nearest), of_unit(nearest), all;
    const std::vector<float> limits(nearest.size(), std::numeric_limits<float>::infinity());
    RayQuery query{.common_origin = is_common};
    if (is_binary64) query.exact_rays = rays.exact;
    CpuIntersector cpu(bvh);
    cpu.nearest(rays.rounded, query, nearest);
    query.any_hit_before = limits;
    query.with_points = false;
    cpu.nearest(rays.rounded, query, any);
    if (!is_binary64) {
      test::model_intersector(bvh)->nearest(rays.rounded, {.common_origin = is_common}, of_unit);
    }
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const auto number = [&](const NearestHit& hit) {
        return hit.primitive == NearestHit::kNone
                   ? -1
                   : static_cast<int>(bvh.triangle_of(hit.primitive));
      };
      const auto [triangle, count] = expected(mesh, rays.exact[i]);
      ASSERT_EQ(number(nearest[i]), triangle) << "ray " << i;
      ASSERT_EQ(number(any[i]) >= 0, triangle >= 0) << "ray " << i;
      if (!is_binary64) {
        ASSERT_EQ(number(of_unit[i]), triangle) << "ray " << i;
      }
      RayWork work;
      all_hits(bvh, rays.exact[i], limits[i], all, work);
      ASSERT_EQ(all.size(), count) << "ray " << i;
      hits_ += triangle >= 0;
      if (triangle < 0) continue;
      ASSERT_EQ(number(all[0]), triangle);
      const Interval t = hit_distance(rays.exact[i], mesh[static_cast<std::size_t>(triangle)]);
      ASSERT_LE(nearest[i].t.low, t.high);
      ASSERT_GE(nearest[i].t.high, t.low);
    }
  }

  Random random_;
  int hits_ = 0;
};

TEST_F(Binary64, AllSearchesFindWhatThePredicatesSay) {
  for (int round = 0; round < 120; ++round) {
    const float size = std::ldexp(1.0f, random_.below(40) - 20);
    const glm::vec3 far = (round % 3 == 0 ? 1000.0f : 0.0f) * random_.point(size);
    std::vector<Corners> mesh = test::sphere(1, size, far);
    const int more = random_.below(40);
    for (int i = 0; i < more; ++i) {  // random triangles at a corner of the sphere
      mesh.push_back({far + random_.point(size), far + random_.point(size), mesh[0][0]});
    }
    mesh = in_binary64(std::move(mesh), random_);
    for (const bool is_common : {false, true}) expect_right(mesh, false, is_common);
    expect_right(mesh, true, false);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(hits_, 20'000);
}

// In queries with exact rays and in all_hits(), rays in binary32 have no more doubts than alone.
TEST_F(Binary64, RaysInBinary32HaveTheNarrowBounds) {
  int doubts = 0;
  for (int round = 0; round < 300; ++round) {
    const std::vector<Corners> mesh = {
        {glm::vec3(random_.point()), glm::vec3(random_.point()), glm::vec3(random_.point())}};
    const Bvh bvh(test::scene_of(mesh));
    Rays rays;
    for (int i = 0; i < 30; ++i) {
      const glm::vec3 origin = random_.point(1e4f);
      const glm::dvec3 aim = glm::mix(mesh[0][0], mesh[0][1], double{random_.uniform(0, 1)}) +
                             std::ldexp(1.0, -random_.below(14)) * glm::dvec3(random_.point());
      rays.add(origin, aim - glm::dvec3(origin), false);
    }
    rays.add({0.1, 0, 0}, {1, 0, 0}, true);
    std::vector<NearestHit> hits(rays.rounded.size()), every;
    std::vector<RayWork> alone(hits.size()), together(alone);
    CpuIntersector(bvh).nearest(rays.rounded, {.work = alone}, hits);
    CpuIntersector(bvh).nearest(rays.rounded, {.exact_rays = rays.exact, .work = together}, hits);
    for (std::size_t i = 0; i + 1 < hits.size(); ++i) {
      RayWork all;
      all_hits(bvh, rays.exact[i], std::numeric_limits<float>::infinity(), every, all);
      ASSERT_EQ(together[i].tests, alone[i].tests);
      ASSERT_EQ(together[i].doubts, alone[i].doubts);
      // all_hits() may test other boxes.
      if (all.tests == alone[i].tests) {
        ASSERT_EQ(all.doubts, alone[i].doubts);
      }
      doubts += static_cast<int>(alone[i].doubts);
    }
  }
  EXPECT_GT(doubts, 100);
}

// Rounding moves an origin above 1 by more than boxes below 1 are widened.
TEST_F(Binary64, SmallTrianglesAreHit) {
  int hits = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto near_one = [&](double distance) {
      return 1.0 + distance * glm::abs(glm::dvec3(random_.point()));
    };
    const glm::dvec3 at = near_one(-0x1p-20);
    const auto corner = [&] { return at + glm::dvec3(random_.point(0x1p-30f)); };
    const std::vector<Corners> mesh = {{corner(), corner(), corner()}};
    const Scene scene = test::scene_of(mesh);
    const Bvh bvh(scene);
    Rays rays;
    for (int i = 0; i < 10; ++i) {
      const glm::dvec3 origin = near_one(0x1p-18);
      rays.add(origin, (mesh[0][0] + mesh[0][1] + mesh[0][2]) / 3.0 - origin, true);
    }
    std::vector<NearestHit> nearest(rays.rounded.size()), all;
    CpuIntersector(bvh).nearest(rays.rounded, {.exact_rays = rays.exact}, nearest);
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const bool is_hit = hits_triangle(rays.exact[i], mesh[0]);
      hits += is_hit ? 1 : 0;
      RayWork work;
      all_hits(bvh, rays.exact[i], std::numeric_limits<float>::infinity(), all, work);
      ASSERT_EQ(nearest[i].primitive != NearestHit::kNone, is_hit);
      ASSERT_EQ(!all.empty(), is_hit);
    }
  }
  EXPECT_GT(hits, 10'000);
}

// Rays through the corner that all triangles share hit exactly one triangle.
TEST_F(Binary64, AFanIsHitOnce) {
  const glm::dvec3 apex(1 + 0x1p-40, 1 - 0x1p-41, 0x1p-42);
  constexpr int kCount = 1000;
  std::vector<Corners> mesh;
  const auto rim = [&](int i) {
    const double angle = 6.283185307179586 * (i % kCount) / kCount;
    return apex + glm::dvec3(std::cos(angle), std::sin(angle), 0.01 * (i % kCount % 3));
  };
  for (int i = 0; i < kCount; ++i) mesh.push_back({rim(i), rim(i + 1), apex});
  const Scene scene = test::scene_of(mesh);
  const Bvh bvh(scene);
  Rays rays;
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 way = glm::round(0x1p10 * glm::dvec3(random_.point(0.05f))) * 0x1p-10;
    rays.add(apex - way - glm::dvec3(0, 0, 1), way + glm::dvec3(0, 0, 1), true);
  }
  std::vector<NearestHit> hits(rays.rounded.size()), all;
  CpuIntersector(bvh).nearest(rays.rounded, {.exact_rays = rays.exact}, hits);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    RayWork work;
    all_hits(bvh, rays.exact[i], std::numeric_limits<float>::infinity(), all, work);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].primitive, hits[i].primitive);
  }
}

// In half of the cases, rounding to binary32 would move the triangle's edge across the ray.
TEST_F(Binary64, TellsCornersApartThatBinary32DoesNot) {
  const double step = 0x1p-40;
  const auto wall = [](double x) {
    return Corners{glm::dvec3(x, -1, 2), glm::dvec3(x + 1, -1, 2), glm::dvec3(x, 1, 2)};
  };
  for (int i = -20; i < 20; ++i) {
    const std::vector<Corners> mesh = {wall(1.0 + i * step)};
    const Scene scene = test::scene_of(mesh);
    const Bvh bvh(scene);
    for (int k = -20; k < 20; ++k) {
      Rays rays;
      rays.add({1.0 + k * step, 0, 0}, {0, 0, 1}, true);
      NearestHit hit;
      CpuIntersector(bvh).nearest(rays.rounded, {.exact_rays = rays.exact}, {&hit, 1});
      ASSERT_EQ(hit.primitive != NearestHit::kNone, k >= i) << i << ' ' << k;
    }
  }
}

}  // namespace
}  // namespace raygate
