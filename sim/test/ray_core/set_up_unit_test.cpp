// set_up_unit against its reference model, bit for bit.
// Tests: cross_product, vec_add, vec_mul
#include <gtest/gtest.h>

#include <array>
#include <deque>

#include "Vset_up_unit_0.h"
#include "Vset_up_unit_1.h"
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

/// Words of all kinds, or an ordinary triangle: flat, thin, far away or near the origin's plane.
class Triangles {
 public:
  Triangle operator()() {
    floats_.next_test();
    Triangle next{};
    const auto word = [&] { return floats_(); };
    for (int k = 0; k < 3; ++k) next.origin[k] = word();
    for (glm::vec3& corner : next.corners) {
      for (int k = 0; k < 3; ++k) corner[k] = word();
    }
    switch (random_() % 4) {
      case 0:
        return next;
      case 1:
        next.corners[2] = glm::mix(next.corners[0], next.corners[1], 0.375f);
        return next;
      case 2:
        next.origin = glm::mix(next.corners[0], next.corners[2], 1.25f);
        return next;
      default:
        break;
    }
    std::uniform_real_distribution<float> near(-1.0f, 1.0f);
    for (int k = 0; k < 3; ++k) next.origin[k] = near(random_);
    for (glm::vec3& corner : next.corners) {
      for (int k = 0; k < 3; ++k) corner[k] = near(random_);
    }
    return next;
  }

 private:
  FloatStream floats_{kSeed};
  std::mt19937 random_{kSeed};
};

template <class Top>
class SetUpUnit : public testing::Test {};
using Tops = testing::Types<Vset_up_unit_1, Vset_up_unit_0>;
TYPED_TEST_SUITE(SetUpUnit, Tops, );

TYPED_TEST(SetUpUnit, EqualsItsReference) {
  Model<TypeParam> model;
  Triangles triangles;
  std::deque<Triangle> taken;  // the latest first
  long planes = 0, bounds = 0;
  for (int clock = 0; clock < 60'000; ++clock) {
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
  EXPECT_GT(planes, 10'000);
  EXPECT_GT(bounds, 60'000);
}

}  // namespace
}  // namespace raygate
