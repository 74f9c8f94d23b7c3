// Contents of the pictures: channels, colours, cameras and names.
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "host/app/test/render_run.h"
#include "host/film/test/exr_reader.h"

namespace raygate {
namespace {

TEST_F(Render, OnlyASceneGivesBothPicturesHere) {
  const Outcome outcome = render({kCornell});
  EXPECT_EQ(folder_.list(), (std::vector<std::string>{"cornell.exr", "cornell.png", "stats.json"}));
  EXPECT_TRUE(contains(outcome.out, "\nwrote    cornell.exr, cornell.png in "));
  EXPECT_EQ(outcome.err, "");
}

TEST_F(Render, ChannelsOnDemand) {
  render({kCornell, "--size", "40x30", "--engine", "cpu", "-o", "plain.exr"});
  const json uncounted = stats_;
  render({kCornell, "--size", "40x30", "--engine", "cpu", "--channels",
          "P,Albedo,objectId,tests,doubts", "-o", "all.exr"});
  ExrReader plain(folder_.read("plain.exr")), all(folder_.read("all.exr"));
  EXPECT_TRUE(plain.read<float>("P.X", Imf::FLOAT).empty());
  EXPECT_TRUE(plain.read<float>("R", Imf::FLOAT) == all.read<float>("R", Imf::FLOAT));
  for (const char* name : {"P.X", "P.Y", "P.Z", "Albedo.R", "Albedo.G", "Albedo.B"}) {
    EXPECT_EQ(all.read<float>(name, Imf::FLOAT).size(), 40u * 30u) << name;
  }
  const auto objects = all.read<std::uint32_t>("objectId", Imf::UINT);
  const std::set<std::uint32_t> seen(objects.begin(), objects.end());
  EXPECT_GE(seen.size(), 6u) << "the box has 8 objects";
  const auto tests = all.read<std::uint32_t>("tests", Imf::UINT);
  const auto doubts = all.read<std::uint32_t>("doubts", Imf::UINT);
  const auto sum = [](const std::vector<std::uint32_t>& values) {
    return std::accumulate(values.begin(), values.end(), std::uint64_t{0});
  };
  EXPECT_EQ(sum(tests), stats_.at("tests"));
  EXPECT_EQ(stats_.at("tests"), uncounted.at("tests")) << "counting by pixel changes what is done";
  EXPECT_EQ(sum(doubts), stats_.at("edge_doubts"));
}

TEST_F(Render, FalseColoursOfAnyChannel) {
  const Outcome outcome =
      render({kCornell, "--size", "40x30", "--engine", "cpu", "-o", "a.exr", "--false-colour",
              "tests=t.png", "--false-colour", "Z=z.png", "--false-colour", "objectId=o.png"});
  EXPECT_EQ(stats_.at("pictures"), (json{"a.exr", "t.png", "z.png", "o.png"}));
  for (const char* name : {"t.png", "z.png", "o.png"}) {
    const std::vector<std::uint8_t> pixels = decode_png(folder_.read(name));
    EXPECT_EQ(pixels.size(), 40u * 30u * 3u);
    EXPECT_GT(std::set<std::uint8_t>(pixels.begin(), pixels.end()).size(), 5u) << name;
  }
  EXPECT_TRUE(contains(outcome.out, "scale    tests: 0 (dark violet) to "));
  EXPECT_TRUE(contains(outcome.out, "scale    Z: "));
}

TEST_F(Render, ExposureChangesThePngAlone) {
  render({kCornell, "--size", "40x30", "--engine", "cpu", "-o", "a"});
  render({kCornell, "--size", "40x30", "--engine", "cpu", "-o", "b", "--exposure", "1"});
  render({kCornell, "--size", "40x30", "--engine", "cpu", "-o", "c", "--tone", "filmic"});
  EXPECT_TRUE(folder_.read("a.exr") == folder_.read("b.exr"));
  EXPECT_TRUE(folder_.read("a.exr") == folder_.read("c.exr"));
  EXPECT_FALSE(decode_png(folder_.read("a.png")) == decode_png(folder_.read("c.png")));
  const auto before = decode_png(folder_.read("a.png")), after = decode_png(folder_.read("b.png"));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_GE(after[i], before[i]);
    EXPECT_TRUE(after[i] > before[i] || before[i] == 0 || before[i] == 255);
  }
}

TEST_F(Render, AViewSaysWhatToTypeForIt) {
  folder_.write("box.obj",
                "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 1 .5 3\n"
                "f 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  const auto picture = [&](const std::vector<std::string>& more, const std::string& name) {
    return render(joined({"box.obj", "--size", "40x30", "--engine", "cpu", "-o", name}, more)).out;
  };
  const std::string said = picture({}, "a.png");
  EXPECT_TRUE(contains(said, "\nview     --view 33,24 --up y (usual in the format); --camera "));
  EXPECT_EQ(picture({"--view", "33,24", "--up", "y"}, "b.png").find("usual"), std::string::npos);
  EXPECT_TRUE(folder_.read("a.png") == folder_.read("b.png"));
  EXPECT_EQ(picture({"--camera", "9,9,9,0,0,0"}, "c.png").find("\nview "), std::string::npos);
}

TEST_F(Render, AFirstLookFromAboveStandsOnAGround) {
  folder_.write("ball.obj",
                "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
                "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n");
  const auto ground = [&](const std::vector<std::string>& more) {
    render(joined({"ball.obj", "--size", "40x30", "--engine", "cpu", "-o", "a.exr"}, more));
    EXPECT_EQ(stats_.at("triangles"), 8) << "of the file";
    const auto ids = ExrReader(folder_.read("a.exr")).read<std::uint32_t>("id", Imf::UINT);
    return std::ranges::find_if(ids, [](auto id) { return id == 8 || id == 9; }) != ids.end();
  };
  EXPECT_TRUE(ground({}));
  const ExrReader reader(folder_.read("a.exr"));
  EXPECT_EQ(reader.text("ground"), "on");
  EXPECT_FALSE(ground({"--ground", "off"}));
  EXPECT_FALSE(ground({"--view", "33,-10"})) << "from below";
  EXPECT_FALSE(ground({"--camera", "3,3,3,0,0,0"}));
  EXPECT_TRUE(ground({"--camera", "3,3,3,0,0,0", "--ground", "on"}));
}

TEST_F(Render, IdsAreTheNumbersOfFacesInTheFile) {
  // The first face has no area; the second is a square, which also has an instance elsewhere.
  folder_.write("flat.obj",
                "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 3 -1 0\nf 1 2 5\nf 1 2 3 4\n");
  folder_.write("flat.json", R"({"instances": [{"model": "flat.obj", "places": [[4, 0, 0]]}]})");
  for (const char* how : {"keep", "write"}) {
    render({"flat.json", "--size", "40x30", "--engine", "cpu", "--instances", how, "--ground",
            "off", "--camera", "2,0,9,2,0,0", "--up", "y", "-o", "a.exr"});
    const auto ids = ExrReader(folder_.read("a.exr")).read<std::uint32_t>("id", Imf::UINT);
    EXPECT_EQ(std::set<std::uint32_t>(ids.begin(), ids.end()),
              (std::set<std::uint32_t>{1, 2, 4, 5, 0xFFFF'FFFF}))
        << how;
  }
}

TEST_F(Render, AnExrSaysHowItIsMadeAgain) {
  render({kCornell, "--size",       "24x20", "--engine",     "cpu",          "--spp",
          "3",      "--depth",      "2",     "--fov",        "41.1",         "--filter",
          "box",    "--integrator", "path",  "--seed",       "11",           "--point-error",
          "0.001",  "-o",           "a.exr", "--projection", "orthographic", "--aperture",
          "7.5",    "--focus",      "900"});
  const ExrReader reader(folder_.read("a.exr"));
  std::vector<std::string> again = {kCornell, "--size", "24x20", "--engine", "cpu", "-o", "b.exr"};
  for (const char* name : {"integrator", "spp", "filter", "depth", "threshold", "camera", "seed",
                           "projection", "aperture", "focus"}) {
    again.insert(again.end(), {std::string("--") + name, reader.text(name)});
  }
  again.insert(again.end(), {"--point-error", reader.text("pointError")});
  EXPECT_EQ(reader.text("spp"), "3");
  render(again);
  EXPECT_TRUE(folder_.read("a.exr") == folder_.read("b.exr"));
}

TEST_F(Render, CameraIsTakenInTheFilesCoordinates) {
  // A square at z = -5, far from the world's origin; the camera is 10 in front of the square.
  folder_.write("square.obj",
                "v 99999 -1 -5\nv 100001 -1 -5\nv 100001 1 -5\nv 99999 1 -5\nf 1 2 3 4\n");
  render({"square.obj", "--size", "9x9", "--engine", "cpu", "--spp", "1", "--camera",
          "100000,0,5,100000,0,0,20", "-o", "a.exr"});
  ExrReader reader(folder_.read("a.exr"));
  const std::vector<float> depth = reader.read<float>("Z", Imf::FLOAT);
  ASSERT_EQ(depth.size(), 81u);
  EXPECT_EQ(depth[40], 10.0f);
  EXPECT_EQ(reader.read<float>("N.Z", Imf::FLOAT)[40], 1.0f);
  // OpenEXR's camera looks along +z: the square's centre is at (0, 0, 10).
  ASSERT_TRUE(Imf::hasWorldToCamera(reader.header()));
  const Imath::V3f seen = Imath::V3f(100000, 0, -5) * Imf::worldToCamera(reader.header());
  EXPECT_EQ(seen, Imath::V3f(0, 0, 10));
}

TEST_F(Render, FinishedPicturesAreNotCalledPartial) {
  render({kCornell, "--size", "9x9", "--engine", "cpu", "-o", "a"});
  EXPECT_EQ(ExrReader(folder_.read("a.exr")).text("partial"), "(none)");
  EXPECT_FALSE(contains(folder_.read("a.png"), "Comment"));
}

}  // namespace
}  // namespace raygate
