// The searches in place: what the stress test would see of wrong ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/lab/stress/stress.h"
#include "host/scene/camera.h"

namespace raygate::lab {
namespace {

/// The cpu engine, both ways.
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

// Triangles that fill their boxes, in planes across an axis, equal or a few floats apart: a search
// that leaves boxes out a little too soon does not find the nearest.
TEST(InPlaceStacks, TheNearestIsNotCulled) {
  Random random(5);
  std::vector<Shot> shots;
  std::vector<Truth> truths;
  for (int i = 0; i < 200; ++i) {
    const int axis = random.below(3);
    const auto at = [&](double x, double y, float depth) {
      glm::vec3 point;
      point[axis] = depth;
      point[(axis + 1) % 3] = static_cast<float>(x);
      point[(axis + 2) % 3] = static_cast<float>(y);
      return point;
    };
    auto mesh = std::make_shared<Mesh>();
    for (int k = 0; k < 24; ++k) {
      float depth = 1.0f;
      for (int steps = random.below(3); steps > 0; --steps) depth = std::nextafter(depth, 2.0f);
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      mesh->push_back(
          {at(x - 2.0, y - 2.0, depth), at(x + 2.0, y - 2.0, depth), at(x, y + 2.0, depth)});
    }
    Shot& shot = shots.emplace_back();
    shot.mesh = mesh;
    for (int ray = 0; ray < 8; ++ray) {
      const glm::dvec3 aim(at(random.uniform(-1, 1), random.uniform(-1, 1), 1.0f));
      shot.directions.emplace_back(scaled_direction(aim));
    }
    truths.push_back(find_truth(shot));
  }
  for (const SubjectKind& kind : cpu_subjects()) {
    Answers answers;
    kind.make()->run(shots, answers);
    Tally tally;
    count(shots, truths, answers, kind, tally);
    EXPECT_GT(tally.hits, tally.rays) << kind.name;
    EXPECT_TRUE(tally.spotless()) << kind.name;
  }
}

// As by a search that takes one component of a direction for the next float.
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

// As by a table that has two hits of a ray in the wrong order, or leaves the last one out.
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
