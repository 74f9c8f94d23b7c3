#include "host/scene/io/ear_clipper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <random>

#include "host/exact/exact.h"

namespace raygate {
namespace {

using Polygon = std::vector<glm::dvec3>;

Polygon in_plane(const std::vector<glm::dvec2>& points) {
  Polygon polygon;
  for (const glm::dvec2& p : points) polygon.emplace_back(p.x, p.y, 0.25 * p.x + 0.5 * p.y);
  return polygon;
}

// Expects triangles that cover the polygon exactly once: n - 2 triangles with an area and the
// polygon's winding (1: counter-clockwise from +z). Each side of the polygon belongs to one
// triangle, in the same direction. Every other side belongs to two, in opposite directions.
void expect_triangulation(const Polygon& polygon, const EarClipper& clipper, int winding = 1) {
  ASSERT_EQ(clipper.triangles().size(), polygon.size() - 2);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& triangle : clipper.triangles()) {
    const auto flat = [&](int i) { return glm::dvec2(polygon[triangle[i]]); };
    ASSERT_EQ(orient2d(flat(0), flat(1), flat(2)), winding);
    for (int i = 0; i < 3; ++i) ++sides[{triangle[i], triangle[(i + 1) % 3]}];
  }
  for (std::uint32_t i = 0; i < polygon.size(); ++i) {
    const auto next = static_cast<std::uint32_t>((i + 1) % polygon.size());
    ASSERT_EQ((sides[{i, next}]), 1) << "side " << i;
    sides.erase({i, next});
  }
  for (const auto& [side, count] : sides) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(sides.count({side.second, side.first})) << side.first << " " << side.second;
  }
}

void expect_simple(const std::vector<glm::dvec2>& points, int winding = 1) {
  EarClipper clipper;
  const Polygon polygon = in_plane(points);
  ASSERT_EQ(clipper.cut(polygon), PolygonKind::kSimple);
  expect_triangulation(polygon, clipper, winding);
}

TEST(EarClipper, CutsAConvexQuadFromFirstToThird) {
  EarClipper clipper;
  EXPECT_EQ(clipper.cut(in_plane({{0, 0}, {1, 0}, {1, 1}, {0, 1}})), PolygonKind::kSimple);
  ASSERT_EQ(clipper.triangles().size(), 2u);
  EXPECT_EQ(clipper.triangles()[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(clipper.triangles()[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(EarClipper, CutsConcavePolygonsFromWhateverCorner) {
  std::vector<glm::dvec2> arrow{{0, 0}, {2, -1}, {0.5f, 0}, {2, 1}};
  std::vector<glm::dvec2> letter{{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  for (int i = 0; i < 8; ++i) {
    expect_simple(arrow);
    expect_simple(letter);
    std::rotate(arrow.begin(), arrow.begin() + 1, arrow.end());
    std::rotate(letter.begin(), letter.begin() + 1, letter.end());
  }
  std::reverse(letter.begin(), letter.end());
  expect_simple(letter, -1);
}

TEST(EarClipper, KeepsCornersOnStraightSides) {
  expect_simple({{0, 0}, {1, 0}, {2, 0}, {1, 1}});
  expect_simple({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {3, 3}, {2, 2}, {1, 1}});
  expect_simple({{0, 0}, {0.1f, 0.1f}, {0.3f, 0.3f}, {0.7f, 0.7f}, {0, 1}});
}

TEST(EarClipper, CutsAHoleReachedByABridge) {
  // An outer square; from its corner 0 a bridge leads to an inner square and back.
  const Polygon polygon =
      in_plane({{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}});
  EarClipper clipper;
  ASSERT_EQ(clipper.cut(polygon), PolygonKind::kSimple);
  ASSERT_EQ(clipper.triangles().size(), 8u);
  double area = 0.0;
  for (const auto& t : clipper.triangles()) {
    const glm::dvec2 a(polygon[t[0]]), b(polygon[t[1]]), c(polygon[t[2]]);
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    EXPECT_GT(twice, 0.0);
    area += 0.5 * twice;
  }
  EXPECT_EQ(area, 12.0);
}

TEST(EarClipper, LeavesRepeatedCornersOut) {
  EarClipper clipper;
  EXPECT_EQ(clipper.cut(in_plane({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 0}})), PolygonKind::kSimple);
  ASSERT_EQ(clipper.triangles().size(), 1u);
  EXPECT_EQ(clipper.triangles()[0], (std::array<std::uint32_t, 3>{0, 1, 3}));
}

TEST(EarClipper, KnowsWhatHasNoArea) {
  EarClipper clipper;
  EXPECT_EQ(clipper.cut(in_plane({{0, 0}, {1, 1}, {2, 2}, {3, 3}})), PolygonKind::kZeroArea);
  EXPECT_EQ(clipper.cut(in_plane({{1, 1}, {1, 1}, {1, 1}, {1, 1}})), PolygonKind::kZeroArea);
  EXPECT_EQ(clipper.cut(in_plane({{0, 0}, {1, 1}, {1, 0}, {0, 1}})), PolygonKind::kZeroArea);
  EXPECT_TRUE(clipper.triangles().empty());
}

TEST(EarClipper, SaysWhenAPolygonCrossesItself) {
  EarClipper clipper;
  const Polygon polygon = in_plane({{0, 0}, {3, 3}, {3, 0}, {0, 2}});
  EXPECT_EQ(clipper.cut(polygon), PolygonKind::kSelfTouching);
  for (const auto& t : clipper.triangles()) {
    EXPECT_NE(triangle_normal({polygon[t[0]], polygon[t[1]], polygon[t[2]]}), glm::dvec3(0.0));
  }
}

TEST(EarClipper, CutsWhatIsNotFlat) {
  EarClipper clipper;
  const Polygon saddle{{0, 0, 0}, {1, 0, 1}, {1, 1, 0}, {0, 1, 1}};
  EXPECT_EQ(clipper.cut(saddle), PolygonKind::kSimple);
  EXPECT_EQ(clipper.triangles().size(), 2u);
  // An upright polygon, whose projection along z has no area.
  const Polygon upright{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0.5f, 0.25f}, {0, 0, 1}};
  EXPECT_EQ(clipper.cut(upright), PolygonKind::kSimple);
  EXPECT_EQ(clipper.triangles().size(), 3u);
}

TEST(EarClipper, CutsRandomStarShapedPolygons) {
  std::mt19937 random(4);
  for (int round = 0; round < 2000; ++round) {
    const std::size_t size = 4 + random() % 40;
    std::vector<double> angles(size);
    for (double& angle : angles) {
      angle = std::uniform_real_distribution(0.0, 2.0 * std::numbers::pi)(random);
    }
    std::sort(angles.begin(), angles.end());
    // The polygon is star-shaped from the origin only if all gaps between angles are below pi.
    double gap = angles.front() + 2.0 * std::numbers::pi - angles.back();
    for (std::size_t i = 1; i < size; ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    if (gap > 3.0) continue;
    std::vector<glm::dvec2> points;
    for (const double angle : angles) {
      const double radius = std::uniform_real_distribution(0.1, 10.0)(random);
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    expect_simple(points);
    if (HasFatalFailure()) FAIL() << "round " << round;
  }
}

std::vector<glm::dvec2> star(int size) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < size; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / size;
    const double radius = 1.0 + i % 2;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

std::vector<glm::dvec2> comb(int size) {
  std::vector<glm::dvec2> points{{0, -1}, {static_cast<float>(size), -1}};
  for (int i = size - 3; i > 0; --i) {
    points.emplace_back(static_cast<float>(i), i % 2 ? 1000.0f : 0.0f);
  }
  return points;
}

std::vector<glm::dvec2> spiral(int size) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < size; ++i) {
    const int step = i < size / 2 ? i : size - 1 - i;  // outwards, then back along the inner side
    const double angle = 40.0 * std::numbers::pi * step / (size / 2);
    const double radius = angle + (i < size / 2 ? 3.0 : 2.0);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

TEST(EarClipper, CutsManyCorners) {
  expect_simple(star(20000));
  expect_simple(comb(20001));
  expect_simple(spiral(20000));
}

// Four times the corners take about four times as long; quadratic code would take 16 times.
TEST(EarClipper, IsNotQuadratic) {
  const auto seconds = [](const std::vector<glm::dvec2>& points) {
    const Polygon polygon = in_plane(points);
    EarClipper clipper;
    double best = 1e9;
    for (int attempt = 0; attempt < 3; ++attempt) {
      const std::clock_t begin = std::clock();
      EXPECT_EQ(clipper.cut(polygon), PolygonKind::kSimple);
      best = std::min(best, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return best;
  };
  EXPECT_LT(seconds(star(40000)), 10 * seconds(star(10000)));
  EXPECT_LT(seconds(comb(40001)), 10 * seconds(comb(10001)));
  EXPECT_LT(seconds(spiral(40000)), 10 * seconds(spiral(10000)));
}

}  // namespace
}  // namespace raygate
