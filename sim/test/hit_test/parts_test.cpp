// vec_scale, fp_add3, point_unit, hit_decision, hit_test_control and nearest_hit, each against
// plain C++, with inputs that aren't valid.
#include <gtest/gtest.h>

#include <deque>
#include <optional>

#include "Vparts_top.h"
#include "sim/model.h"
#include "sim/test/hit_test/float_stream.h"

namespace raygate {
namespace {

constexpr std::uint32_t kSeed = 20260203;

class PartsTest : public testing::Test {
 protected:
  PartsTest() {
    model_->valid_i = 0;
    model_.reset();
  }

  bool one_in(unsigned n) { return random_() % n == 0; }

  Model<Vparts_top> model_;
  FloatStream floats_{kSeed};
  std::mt19937 random_{kSeed};
};

TEST_F(PartsTest, ProductsSumsAndPointsEqualFloatArithmetic) {
  constexpr std::size_t kProduct = 3, kSum = 6, kPoint = 17;  // latencies
  struct Operands {
    float words[5], factor;
    bool valid;
  };
  std::deque<Operands> taken;  // the latest first
  int points = 0;
  for (int clock = 0; clock < 100'000; ++clock) {
    floats_.next_test();
    Operands operands{};
    for (float& word : operands.words) word = floats_();
    operands.factor = floats_();
    operands.valid = !one_in(3);
    for (int k = 0; k < 5; ++k)
      model_->words_i[k] = std::bit_cast<std::uint32_t>(operands.words[k]);
    model_->factor_i = std::bit_cast<std::uint32_t>(operands.factor);
    model_->valid_i = operands.valid;
    taken.push_front(operands);
    model_.clock();
    if (taken.size() < kPoint) continue;
    taken.resize(kPoint);
    for (int k = 0; k < 5; ++k) {
      const Operands& due = taken[kProduct - 1];
      ASSERT_EQ(model_->products_o[k], bits(due.words[k] * due.factor)) << "clock " << clock;
    }
    const float(&x)[5] = taken[kSum - 1].words;
    ASSERT_EQ(model_->sum_o, bits((x[0] + x[1]) + x[2])) << "clock " << clock;
    const Operands& due = taken[kPoint - 1];
    ASSERT_EQ(model_->point_valid_o, due.valid) << "clock " << clock;
    if (!due.valid) continue;
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(model_->point_o[k], bits(due.words[k] / due.factor)) << "clock " << clock;
    }
    ++points;
  }
  EXPECT_GT(points, 50'000);
}

TEST_F(PartsTest, DecisionsFollowTheirDefinition) {
  int verdicts[3] = {};
  const auto field = [](float x) {
    return static_cast<int>(std::bit_cast<std::uint32_t>(x) >> 23 & 0xff);
  };
  for (int i = 0; i < 200'000; ++i) {
    floats_.next_test();
    const float d = one_in(8) ? std::copysign(NAN, floats_()) : floats_();
    float v = std::copysign(floats_(), one_in(4) ? -d : d);
    if (one_in(16)) v = floats_();
    int normal_exponent = field(v) + static_cast<int>(random_() % 32) - 16;
    normal_exponent = std::clamp(normal_exponent, 0, 255);
    bool hit = d != 0.0f && !std::isnan(d), any_agrees = false, any_differs = false;
    for (int k = 0; k < 3; ++k) {
      const float u = std::copysign(floats_(), one_in(4) ? -d : d);
      float bound = std::abs(floats_()) * 0x1p-10f;
      if (one_in(4)) {  // around |u|
        bound =
            from_bits((std::bit_cast<std::uint32_t>(std::abs(u)) + random_() % 3 - 1) & 0x7fffffff);
      }
      model_->u_i[k] = std::bit_cast<std::uint32_t>(u);
      model_->bounds_i[k] = std::bit_cast<std::uint32_t>(bound);
      const bool sure = bound < std::abs(u) && std::isfinite(u);
      const bool agrees = std::signbit(u) == std::signbit(d);
      any_agrees |= sure && agrees;
      any_differs |= sure && !agrees;
      hit &= sure && agrees;
    }
    const bool miss = d == 0.0f || (any_differs && (any_agrees || !std::isnan(d)));
    const int grazing = normal_exponent - field(v);
    hit &= std::isnormal(v) && std::signbit(v) == std::signbit(d) && grazing <= 12;
    model_->d_i = std::bit_cast<std::uint32_t>(d);
    model_->v_i = std::bit_cast<std::uint32_t>(v);
    model_->normal_exponent_i = static_cast<std::uint8_t>(normal_exponent);
    model_.eval();
    const unsigned expected = miss ? 4 : hit ? 2 : 1;
    ASSERT_EQ(model_->verdict_o, expected) << "case " << i << " of seed " << kSeed;
    if (hit) {
      ASSERT_EQ(model_->t_error_o, std::max(grazing, 0)) << "case " << i;
    }
    ++verdicts[expected / 2];
  }
  for (const int verdict : verdicts) EXPECT_GT(verdict, 1000);
}

TEST_F(PartsTest, ControlsCountWordsAndSteps) {
  struct Counters {
    int words, steps, word = 0, step = 0;
  } controls[2] = {{7, 3}, {10, 5}};
  int tests = 0;
  for (int clock = 0; clock < 50'000; ++clock) {
    model_->valid_i = one_in(1 + static_cast<unsigned>(clock) / 5'000);
    model_.eval();
    for (int n = 0; n < 2; ++n) {
      Counters& control = controls[n];
      ASSERT_EQ(model_->control_ready_o >> n & 1, control.word == 0) << "clock " << clock;
      ASSERT_EQ(model_->word_o >> 4 * n & 15, control.word) << "clock " << clock;
      ASSERT_EQ(model_->step_o >> 4 * n & 15, control.step) << "clock " << clock;
      const bool last = control.word == control.words - 1;
      control.step = last ? 1 : control.step == 0 ? 0 : (control.step + 1) % (control.steps + 1);
      tests += last;
      if (control.word != 0 || model_->valid_i) control.word = (control.word + 1) % control.words;
    }
    model_.clock();
  }
  EXPECT_GT(tests, 3'000);
}

TEST_F(PartsTest, TheNearestHitOfEachBurst) {
  struct Hit {
    std::uint32_t tag, t;
    int error;
  };
  std::optional<Hit> nearest;
  bool first = true;
  int reports[3] = {}, found = 0;
  std::uint32_t base = 0x3f800000;
  for (std::uint32_t tag = 0; tag < 200'000; ++tag) {
    if (one_in(16)) base = std::bit_cast<std::uint32_t>(floats_());
    // Margins are up to 2 * 2^(6 + error): distances around them.
    const std::uint32_t t = base + random_() % (1u << random_() % 12);
    const int error = one_in(4) ? static_cast<int>(random_() % 13) : 0;
    const bool valid = !one_in(4), last = one_in(5);
    const bool hit = !one_in(3), doubt = !hit && one_in(2);
    model_->valid_i = valid;
    model_->first_i = first;
    model_->last_i = last;
    model_->hit_i = hit;
    model_->doubt_i = doubt;
    model_->tag_i = tag;
    model_->t_i = t;
    model_->t_error_i = static_cast<std::uint8_t>(error);
    model_.eval();
    const bool sure = valid && hit && std::isnormal(from_bits(t)) && from_bits(t) > 0.0f;
    ASSERT_EQ(model_->sure_hit_o, sure) << "test " << tag;
    model_.clock();
    if (!valid) {
      ASSERT_EQ(model_->report_o, 0) << "test " << tag;
      ASSERT_FALSE(model_->closed_o) << "test " << tag;
      continue;
    }
    if (first) nearest.reset();
    unsigned report = doubt || (hit && !sure) ? 1 : 0;
    std::uint32_t report_tag = tag;
    if (sure) {
      const bool nearer = !nearest || t < nearest->t;
      if (nearest) {
        const std::int64_t apart =
            std::abs(static_cast<std::int64_t>(t) - static_cast<std::int64_t>(nearest->t));
        if (apart <= (std::int64_t{64} << error) + (std::int64_t{64} << nearest->error)) {
          report = 2;
          if (nearer) report_tag = nearest->tag;
        }
      }
      if (nearer) nearest = Hit{tag, t, error};
    }
    ASSERT_EQ(model_->report_o, report) << "test " << tag;
    ASSERT_EQ(model_->report_tag_o, report_tag) << "test " << tag;
    ASSERT_EQ(model_->closed_o, last) << "test " << tag;
    ASSERT_EQ(model_->found_o, nearest.has_value()) << "test " << tag;
    if (nearest) {
      ASSERT_EQ(model_->nearest_tag_o, nearest->tag) << "test " << tag;
      ASSERT_EQ(model_->nearest_t_o, nearest->t) << "test " << tag;
      ASSERT_EQ(model_->nearest_t_error_o, nearest->error) << "test " << tag;
      ASSERT_EQ(model_->payload_o, ~nearest->tag) << "test " << tag;
      found += last;
    }
    ++reports[report];
    first = last;
  }
  for (const int count : reports) EXPECT_GT(count, 1'000);
  EXPECT_GT(found, 1'000);
}

}  // namespace
}  // namespace raygate
