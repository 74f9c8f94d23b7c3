// Cases that something once got wrong, minimised: one line each in regressions.txt.
#include <gtest/gtest.h>

#include <fstream>

#include "host/lab/stress/oracle.h"
#include "host/lab/stress/shot.h"
#include "host/lab/stress/subjects.h"

namespace raygate::lab {
namespace {

TEST(Regressions, VerdictsOfExactSubjectsAreTheTruth) {
  std::ifstream file(RAYGATE_REGRESSIONS);
  std::vector<Shot> shots;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    shots.push_back(shot_of(case_from(line)));
  }
  ASSERT_FALSE(shots.empty());
  for (const SubjectKind& kind : all_subjects()) {
    if (!kind.exact) continue;
    const auto subject = kind.make();
    Answers answers;
    subject->run(shots, answers);
    auto answer = answers.tests.cbegin();
    for (std::size_t i = 0; i < shots.size(); ++i) {
      const Truth truth = find_truth(shots[i]);
      for (const Verdict& verdict : truth.verdicts) {
        EXPECT_EQ((answer++)->hit, verdict.hit) << kind.name << ", case " << i;
      }
      EXPECT_EQ(answers.nearest[i], truth.nearest(0)) << kind.name << ", case " << i;
    }
  }
}

}  // namespace
}  // namespace raygate::lab
