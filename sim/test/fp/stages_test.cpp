// The float cores of both kinds, whole and cut: all the same bits and flags, which are those of
// MPFR (and of the FPU), in five rounding modes and the three reserved ones, with operands that
// aren't valid.
#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "Vstages_top.h"
#include "sim/fp/vectors.h"
#include "sim/model.h"
#include "sim/test/fp/core_check.h"
#include "sim/test/fp/oracle.h"
#include "sim/test/fp/x86_fpu.h"

namespace raygate {
namespace {

constexpr std::size_t kLatency = 17;
constexpr int kPairsOfAMode = 10'000;

struct Expected {
  std::uint32_t a, b;
  bool valid;
  FloatResult sum, product, quotient;
};

FloatResult result_of(FloatOp op, std::uint32_t a, std::uint32_t b, RoundingMode rounding,
                      Tininess tininess) {
  const FloatResult result =
      round_exact(kBinary32, exact_result(kBinary32, op, a, b), rounding, tininess);
  if (x86_has(rounding) && tininess == Tininess::kAfterRounding) {
    EXPECT_EQ(result, x86_result(op, a, b, rounding)) << std::hex << a << ' ' << b;
  }
  return result;
}

std::uint64_t packed(FloatResult result) { return std::uint64_t{result.bits} << 5 | result.flags; }

TEST(StagesTest, CutAndBehaviouralCoresHaveTheBitsOfMpfr) {
  Model<Vstages_top> model;
  std::mt19937_64 random(test_seed());
  std::vector<OperandPair> edges = crossed_edges(kBinary32);
  std::shuffle(edges.begin(), edges.end(), random);
  std::size_t edge = 0;
  std::uint64_t compared = 0, quotients = 0;
  for (int mode = 0; mode < 16; ++mode) {
    const RoundingMode rounding = rounding_of(mode / 2);
    const auto tininess = static_cast<Tininess>(mode % 2);
    PairSource sources[] = {{kBinary32, FloatOp::kAdd, random()},
                            {kBinary32, FloatOp::kMul, random()},
                            {kBinary32, FloatOp::kDiv, random()}};
    model->rounding_mode_i = static_cast<std::uint8_t>(mode / 2);
    model->tininess_after_i = static_cast<std::uint8_t>(tininess);
    std::deque<Expected> stages;  // nothing of the mode before is looked at
    for (int i = 0; i < kPairsOfAMode; ++i) {
      const OperandPair pair = i % 4 == 3 ? edges[edge++ % edges.size()] : sources[i % 4].next();
      const bool subtract = random() % 2 != 0;
      model->a_i = pair.a;
      model->b_i = pair.b;
      model->subtract_i = subtract;
      model->valid_i = random() % 4 != 0;
      const auto result = [&](FloatOp op) {
        return result_of(op, pair.a, pair.b, rounding, tininess);
      };
      stages.push_front({pair.a, pair.b, model->valid_i != 0,
                         result(subtract ? FloatOp::kSub : FloatOp::kAdd), result(FloatOp::kMul),
                         result(FloatOp::kDiv)});
      model.clock();
      if (stages.size() < kLatency) continue;
      stages.resize(kLatency);
      const Expected& due = stages.back();
      SCOPED_TRACE(testing::Message() << "rounding " << mode / 2 << " tininess " << mode % 2
                                      << std::hex << " operands " << due.a << ' ' << due.b);
      ASSERT_EQ(model->sum_o, packed(due.sum));
      ASSERT_EQ(model->product_o, packed(due.product));
      if (due.valid) {
        ASSERT_EQ(model->quotient_o, packed(due.quotient));
      }
      ASSERT_EQ(model->valid_o, due.valid);
      ASSERT_EQ(model->differ_sum_o, 0u);
      ASSERT_EQ(model->differ_product_o, 0u);
      ASSERT_EQ(model->differ_quotient_o, 0u);
      ++compared;
      quotients += due.valid;
    }
  }
  EXPECT_GT(compared, 150'000u);
  EXPECT_GT(quotients, 100'000u);
}

}  // namespace
}  // namespace raygate
