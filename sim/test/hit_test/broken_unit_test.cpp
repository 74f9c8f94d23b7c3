// Does the comparison with the twin notice a unit that is wrong in one place? hit_decision is
// broken so that an edge test exactly on its error bound counts as sure (CMakeLists.txt has the
// patch).
#include <gtest/gtest.h>

#include <stdexcept>

#include "Vhit_test_array_broken.h"
#include "host/intersect/unit/burst_unit.h"
#include "host/intersect/unit/reference_burst_unit.h"
#include "sim/array_model.h"
#include "sim/random_bursts.h"

namespace raygate {
namespace {

constexpr int kTests = 20'000;

TEST(BrokenUnitTest, IsNoticed) {
  const BurstBatch batch = RandomBursts(1).make(kTests);
  BurstResults expected, got;
  ReferenceBurstUnit().run(batch.bundles, expected);
  ArrayModel<Vhit_test_array_broken> broken(1);
  broken.start(batch.bundles);
  broken.finish(got);
  EXPECT_THROW(require_same(batch.bundles, got, expected), std::exception);
}

TEST(BrokenUnitTest, SoundOnePassesTheSameTests) {
  const BurstBatch batch = RandomBursts(1).make(kTests);
  BurstResults expected, got;
  ReferenceBurstUnit().run(batch.bundles, expected);
  RtlBurstUnit(1).run(batch.bundles, got);
  EXPECT_NO_THROW(require_same(batch.bundles, got, expected));
}

}  // namespace
}  // namespace raygate
