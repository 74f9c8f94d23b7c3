// The stress test detects wrong searches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/lab/stress/stress.h"

namespace raygate::lab {
namespace {

/// Returns the two subjects of the cpu engine.
std::vector<SubjectKind> cpu_subjects() {
  auto kinds = engine_subjects();
  kinds.resize(2);
  return kinds;
}

class InPlace : public testing::Test {
 protected:
  InPlace() {
    Random random(3);
    for (const char* name : {"random", "box edges", "near ties"}) {
      const Generator generate = std::ranges::find(all_suites(), name, &Suite::name)->make();
      for (int i = 0; i < 100; ++i) {
        shots_.push_back(generate(random));
        truths_.push_back(find_truth(shots_.back()));
      }
    }
  }

  Tally judge(const Answers& answers) const {
    Tally tally;
    count(shots_, truths_, answers, {.exact = true, .binary32 = true}, tally);
    return tally;
  }

  std::vector<Shot> shots_;
  std::vector<Truth> truths_;
};

// Imitates a search in which one component of the direction is one float off.
TEST_F(InPlace, ASearchThatIsOneFloatOffIsSeen) {
  auto moved = shots_;
  for (Shot& shot : moved) {
    for (glm::dvec3& direction : shot.directions) {
      direction.x = std::nextafter(static_cast<float>(direction.x), 2.0f);
    }
  }
  for (const SubjectKind& kind : cpu_subjects()) {
    Answers answers;
    kind.make()->run(moved, answers);
    const Tally tally = judge(answers);
    EXPECT_FALSE(tally.spotless()) << kind.name;
    EXPECT_GT(tally.wrong, 0u) << kind.name;
    EXPECT_GT(tally.wrong_nearest, 0u) << kind.name;
  }
}

TEST_F(InPlace, BoundsThatDoNotHoldTAreSeen) {
  for (const SubjectKind& kind : cpu_subjects()) {
    Answers answers;
    kind.make()->run(shots_, answers);
    std::uint64_t hits = 0;
    for (Answer& answer : answers.tests) {
      hits += answer.hit;
      answer.bounds.low = std::nextafter(static_cast<float>(answer.bounds.high), 2e38f);
    }
    const Tally tally = judge(answers);
    EXPECT_GT(hits, 0u);
    EXPECT_EQ(tally.wrong + tally.wrong_ties, hits) << kind.name;
  }
}

// Imitates a table with two hits in the wrong order, or without a ray's last hit.
TEST_F(InPlace, OrdersThatAreWrongAreSeen) {
  Answers answers;
  trace_subjects()[0].make()->run(shots_, answers);
  EXPECT_TRUE(judge(answers).spotless());
  const auto several =
      std::ranges::find_if(answers.orders, [](const auto& o) { return o.size() > 1; });
  ASSERT_NE(several, answers.orders.end());
  std::swap(several->front(), several->back());
  EXPECT_EQ(judge(answers).wrong_order, 1u);
  std::swap(several->front(), several->back());
  several->pop_back();
  EXPECT_FALSE(judge(answers).spotless());
}

}  // namespace
}  // namespace raygate::lab
