// The ray core behind AXI with an exact unit, Clocks = 11 and the default data width resolves all
// doubts of a picture itself.
#include "Vray_core_axi_exact.h"
#include "sim/test/ray_core/axi_bench.h"

namespace raygate {
namespace {

class ExactRayCoreAxiTest : public test::AxiBench<Vray_core_axi_exact> {};

TEST_F(ExactRayCoreAxiTest, EndsAreTheReferences) {
  SCOPED_TRACE("seed " + std::to_string(test::kSeed));
  EXPECT_EQ(read(RAYGATE_CAPABILITY), 1u | 4 << 8 | 1 << 12 | 4 << 16 | 11 << 20 |
                                          RAYGATE_CAPABILITY_GENERATOR | RAYGATE_CAPABILITY_BUFFER |
                                          RAYGATE_CAPABILITY_STREAM);
  look();
  draw(30);
  trace(300, 1'000'000);
  ReferenceCore reference(ReferenceCore::kStackDepth, true);
  for (const CoreResult& result : results_) EXPECT_EQ(result.kind, CoreResult::Kind::kEnd);
  for (const auto& [pixel, end] : ends_) {
    const CoreRay ray{.ray = {kEye, kGrid.direction(static_cast<std::uint16_t>(pixel),
                                                    static_cast<std::uint16_t>(pixel >> 16))}};
    std::vector<CoreResult> expected;
    reference.trace(image_.lines(), {&ray, 1}, expected);
    ASSERT_EQ(end.found, expected.back().found) << pixel;
    ASSERT_EQ(end.triangle, end.found ? expected.back().triangle : 0) << pixel;
  }
  EXPECT_GT(read(RAYGATE_COUNTERS_EXACT), 10'000u);
}

}  // namespace
}  // namespace raygate
