// set_up_unit against its reference model, bit for bit.
#include <gtest/gtest.h>

#include <array>
#include <deque>

#include "Vset_up_unit.h"
#include "host/intersect/core/set_up.h"
#include "sim/model.h"
#include "sim/test/hit_test/float_stream.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr std::size_t kLatency = 18;

struct Triangle {
  glm::vec3 origin;
  Corners corners;
};

/// Words of all kinds, or an ordinary triangle: flat, thin, far away or near the origin's plane,
/// also where its products leave the range in which a plane is good.
class Triangles {
 public:
  Triangle operator()() {
    Triangle next{};
    if (one_in(8)) {
      floats_.next_test();
      for (int k = 0; k < 3; ++k) next.origin[k] = floats_();
      for (glm::vec3& corner : next.corners) {
        for (int k = 0; k < 3; ++k) corner[k] = floats_();
      }
      return next;
    }
    // At these N or d is as small or as large as it may be.
    constexpr int kEnds[] = {-50, -33, 43, 63};
    const int scale = one_in(2) ? 0 : kEnds[random_() % 4] + between(-4, 4);
    for (glm::vec3& corner : next.corners) corner = point(scale - smaller(30));
    if (one_in(3)) {
      next.corners[2] = glm::mix(next.corners[0], next.corners[1], 0.375f);
      if (one_in(2)) next.corners[2] += point(scale - between(0, 24));
    }
    if (one_in(3)) {
      next.origin = glm::mix(next.corners[0], next.corners[2], 1.25f);
      if (one_in(2)) next.origin += point(scale - between(0, 24));
    } else {
      next.origin = point(scale - smaller(40));
    }
    return next;
  }

 private:
  bool one_in(unsigned n) { return random_() % n == 0; }
  int between(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  int smaller(int most) { return one_in(3) ? between(0, most) : 0; }
  glm::vec3 point(int exponent) {
    std::uniform_real_distribution<float> near(-1.0f, 1.0f);
    glm::vec3 at;
    for (int k = 0; k < 3; ++k) at[k] = std::ldexp(near(random_), exponent);
    return at;
  }

  FloatStream floats_{kSeed};
  std::mt19937 random_{kSeed};
};

TEST(SetUpUnit, EqualsItsReference) {
  Model<Vset_up_unit> model;
  Triangles triangles;
  std::deque<Triangle> taken;  // the latest first
  long planes = 0, bounds = 0;
  for (int clock = 0; clock < 200'000; ++clock) {
    taken.push_front(triangles());
    for (int k = 0; k < 3; ++k) {
      model->origin_i[k] = std::bit_cast<std::uint32_t>(taken[0].origin[k]);
      for (int c = 0; c < 3; ++c) {
        model->corners_i[3 * c + k] = std::bit_cast<std::uint32_t>(taken[0].corners[c][k]);
      }
    }
    model.clock();
    if (taken.size() < kLatency) continue;
    const Triangle due = taken.back();
    taken.pop_back();
    const SetUpRecord expected = set_up(due.origin, due.corners);
    const PolygonRecord& record = expected.record;
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(model->record_o[k], bits(record.normal[k])) << "clock " << clock;
      for (int edge = 0; edge < 3; ++edge) {
        ASSERT_EQ(model->record_o[4 + 3 * edge + k], bits(record.edges[edge][k]))
            << "clock " << clock;
      }
      ASSERT_EQ(model->record_o[13 + k], bits(record.bounds[k])) << "clock " << clock;
      bounds += std::isfinite(record.bounds[k]);
    }
    ASSERT_EQ(model->record_o[3], bits(record.d)) << "clock " << clock;
    if (std::isnan(record.d)) continue;
    ASSERT_EQ(model->normal_error_o, expected.normal_error) << "clock " << clock;
    ASSERT_EQ(model->distance_error_o, expected.distance_error) << "clock " << clock;
    ++planes;
  }
  EXPECT_GT(planes, 30'000);
  EXPECT_GT(bounds, 200'000);
}

}  // namespace
}  // namespace raygate
