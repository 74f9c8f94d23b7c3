// Tests the files about a ray core that ./render writes.
#include "host/app/test/render_run.h"

namespace raygate {
namespace {

class CoreFiles : public Render {
 protected:
  Outcome run_core(const std::vector<std::string>& more) const {
    return run(joined(
        {kCornell, "--unit", "core", "--arith", "behavioural", "--size", "16x16", "-o", "out"},
        more));
  }
};

TEST_F(CoreFiles, TheMemoryImage) {
  const Outcome dumped = run_core({"--dump-image", "image"});
  ASSERT_EQ(dumped.status, 0) << dumped.err;
  EXPECT_EQ(dumped.out, "wrote image, 42 lines, relative to 0,0,0\n");
  EXPECT_EQ(folder_.list(), std::vector{"image"s}) << "nothing is rendered";
  EXPECT_EQ(folder_.read("image").size(), 42u * 64u);
  folder_.write("far.obj", "v 1000.5 0 0\nv 1001.5 0 0\nv 1000.5 1 0\nf 1 2 3\n");
  const Outcome far = run({"far.obj", "--unit", "core", "--dump-image", "far"});
  EXPECT_TRUE(contains(far.out, ", relative to 100")) << far.out;
}

TEST_F(CoreFiles, NoImageThatCannotBeWrittenIsBegun) {
  EXPECT_EQ(run_core({"--dump-image", "absent/image"}).status, 2);
  EXPECT_TRUE(folder_.list().empty());
}

TEST_F(CoreFiles, CoresBehindOneMemoryDrawTheSamePicture) {
  const std::string scene =
      RAYGATE_SCENES "/paper.obj";  // at this size it has doubts and near ties
  render({scene, "--size", "32x24", "--engine", "cpu", "--spp", "1", "-o", "cpu"});
  std::vector<double> clocks;
  for (const char* cores : {"1", "3"}) {
    render({scene, "--size", "32x24", "--spp", "1", "--unit", "core", "--arith", "behavioural",
            "--threads", "1", "--cores", cores, "-o", "core"});
    expect_same_pictures("cpu", "core");
    clocks.push_back(stats_.at("clocks"));
    EXPECT_GT(stats_.at("edge_doubts"), 0);
    EXPECT_GT(stats_.at("depth_doubts"), 0);
    EXPECT_GT(stats_.at("exact_clocks"), 0);
    EXPECT_EQ(stats_.at("host_decisions"), 0);
  }
  EXPECT_LT(clocks[1], clocks[0]);
}

TEST_F(CoreFiles, ABoardDrawsTheSamePicture) {
  const std::string scene = RAYGATE_SCENES "/paper.obj";
  render({scene, "--size", "32x24", "--engine", "cpu", "--spp", "1", "-o", "cpu"});
  render(
      {scene, "--size", "32x24", "--spp", "1", "--unit", "board", "--threads", "1", "-o", "board"});
  expect_same_pictures("cpu", "board");
  EXPECT_GT(stats_.at("clocks"), 11 * stats_.at("unit_tests").get<int>());
}

TEST_F(CoreFiles, APortThatIsNoneIsAnInputError) {
  const Outcome outcome =
      run({kCornell, "--unit", "board", "--board-port", "/dev/null", "-o", "out"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, "/dev/null: expected a serial port"));
}

TEST_F(CoreFiles, TheWaveOfAPixelsRay) {
  folder_.write("link.vcd.unfinished", "of another program");
  std::filesystem::create_symlink("pixel.vcd", folder_.path() / "link.vcd");
  const Outcome outcome = run_core({"--trace", "8,8=link.vcd"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "the ray of pixel 8,8 hits triangle "));
  EXPECT_EQ(folder_.list(), (std::vector{"link.vcd"s, "link.vcd.unfinished"s, "pixel.vcd"s}));
  EXPECT_EQ(folder_.read("link.vcd.unfinished"), "of another program");
  EXPECT_TRUE(std::filesystem::is_symlink(folder_.path() / "link.vcd"));
  EXPECT_TRUE(contains(folder_.read("pixel.vcd"), "ray_core"));
}

}  // namespace
}  // namespace raygate
