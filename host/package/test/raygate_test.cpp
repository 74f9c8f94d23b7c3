// Compares results of the installed header's interface with rationals.
#include "host/package/raygate.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "host/exact/test/rational_oracle.h"

namespace raygate {
namespace {

using Point = Tracer::Point;

/// Returns a cube of 12 triangles, with corners at 1 and -1 on each axis.
std::vector<Tracer::Triangle> cube() {
  std::vector<Tracer::Triangle> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const auto corner = [&](float a, float b) {
        Point p{};
        p[axis] = side;
        p[(axis + 1) % 3] = a;
        p[(axis + 2) % 3] = b;
        return p;
      };
      triangles.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
      triangles.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
  }
  return triangles;
}

glm::vec3 vector(const Point& p) { return {p[0], p[1], p[2]}; }

test::RationalOracle oracle(const Tracer::Ray& ray, const Tracer::Triangle& t) {
  return {Ray{vector(ray.origin), vector(ray.direction)},
          Corners{vector(t[0]), vector(t[1]), vector(t[2])}};
}

TEST(Tracer, SaysWhatRationalsSay) {
  const std::vector<Tracer::Triangle> triangles = cube();
  const Tracer tracer(triangles, 2);
  std::mt19937_64 random(1);
  const auto whole = [&](int from, int to) {
    return static_cast<float>(std::uniform_int_distribution<int>(from, to)(random));
  };
  std::vector<Tracer::Ray> rays;
  for (int i = 0; i < 3000; ++i) {  // on a coarse grid: through edges, corners, along faces
    Tracer::Ray ray{{whole(-4, 4) / 2, whole(-4, 4) / 2, whole(-4, 4) / 2},
                    {whole(-2, 2), whole(-2, 2), whole(-2, 2)}};
    if (i % 3 == 0) ray.limit = whole(1, 8) / 4;
    rays.push_back(ray);
  }
  std::vector<Tracer::Hit> nearest(rays.size());
  std::vector<std::uint8_t> any(rays.size());
  tracer.nearest(rays, nearest);
  tracer.any(rays, any);
  std::size_t hit_rays = 0, limited = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    std::vector<std::pair<mpq_class, std::uint32_t>> expected;
    for (std::uint32_t k = 0; k < triangles.size() && rays[i].direction != Point{}; ++k) {
      const test::RationalOracle truth = oracle(rays[i], triangles[k]);
      if (!truth.hit()) continue;
      const bool near = std::isinf(rays[i].limit) || truth.t() < mpq_class(rays[i].limit);
      if (near) expected.emplace_back(truth.t(), k);
      limited += !near;
    }
    std::ranges::sort(expected);
    const std::vector<Tracer::Hit> all = tracer.all(rays[i]);
    ASSERT_EQ(all.size(), expected.size()) << "ray " << i;
    EXPECT_EQ(any[i], expected.empty() ? 0 : 1);
    EXPECT_EQ(nearest[i].triangle, expected.empty() ? Tracer::kNone : expected[0].second);
    hit_rays += !expected.empty();
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_EQ(all[k].triangle, expected[k].second) << "ray " << i;
      EXPECT_LE(abs(mpq_class(all[k].t) - expected[k].first) * (1L << 33), expected[k].first);
      EXPECT_GE(1.0 - all[k].u - all[k].v, 0.0);
      for (int axis = 0; axis < 3; ++axis) {
        const Tracer::Triangle& t = triangles[all[k].triangle];
        const double p = (1.0 - all[k].u - all[k].v) * t[0][axis] + all[k].u * t[1][axis] +
                         all[k].v * t[2][axis];
        EXPECT_NEAR(p, rays[i].origin[axis] + all[k].t * rays[i].direction[axis], 1e-9);
      }
    }
  }
  EXPECT_GT(hit_rays, 500u);
  EXPECT_GT(limited, 50u);
}

/// Returns all results of a Tracer, built on two threads, for triangles and rays.
std::vector<double> answers(std::span<const Tracer::Triangle> triangles,
                            std::span<const Tracer::Ray> rays) {
  const Tracer tracer(triangles, 2);
  std::vector<Tracer::Hit> hits(rays.size());
  std::vector<std::uint8_t> is_hit(rays.size());
  tracer.nearest(rays, hits);
  tracer.any(rays, is_hit);
  for (const Tracer::Ray& ray : rays) {
    const std::vector<Tracer::Hit> all = tracer.all(ray);
    hits.insert(hits.end(), all.begin(), all.end());
  }
  std::vector<double> said(is_hit.begin(), is_hit.end());
  for (const Tracer::Hit& hit : hits) {
    said.insert(said.end(), {static_cast<double>(hit.triangle), hit.t, hit.u, hit.v});
  }
  return said;
}

// Other libraries may change a thread's floating-point state. Tracer's results do not depend on
// this state, and queries restore it.
TEST(Tracer, AnswersInAnyStateOfTheThread) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> any(-1.0f, 1.0f);
  for (const float size : {1.0f, 1e-40f}) {  // coordinates of size 1e-40 are subnormal
    const auto point = [&](float scale) {
      return Point{scale * any(random), scale * any(random), scale * any(random)};
    };
    std::vector<Tracer::Triangle> triangles(6000);  // enough for two threads to build the tree
    for (Tracer::Triangle& t : triangles) {
      const Point a = point(size);
      t = {a, point(size), point(size)};
      for (int k = 0; k < 3; ++k) {
        t[1][k] = a[k] + 0.1f * t[1][k];
        t[2][k] = a[k] + 0.1f * t[2][k];
      }
    }
    std::vector<Tracer::Ray> rays(2000);
    for (Tracer::Ray& ray : rays) ray = {point(size), point(1.0f)};
    const std::vector<double> expected = answers(triangles, rays);
    ASSERT_GT(std::accumulate(expected.begin(), expected.begin() + 2000, 0.0), 500.0);
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      std::fesetround(mode);
      const bool same = answers(triangles, rays) == expected;
      EXPECT_EQ(std::fegetround(), mode);
      std::fesetround(FE_TONEAREST);
      EXPECT_TRUE(same) << "rounding mode " << mode << ", size " << size;
    }
#if defined(__SSE2__)
    const unsigned before = _mm_getcsr();
    for (const unsigned flags : {0x8000u /* FTZ */, 0x0040u /* DAZ */}) {
      _mm_setcsr(before | flags);
      const bool same = answers(triangles, rays) == expected;
      EXPECT_EQ(_mm_getcsr(), before | flags);
      _mm_setcsr(before);
      EXPECT_TRUE(same) << "flags " << flags << ", size " << size;
    }
    _mm_setcsr(before & ~0x1F80u & ~0x3Fu);  // every exception traps
    const bool same = answers(triangles, rays) == expected;
    _mm_setcsr(before);
    EXPECT_TRUE(same) << "with traps, size " << size;
#endif
  }
}

// Rays through an edge at height 2^-126 of the triangle, and rays an ulp above and below.
TEST(Tracer, RoundsWhatUnderflowsAndNothingElse) {
  const float edge = 0x1p-126f;
  const Tracer::Triangle triangle = {{{1, edge, -1}, {1, 1, 0}, {1, edge, 1}}};
  const Tracer tracer({&triangle, 1});
  for (const int exponent : {-20, 0, 27, 100}) {
    const auto triangle_at = [&](float height, float limit = INFINITY) {
      const Tracer::Ray ray{{0, 0, 0}, {std::ldexp(1.0f, exponent), height, 0}, limit};
      Tracer::Hit hit;
      tracer.nearest({&ray, 1}, {&hit, 1});
      return hit.triangle;
    };
    const auto truth = [&](float height) {
      const Tracer::Ray ray{{0, 0, 0}, {std::ldexp(1.0f, exponent), height, 0}};
      return oracle(ray, triangle).hit() ? 0 : Tracer::kNone;
    };
    const float along = std::ldexp(edge, exponent);
    const float above = std::nextafter(along, 1.0f);
    EXPECT_NE(truth(above), truth(0.0f));
    EXPECT_EQ(triangle_at(above), truth(above)) << exponent;
    EXPECT_EQ(triangle_at(along), truth(along)) << exponent;
    // If exponent > 0, `below` is 2^-126 - 2^-150 after scaling: a tie, which is rounded up.
    const float below = std::nextafter(along, 0.0f);
    EXPECT_EQ(triangle_at(below), truth(exponent > 0 ? along : below)) << exponent;
    const float end = std::ldexp(1.0f, -exponent);  // t of the hit
    EXPECT_EQ(triangle_at(above, end), Tracer::kNone);
    EXPECT_EQ(triangle_at(above, std::nextafter(end, INFINITY)), 0u);
  }
}

TEST(Tracer, SaysWhatItCannotUse) {
  const auto refusal = [](const auto& what) -> std::string {
    try {
      what();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing refused";
  };
  std::vector<Tracer::Triangle> triangles = cube();
  const Tracer tracer(triangles);
  EXPECT_EQ(refusal([&] {
              (void)tracer.all({{0, 0, 0}, {NAN, 0, 0}});
            }),
            "ray 0: found inf or nan in origin or direction, expected finite numbers");
  EXPECT_EQ(refusal([&] {
              (void)tracer.all({{0, 0, 0}, {1, 0, 0}, 0.0f});
            }),
            "ray 0: found a limit that is not above 0, expected one, or inf");
  const Tracer::Ray ray;
  EXPECT_EQ(refusal([&] {
              tracer.nearest({&ray, 1}, {});
            }),
            "expected room for as many answers as rays");
  triangles[3][1][2] = INFINITY;
  EXPECT_EQ(refusal([&] { const Tracer wrong(triangles); }).substr(0, 31),
            "triangle 3: found a corner that");
  EXPECT_TRUE(Tracer({}).all({{0, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace raygate
