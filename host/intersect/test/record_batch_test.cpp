// Four records at a time are what they are one by one.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "host/exact/test/meshes.h"
#include "host/intersect/polygon_record.h"

namespace raygate {
namespace {

using test::Random;

void expect_same(const glm::vec3& origin, const std::vector<Corners>& triangles) {
  std::vector<PolygonRecord> records(triangles.size());
  make_records(origin, triangles, records);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const PolygonRecord expected = make_record(origin, triangles[i]);
    ASSERT_EQ(std::memcmp(&records[i], &expected, sizeof expected), 0) << "triangle " << i;
    const PolygonRecord plane = make_plane(origin, triangles[i]);
    ASSERT_EQ(std::memcmp(&plane, &expected, 16), 0) << "triangle " << i;
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    // Four origins, four triangles.
    PlaneViews views;
    for (std::size_t k = 0; k < kPlanes; ++k) {
      views.origins[k] = origin * static_cast<float>(k + 1);
      views.triangles[k] = triangles[(i + k) % triangles.size()];
    }
    Planes planes;
    make_planes(views, planes);
    for (std::size_t k = 0; k < kPlanes; ++k) {
      const PolygonRecord expected = make_plane(views.origins[k], views.triangles[k]);
      const float words[] = {planes.words[0][k], planes.words[1][k], planes.words[2][k],
                             planes.words[3][k]};
      ASSERT_EQ(std::memcmp(words, &expected, sizeof words), 0);
    }
  }
}

TEST(RecordBatch, HasTheBitsOfSingleRecordsAndPlanes) {
  Random random;
  for (int round = 0; round < 2000; ++round) {
    const float size = std::ldexp(1.0f, random.below(5) == 0 ? random.below(240) - 120 : 0);
    const glm::vec3 origin = random.point(size);
    std::vector<Corners> triangles;
    const int count = 1 + random.below(9);
    for (int i = 0; i < count; ++i) {
      Corners t = {random.point(size), random.point(size), random.point(size)};
      switch (random.below(8)) {
        case 0:
          t[1] = t[0];  // no edge
          break;
        case 1:
          t[2] = t[0] + 0.5f * (t[1] - t[0]);  // hardly any area
          break;
        case 2:
          t[0] = origin;
          break;
        case 3:
          for (glm::vec3& v : t) v.y = origin.y;  // the origin in the plane
          break;
        case 4:
          for (glm::vec3& v : t) v = origin + 1e-6f * v;
          break;
        case 5:
          for (glm::vec3& v : t) v = 1000.0f * size + 1e-3f * v;
          break;
        default:
          break;
      }
      triangles.push_back(t);
    }
    expect_same(origin, triangles);
  }
}

TEST(RecordBatch, OfASphere) { expect_same(glm::vec3(0.1f, 0.2f, 3.0f), test::sphere(4)); }

}  // namespace
}  // namespace raygate
