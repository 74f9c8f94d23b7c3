// Compares triangle_test with its reference model, bit for bit, with a triangle in every clock or
// in every eleventh clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <deque>

#include "Vtriangle_test_1.h"
#include "Vtriangle_test_11.h"
#include "host/intersect/core/linked_core.h"
#include "host/intersect/core/reference_core.h"
#include "host/intersect/unit/burst_unit.h"
#include "sim/model.h"
#include "sim/test/hit_test/float_stream.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20261122;
constexpr unsigned kRays = 64;  // rays in flight; more than tests in flight

struct Triangle {
  glm::vec3 origin, direction;
  FloatCorners corners;
  bool is_valid = false, is_exact = false, is_error = false, is_ignored = false;
};

/// Random triangles with any bit patterns, or ordinary ones: flat, thin, far away, with a vertex
/// near the origin, or in a plane near it, some with products beyond the range of valid planes. Two
/// in three rays aim at a point of the triangle, half of these at a point close to an edge.
class Triangles {
 public:
  Triangle operator()() {
    Triangle next = seen();
    const auto& [a, b, c] = next.corners;
    const float s = one_in(2) ? std::ldexp(part(), -between(15, 24)) : part(), t = part();
    next.direction = a + s * (b - a) + (1.0f - s) * t * (c - a) - next.origin;
    const float most = std::max(
        {std::abs(next.direction.x), std::abs(next.direction.y), std::abs(next.direction.z)});
    if (one_in(3) || !std::isnormal(most)) {
      next.direction = point(0);
      next.direction[static_cast<int>(random_() % 3)] = 1.0f;
    } else {
      for (int k = 0; k < 3; ++k)
        next.direction[k] = std::ldexp(next.direction[k], -std::ilogb(most));
    }
    next.is_valid = !one_in(4);
    next.is_exact = one_in(16);
    next.is_error = one_in(16);
    next.is_ignored = one_in(8);
    return next;
  }

 private:
  Triangle seen() {
    Triangle next{};
    if (one_in(8)) {
      floats_.next_test();
      for (int k = 0; k < 3; ++k) next.origin[k] = floats_();
      for (glm::vec3& corner : next.corners) {
        for (int k = 0; k < 3; ++k) corner[k] = floats_();
      }
      return next;
    }
    // At these scales (exponents), N or d is close to its smallest or largest valid magnitude.
    constexpr int kEnds[] = {-50, -33, 43, 63};
    const int scale = one_in(2) ? 0 : kEnds[random_() % 4] + between(-4, 4);
    for (glm::vec3& corner : next.corners) corner = point(scale - smaller(30));
    if (one_in(3)) {
      next.corners[2] = glm::mix(next.corners[0], next.corners[1], 0.375f);
      if (one_in(2)) next.corners[2] += point(scale - between(0, 24));
    }
    if (one_in(4)) {
      next.corners[0] = point(between(-20, 5));
      next.origin = point(between(-20, 5));
    } else if (one_in(3)) {
      next.origin = glm::mix(next.corners[0], next.corners[2], 1.25f);
      if (one_in(2)) next.origin += point(scale - between(0, 24));
    } else {
      next.origin = point(scale - smaller(40));
    }
    return next;
  }
  bool one_in(unsigned n) { return random_() % n == 0; }
  int between(int low, int high) { return std::uniform_int_distribution(low, high)(random_); }
  float part() { return std::uniform_real_distribution<float>(0.0f, 1.0f)(random_); }
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

template <class UnitTop, unsigned kClocksOfAStep>
struct Kind {
  using Top = UnitTop;
  static constexpr unsigned kClocks = kClocksOfAStep;
};

template <class UnitKind>
class TriangleTest : public testing::Test {
 protected:
  /// Returns a triangle's index. Indices are distinct and use all 32 bits.
  static std::uint32_t index(unsigned number) { return 0x9E3779B1 * number; }

  void send(const Triangle& triangle, std::uint32_t number) {
    std::memset(&model_->triangle_i, 0, sizeof model_->triangle_i);
    PackedFields fields(model_->triangle_i);  // ray_core_pkg::triangle_line_t
    for (const glm::vec3& corner : triangle.corners) fields.put(corner);
    fields.put(index(number));
    fields.put(0);
    fields.put(triangle.is_error, 1);
    fields.put(triangle.is_exact, 1);
    fields.put(triangle.is_valid, 1);
  }

  /// Compares the verdict on this triangle with the reference model's.
  void check(const Triangle& triangle, std::uint32_t number) {
    PackedFields fields(model_->verdict_o);  // ray_core_pkg::verdict_t
    glm::vec3 point;
    for (int k = 0; k < 3; ++k) point[k] = fields.take_float();
    const std::uint32_t distance_error = fields.take(4), normal_error = fields.take(4),
                        t_error = fields.take(4), t = fields.take();
    ASSERT_EQ(fields.take(), index(number));
    const bool found = fields.take(1) != 0, doubt = fields.take(1) != 0;
    ASSERT_EQ(fields.take(1), triangle.is_error || triangle.is_ignored);
    const SetUpRecord expected = set_up(triangle.origin, triangle.corners);
    const ReferenceBurstUnit reference;
    HitDistance distance;
    const UnitVerdict verdict = reference.verdict(expected.record, triangle.direction, distance);
    ASSERT_EQ(found, verdict == UnitVerdict::kHit);
    ASSERT_EQ(doubt, verdict == UnitVerdict::kDoubt);
    ++verdicts_[static_cast<int>(verdict)];
    if (!found) return;
    ASSERT_EQ(t, bits(distance.t));
    ASSERT_EQ(t_error, distance.error);
    ASSERT_EQ(normal_error, expected.normal_error);
    ASSERT_EQ(distance_error, expected.distance_error);
    const glm::vec3 expected_point = reference.point(expected.record, triangle.direction);
    for (int k = 0; k < 3; ++k) ASSERT_EQ(bits(point[k]), bits(expected_point[k]));
  }

  Model<typename UnitKind::Top> model_;
  std::array<long, 3> verdicts_{};
};

using Kinds = testing::Types<Kind<Vtriangle_test_1, 1>, Kind<Vtriangle_test_11, 11>>;
TYPED_TEST_SUITE(TriangleTest, Kinds);

TYPED_TEST(TriangleTest, EqualsItsReference) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Triangles triangles;
  std::array<Triangle, kRays> rays;
  std::deque<unsigned> waiting;  // numbers of triangles without a verdict
  auto& model = this->model_;
  model->step_i = 0;
  model.reset();
  for (unsigned number = 0; number < 200'000; ++number) {
    const unsigned ctx = number % kRays;
    rays[ctx] = triangles();
    if (rays[ctx].is_valid && !rays[ctx].is_exact) waiting.push_back(number);
    this->send(rays[ctx], number);
    model->ctx_i = ctx;
    model->step_i = 1;
    model.eval();
    const Triangle& directed = rays[model->direction_ctx_o];
    for (unsigned clock = 0; clock < TypeParam::kClocks; ++clock) {
      model.clock();
      if (clock == 0) {
        std::memcpy(&model->direction_i, &directed.direction, sizeof directed.direction);
        std::memcpy(&model->origin_i, &rays[ctx].origin, sizeof rays[ctx].origin);
        const std::uint32_t id = this->index(number);
        model->skip_id_i = rays[ctx].is_ignored && number % 2 == 0 ? id : ~id;
        model->source_id_i = rays[ctx].is_ignored && number % 2 != 0 ? id : ~id;
        if (TypeParam::kClocks != 1) model->step_i = 0;
      }
      model.eval();
      if ((model->verdict_o[5] >> 15 & 1) == 0) continue;
      ASSERT_FALSE(waiting.empty());
      if (TypeParam::kClocks == 1) {
        ASSERT_EQ(number + 1 - waiting.front(), 48u) << "see its header";
      }
      ASSERT_EQ(model->ctx_o, waiting.front() % kRays);
      ASSERT_NO_FATAL_FAILURE(this->check(rays[waiting.front() % kRays], waiting.front()));
      waiting.pop_front();
    }
    ASSERT_LT(waiting.size(), kRays);
  }
  for (const long verdicts : this->verdicts_) EXPECT_GT(verdicts, 5'000);
}

}  // namespace
}  // namespace raygate
