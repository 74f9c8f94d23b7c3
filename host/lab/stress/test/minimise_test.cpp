// Failures of cheap arithmetic become simple ones that still fail.
#include "host/lab/stress/minimise.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/lab/stress/runner.h"

namespace raygate::lab {
namespace {

TEST(Minimise, KeepsWhatFailsAndNothingElse) {
  // "Fails" where the second triangle's last vertex is right of 0.3.
  const auto fails = [](const Case& c) {
    return std::ranges::any_of(c.triangles, [](const Corners& t) { return t[2].x > 0.3f; });
  };
  const Corners one = {glm::vec3(0.1f), glm::vec3(7.3f), glm::vec3(-0.7f)};
  const Corners two = {glm::vec3(0.1f), glm::vec3(7.3f), glm::vec3(0.37f)};
  const Case failure = {glm::vec3(1.7f), glm::vec3(1.3f, 0.6f, -0.3f), {one, two}};
  ASSERT_TRUE(fails(failure));
  const Case simple = minimise(failure, fails);
  ASSERT_EQ(simple.triangles.size(), 1u);
  EXPECT_EQ(simple.origin, glm::vec3(0.0f));
  EXPECT_EQ(simple.direction, glm::vec3(1, 0, 0));
  EXPECT_EQ(simple.triangles[0], (Corners{glm::vec3(0), glm::vec3(0), glm::vec3(1, 0, 0)}));
}

TEST(Minimise, WrongDecisionsOfTheUnitWithoutDoubts) {
  const auto kinds = variant_subjects();
  const auto no_doubts = std::ranges::find(kinds, "binary32-raw", &SubjectKind::name);
  const auto edges = std::ranges::find(all_suites(), "sphere edges", &Suite::name);
  ASSERT_NE(no_doubts, kinds.end());
  const std::vector<Row> rows = run({&*edges}, {*no_doubts}, {.tests = 200000});
  const auto failures = rows[0]["failures"].get<std::vector<std::string>>();
  ASSERT_FALSE(failures.empty());
  const auto subject = no_doubts->make();
  const auto fails = [&](const Case& c) { return decides_wrongly(*no_doubts, *subject, c); };
  const auto cpu = engine_subjects()[0];
  const auto engine = cpu.make();
  for (const std::string& text : failures) {
    const Case failure = case_from(text);
    ASSERT_TRUE(fails(failure));
    const Case simple = minimise(failure, fails);
    EXPECT_TRUE(fails(simple));
    EXPECT_LT(complexity(simple), complexity(failure) / 2 + 500);
    EXPECT_FALSE(decides_wrongly(cpu, *engine, simple));
  }
}

TEST(CaseText, ComesBack) {
  const Case failure = {glm::vec3(1), glm::vec3(-0.0f, 1e-40f, 1), {{}, {glm::vec3(3)}}};
  EXPECT_EQ(to_text(case_from(to_text(failure))), to_text(failure));
  EXPECT_THROW((void)case_from("00000000"), std::invalid_argument);
  EXPECT_THROW((void)case_from("hello"), std::invalid_argument);
}

}  // namespace
}  // namespace raygate::lab
