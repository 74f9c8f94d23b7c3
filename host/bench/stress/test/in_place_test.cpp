// The searches in place: what the stress test would see of wrong ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/bench/stress/suites.h"
#include "host/bench/stress/tally.h"
#include "host/bench/stress/variants.h"

namespace raygate::stress {
namespace {

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
    count(shots_, truths_, answers, true, tally);
    return tally;
  }

  std::vector<Shot> shots_;
  std::vector<Truth> truths_;
};

TEST_F(InPlace, SearchesAreSpotless) {
  for (const VariantKind& kind : in_place_variants()) {
    EXPECT_TRUE(kind.exact);
    Answers answers;
    kind.make()->run(shots_, answers);
    const Tally tally = judge(answers);
    EXPECT_TRUE(tally.spotless()) << kind.name;
    EXPECT_GT(tally.doubts, 0u) << kind.name;
    EXPECT_GT(tally.point_of_bound, 0.0) << kind.name;
  }
}

// As by a search that takes one component of a direction for the next float.
TEST_F(InPlace, ASearchThatIsOneFloatOffIsSeen) {
  auto moved = shots_;
  for (Shot& shot : moved) {
    for (glm::vec3& direction : shot.directions) direction.x = std::nextafter(direction.x, 2.0f);
  }
  for (const VariantKind& kind : in_place_variants()) {
    Answers answers;
    kind.make()->run(moved, answers);
    const Tally tally = judge(answers);
    EXPECT_FALSE(tally.spotless()) << kind.name;
    EXPECT_GT(tally.wrong, 0u) << kind.name;
    EXPECT_GT(tally.wrong_nearest, 0u) << kind.name;
  }
}

TEST_F(InPlace, BoundsThatDoNotHoldTAreSeen) {
  for (const VariantKind& kind : in_place_variants()) {
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

}  // namespace
}  // namespace raygate::stress
