// Cases that something once got wrong, minimised: one line each in regressions.txt.
#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <sstream>

#include "host/bench/stress/oracle.h"
#include "host/bench/stress/variants.h"

namespace raygate::stress {
namespace {

TEST(Regressions, EngineVerdictsAreTheTruth) {
  std::ifstream file(RAYGATE_REGRESSIONS);
  std::vector<Shot> shots;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    const auto read = [&] {
      glm::vec3 v;
      for (int k = 0; k < 3; ++k) {
        std::uint32_t word = 0;
        EXPECT_TRUE(words >> std::hex >> word) << line;
        v[k] = std::bit_cast<float>(word);
      }
      return v;
    };
    Shot shot;
    shot.origin = read();
    shot.directions = {read()};
    auto mesh = std::make_shared<Mesh>();
    const glm::vec3 a = read(), b = read(), c = read();
    mesh->triangles = {{a, b, c}};
    shot.mesh = mesh;
    shots.push_back(shot);
  }
  ASSERT_FALSE(shots.empty());
  for (const VariantKind& kind : engine_variants()) {
    const auto variant = kind.make();
    Answers answers;
    variant->run(shots, answers);
    for (std::size_t i = 0; i < shots.size(); ++i) {
      const Truth truth = find_truth(shots[i]);
      EXPECT_EQ(answers.tests[i].hit, truth.verdicts[0].hit) << kind.name << ", case " << i;
      EXPECT_EQ(answers.nearest[i], truth.nearest[0]) << kind.name << ", case " << i;
    }
  }
}

}  // namespace
}  // namespace raygate::stress
