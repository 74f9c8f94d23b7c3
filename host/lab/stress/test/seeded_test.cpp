// A short `make stress`: every suite, the regressions and the public tests.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "host/lab/stress/stress.h"

namespace raygate::lab {
namespace {

class Seeded : public testing::TestWithParam<std::size_t> {};

TEST_P(Seeded, ExactSubjectsAreSpotless) {
  for (const Row& row : run(all_suites()[GetParam()], all_subjects(), 20000, 1)) {
    EXPECT_EQ(row["broken_claims"], 0) << row.dump();
    EXPECT_GT(row["tests"], 0) << row.dump();
    EXPECT_TRUE(row["spotless"] || !row["exact"]) << row.dump();
  }
}

INSTANTIATE_TEST_SUITE_P(Suites, Seeded, testing::Range(std::size_t{0}, all_suites().size()));

/// Parses a line of regressions.txt.
Shot shot_of(const std::string& line) {
  std::istringstream text(line);
  std::vector<glm::dvec3> vectors;
  int k = 3;
  for (std::string word; text >> word; ++k) {
    if (k == 3) vectors.emplace_back(), k = 0;
    vectors.back()[k] = std::strtod(word.c_str(), nullptr);
  }
  Mesh mesh;
  for (std::size_t i = 2; i + 3 <= vectors.size(); i += 3) {
    mesh.push_back({vectors[i], vectors[i + 1], vectors[i + 2]});
  }
  return {std::make_shared<const Mesh>(mesh), vectors.at(0), {vectors.at(1)}};
}

// regressions.txt has one minimised case of a former error per line.
TEST(Regressions, VerdictsOfExactSubjectsAreTheTruth) {
  std::ifstream file(RAYGATE_REGRESSIONS);
  std::vector<Shot> shots;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    shots.push_back(shot_of(line));
    ASSERT_EQ(shots.back().tests(), 1u) << line;
  }
  ASSERT_FALSE(shots.empty());
  for (const SubjectKind& kind : all_subjects()) {
    if (!kind.exact) continue;
    Answers answers;
    kind.make()->run(shots, answers);
    for (std::size_t i = 0; i < shots.size(); ++i) {
      const Truth truth = find_truth(shots[i]);
      EXPECT_EQ(answers.tests[i].hit, truth.verdicts[0].hit) << kind.name << ", case " << i;
      EXPECT_EQ(answers.nearest[i], truth.nearest(0)) << kind.name << ", case " << i;
    }
  }
}

// A subject's reported failures have the format of regressions.txt.
TEST(Regressions, FailuresAreSuchLines) {
  auto subjects = all_subjects();
  std::erase_if(subjects, [](const SubjectKind& kind) { return kind.name != "Woop 2013"; });
  const Row row = run(all_suites()[1], subjects, 20000, 1).at(0);
  ASSERT_FALSE(row["failures"].empty());
  for (const std::string line : row["failures"]) {
    const Shot shot = shot_of(line);
    Answers answers;
    subjects[0].make()->run({&shot, 1}, answers);
    const Truth truth = find_truth(shot);
    bool is_wrong = answers.nearest[0] != truth.nearest(0);
    for (std::size_t i = 0; i < truth.verdicts.size(); ++i) {
      is_wrong = is_wrong || answers.tests[i].hit != truth.verdicts[i].hit;
    }
    EXPECT_TRUE(is_wrong) << line;
  }
}

// The engines pass the public tests; some other hit tests do not.
TEST(Watertight, EnginesAre) {
  bool others_are = true;
  for (const Row& row : watertight_rows(128, 1)) {
    const bool passes =
        row["escapes"] == 0 && (row["double_hits"].is_null() || row["double_hits"] == 0);
    EXPECT_TRUE(passes || !row["exact"]) << row.dump();
    others_are = others_are && passes;
  }
  EXPECT_FALSE(others_are);
}

}  // namespace
}  // namespace raygate::lab
