// Compares the exact unit with its reference model (answers, clocks) and with exact numbers.
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "Vexact_unit_24.h"
#include "Vexact_unit_48.h"
#include "Vexact_unit_behavioural.h"
#include "host/lab/stress/test/exact_requests.h"
#include "sim/model.h"

namespace raygate {
namespace {

using lab::ExactCase;

/// Returns the number of cases per suite and model: 300, or RAYGATE_STRESS shared among all suites.
std::size_t cases_of_a_suite() {
  const char* wanted = std::getenv("RAYGATE_STRESS");
  return wanted == nullptr ? 300 : std::strtoul(wanted, nullptr, 10) / lab::all_suites().size() + 1;
}

template <class Top>
void put(const ExactRequest& request, Top& top) {
  constexpr std::size_t kDirection = 3, kTriangle = 6, kOther = 15, kLimit = 24;  // as in exact_pkg
  float floats[25];
  const auto vector = [&](std::size_t place, const glm::vec3& v) {
    std::memcpy(&floats[place], &v, sizeof v);
  };
  vector(0, request.ray.origin);
  vector(kDirection, request.ray.direction);
  for (std::size_t k = 0; k < 3; ++k) {
    vector(kTriangle + 3 * k, request.triangle[k]);
    vector(kOther + 3 * k, request.other[k]);
  }
  floats[kLimit] = request.limit;
  std::memcpy(&top->floats_i, floats, sizeof floats);
  top->hit_i = request.asks_hit;
  top->against_i = static_cast<std::uint8_t>(request.against);
}

template <class Top>
struct Kind {
  using Model = Top;
  static constexpr int kWidth = 48;
};
struct Narrow {
  using Model = Vexact_unit_24;
  static constexpr int kWidth = 24;
};

/// Returns the maximum latency that hw/exact/README.md states for a request, with 48-bit digits.
int most_clocks(const ExactRequest& request) {
  if (request.asks_hit) return request.against == ExactRequest::Against::kNothing ? 1602 : 3686;
  return request.against == ExactRequest::Against::kLimit ? 1080 : 2093;
}

template <class Kind>
class ExactUnitTest : public testing::Test {};
using Kinds = testing::Types<Kind<Vexact_unit_behavioural>, Kind<Vexact_unit_48>, Narrow>;
TYPED_TEST_SUITE(ExactUnitTest, Kinds);

TYPED_TEST(ExactUnitTest, EqualsItsReference) {
  constexpr std::uint64_t kSeed = 20261125;
  lab::Random random(kSeed);
  Model<typename TypeParam::Model> model;
  model->valid_i = model->ready_i = 0;
  model.reset();
  std::size_t hits = 0, done = 0;
  for (const lab::Suite& suite : lab::all_suites()) {
    if (suite.binary64) continue;
    lab::ExactCases cases(suite, kSeed);
    for (std::size_t here = 0; here < cases_of_a_suite();) {
      for (const ExactCase& wanted : cases.next()) {
        const ExactAnswer expected = decide(wanted.request, TypeParam::kWidth);
        for (int idle = random.below(3); idle > 0; --idle) model.clock();
        ASSERT_TRUE(model->ready_o);
        put(wanted.request, model);
        model->valid_i = 1;
        model.clock();
        model->valid_i = 0;
        std::memset(&model->floats_i, random.below(256), sizeof model->floats_i);
        int clocks = 1;
        while (!model->valid_o && clocks < 20'000) model.clock(), ++clocks;
        for (int wait = random.below(3); wait > 0; --wait) model.clock();
        ASSERT_TRUE(model->valid_o) << "and stays until taken";
        const int order = model->order_o == 0 ? 0 : (model->order_o == 3 ? -1 : 1);
        ASSERT_EQ(model->hit_o, wanted.hit)
            << suite.name << ", seed " << kSeed << ", case " << here;
        ASSERT_EQ(order, wanted.order) << suite.name << ", seed " << kSeed << ", case " << here;
        ASSERT_EQ(expected.hit, wanted.hit);
        ASSERT_EQ(expected.order, wanted.order);
        if (TypeParam::kWidth == 48) {
          ASSERT_LE(clocks, most_clocks(wanted.request));
        }
        ASSERT_EQ(clocks, expected.clocks) << suite.name << ", seed " << kSeed << ", case " << here;
        model->ready_i = 1;
        model.clock();
        model->ready_i = 0;
        hits += wanted.hit ? 1 : 0;
        ++here;
      }
      done += here == 0 ? 0 : 1;
    }
  }
  EXPECT_GT(done, 0u);
  EXPECT_GT(hits, cases_of_a_suite());
}

}  // namespace
}  // namespace raygate
