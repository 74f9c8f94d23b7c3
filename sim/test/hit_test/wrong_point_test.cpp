// The picture is made of the unit's numbers: a unit whose P is wrong by 2^-12, or whose products
// are too small, makes another one (CMakeLists.txt has the patches), unless the host computes every
// P.
#include <gtest/gtest.h>

#include <cmath>

#include "Vhit_test_array_truncated.h"
#include "Vhit_test_array_wrong_point.h"
#include "host/intersect/check_intersector.h"
#include "host/intersect/cpu/cpu_intersector.h"
#include "host/light/test/light_scenes.h"
#include "sim/array_model.h"
#include "sim/rtl_burst_unit.h"

namespace raygate {
namespace {

template <class Model>
class BrokenUnit : public BurstUnit {
 public:
  void run(std::span<const RayBundle> batch, BurstResults& results) override {
    start(batch);
    finish(results);
  }
  void start(std::span<const RayBundle> batch) override { model_->start(batch); }
  void finish(BurstResults& results) override { model_->finish(results); }
  [[nodiscard]] BurstCounters counters() const override { return model_->counters(); }

 private:
  std::unique_ptr<BurstModel> model_ = std::make_unique<ArrayModel<Model>>(1);
};
using WrongPointUnit = BrokenUnit<Vhit_test_array_wrong_point>;
using TruncatingUnit = BrokenUnit<Vhit_test_array_truncated>;

template <class Unit, class... Arguments>
std::unique_ptr<Intersector> intersector_of(const Bvh& bvh, Arguments... arguments) {
  return std::make_unique<UnitIntersector>(
      bvh, std::make_unique<PipelineHitTester>(std::make_unique<Unit>(arguments...)));
}

class WrongPointTest : public testing::Test {
 protected:
  Film film(const IntersectorFactory& intersector, float point_error, int scale = 1) {
    RenderSettings options = test::light(IntegratorKind::kWhitted, 24 * scale, 18 * scale, 1);
    options.channels.position = true;
    options.point_error = point_error;
    RenderStats stats;
    return render(scene_, bvh_, camera_, options, intersector, stats);
  }

  Scene scene_ = test::everything();
  Bvh bvh_{scene_};
  Camera camera_ = test::camera_at({0.6, 0.4, 5.5}, {0, -0.3, 0}, 55.0, 4.0 / 3.0);
  IntersectorFactory sound_ = [this] { return intersector_of<RtlBurstUnit>(bvh_, 1); };
  IntersectorFactory wrong_ = [this] { return intersector_of<WrongPointUnit>(bvh_); };
  IntersectorFactory truncating_ = [this] { return intersector_of<TruncatingUnit>(bvh_); };
};

TEST_F(WrongPointTest, ChangesThePicture) {
  const Film sound = film(sound_, kPointError), wrong = film(wrong_, kPointError);
  ASSERT_EQ(sound.primitive, wrong.primitive) << "it decides as it should";
  std::size_t seen = 0, moved = 0, deeper = 0, brighter = 0;
  for (std::size_t i = 0; i < sound.primitive.size(); ++i) {
    if (sound.primitive[i] == kNoPrimitive) continue;
    ++seen;
    moved += sound.position[i] != wrong.position[i];
    deeper += sound.depth[i] != wrong.depth[i];
    brighter += sound.color[i] != wrong.color[i];
    EXPECT_NEAR(wrong.depth[i] / sound.depth[i], 1.0, 0x1p-11);
  }
  EXPECT_GT(moved, seen / 2);
  EXPECT_GT(deeper, seen / 2);
  EXPECT_GT(brighter, seen / 4);
}

// Products that lack their low columns move points, and decide: rays go past triangles that they
// hit.
TEST_F(WrongPointTest, TruncatedProductsShowInThePicture) {
  const Film sound = film(sound_, kPointError, 8), wrong = film(truncating_, kPointError, 8);
  std::size_t moved = 0, other = 0;
  for (std::size_t i = 0; i < sound.primitive.size(); ++i) {
    moved += sound.color[i] != wrong.color[i];
    other += sound.primitive[i] != wrong.primitive[i];
  }
  EXPECT_GT(moved, sound.color.size() / 4);
  EXPECT_GT(other, 0u);
}

TEST_F(WrongPointTest, IsOfNoConsequenceWhereTheHostComputesEveryPoint) {
  const Film sound = film(sound_, 0.0f), wrong = film(wrong_, 0.0f);
  EXPECT_TRUE(test::same(sound, wrong));
  EXPECT_EQ(sound.position, wrong.position);
}

TEST_F(WrongPointTest, IsNoticedByTheCheck) {
  const IntersectorFactory check = [this] {
    return std::make_unique<CheckIntersector>(bvh_, wrong_(),
                                              std::make_unique<CpuIntersector>(bvh_));
  };
  EXPECT_THROW((void)film(check, kPointError), IntersectorMismatch);
}

}  // namespace
}  // namespace raygate
