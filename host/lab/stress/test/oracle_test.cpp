// Compares the oracle with rational arithmetic, and checks its results in simple cases.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "host/exact/test/rational_oracle.h"
#include "host/lab/stress/cases.h"

namespace raygate::lab {
namespace {

using test::cross, test::dot, test::Rational3;

Rational3 minus(const glm::dvec3& a, const glm::dvec3& b) {
  return test::minus(test::rational(a), test::rational(b));
}

/// Returns the t of a hit.
mpq_class distance(const glm::dvec3& origin, const glm::dvec3& direction, const Corners& t) {
  const Rational3 a = minus(t[0], origin), normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  return dot(a, normal) / dot(test::rational(direction), normal);
}

/// Returns whether the ray, tilted by (e, e^2, e^3) for a very small e, meets the triangle.
bool hits(const glm::dvec3& origin, const glm::dvec3& direction, const Corners& t) {
  const Rational3 a = minus(t[0], origin), b = minus(t[1], origin), c = minus(t[2], origin);
  Rational3 tilted = test::rational(direction);
  mpq_class e(1);
  e >>= 2000;
  mpq_class power = e;
  for (mpq_class& component : tilted) {
    component += power;
    power *= e;
  }
  const int side = sgn(dot(a, cross(b, c)));
  return side != 0 && sgn(dot(tilted, cross(a, b))) == side &&
         sgn(dot(tilted, cross(b, c))) == side && sgn(dot(tilted, cross(c, a))) == side;
}

TEST(Oracle, AgreesWithRationalsInEverySuite) {
  for (const Suite& suite : all_suites()) {
    if (suite.name == "useless") continue;  // NaN and infinity are not rational
    Random random(7);
    const Generator generate = suite.make();
    int decided = 0, met = 0;
    while (decided < 400) {
      const Shot shot = generate(random);
      const Truth truth = find_truth(shot);
      auto verdict = truth.verdicts.begin();
      for (std::size_t ray = 0; ray < shot.directions.size(); ++ray) {
        const glm::dvec3& direction = shot.directions[ray];
        std::vector<std::pair<mpq_class, std::uint32_t>> met_here;
        for (std::uint32_t i = 0; i < shot.mesh->size(); ++i) {
          const Corners& t = (*shot.mesh)[i];
          const bool hit = hits(shot.origin, direction, t);
          ASSERT_EQ((verdict++)->hit, hit) << suite.name;
          if (hit) met_here.emplace_back(distance(shot.origin, direction, t), i);
          ++decided;
        }
        met += static_cast<int>(met_here.size());
        std::ranges::sort(met_here);
        ASSERT_EQ(truth.orders[ray].size(), met_here.size());
        for (std::size_t k = 0; k < met_here.size(); ++k) {
          ASSERT_EQ(truth.orders[ray][k], met_here[k].second) << suite.name;
        }
      }
    }
    if (suite.name != "degenerate") {
      EXPECT_GT(met, 0) << suite.name;
    }
  }
}

TEST(Oracle, TellsTheNearestAndItsTies) {
  const auto at_depth = [](double z) {
    return Corners{glm::dvec3(-1, -1, z), glm::dvec3(1, -1, z), glm::dvec3(0, 1, z)};
  };
  Shot shot;
  shot.mesh =
      std::make_shared<const Mesh>(Mesh{at_depth(2), at_depth(1), at_depth(1), at_depth(-1)});
  shot.directions = {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0), glm::dvec3(0)};
  const Truth truth = find_truth(shot);
  EXPECT_EQ(truth.orders[0], (std::vector<std::uint32_t>{1, 2, 0}));
  EXPECT_EQ(truth.nearest(0), 1u);
  EXPECT_TRUE(truth.nearest_tied[0]);
  EXPECT_EQ(truth.nearest(1), 3u);
  EXPECT_FALSE(truth.nearest_tied[1]);
  EXPECT_FALSE(truth.nearest(2));
  EXPECT_FALSE(truth.nearest(3));
  EXPECT_EQ(truth.verdicts[0].t, 2.0);
}

}  // namespace
}  // namespace raygate::lab
