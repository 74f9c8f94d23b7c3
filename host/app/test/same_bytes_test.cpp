// A picture has the same bytes for every engine, number of threads and crop.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "host/app/test/render_run.h"
#include "host/base/input.h"
#include "host/base/vectors.h"
#include "host/film/test/exr_reader.h"

namespace raygate {
namespace {

/// Returns the repository's scene files, OBJ files that have no scene file, and a generated sphere.
std::vector<std::string> all_scenes() {
  std::vector<std::string> scenes{RAYGATE_MADE_SCENES "/sphere.obj"};
  for (const auto& entry : fs::directory_iterator(RAYGATE_SCENES)) {
    const fs::path& file = entry.path();
    const bool is_obj =
        file.extension() == ".obj" && !fs::exists(fs::path(file).replace_extension(".json"));
    if (is_obj || file.extension() == ".json") scenes.push_back(file.string());
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

class EveryScene : public Render, public testing::WithParamInterface<std::string> {};

TEST_P(EveryScene, EnginesGiveTheSameBytes) {
  const auto render_by = [&](const std::string& name, const std::vector<std::string>& engine) {
    render(joined({GetParam(), "--size", "64x48", "--spp", "1", "-o", name}, engine));
    expect_same_pictures("cpu", name);
  };
  render_by("cpu", {"--engine", "cpu"});
  EXPECT_GT(stats_.at("hits"), 0) << "an empty picture shows nothing";
  EXPECT_EQ(stats_.at("clocks"), 0);
  render_by("rtl", {"--engine", "rtl"});
  EXPECT_GT(stats_.at("clocks"), 0);
  render_by("lanes", {"--lanes", "4"});
  render_by("serial", {"--unit", "serial", "--engine", "model"});
  render_by("core", {"--unit", "core", "--arith", "behavioural"});
}

TEST_P(EveryScene, VectorsGiveTheSameBytes) {
  const std::string& scene = GetParam();
  for (const Vectors vectors : machine_vectors()) {
    const std::string name(name_of(vectors));
    setenv("RAYGATE_VECTORS", name.c_str(), 1);
    render({scene, "--size", "64x48", "--engine", "cpu", "--spp", "1", "-o", name});
    unsetenv("RAYGATE_VECTORS");
    expect_same_pictures("baseline", name);
  }
}

TEST_P(EveryScene, CheckFindsNoDifference) {
  const std::string& scene = GetParam();
  render({scene, "--size", "80x60", "--engine", "check"});
  EXPECT_GT(stats_.at("plane_tests"), 0) << "nothing was compared";
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(all_scenes()), [](const auto& info) {
  std::string name = fs::path(info.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
});

/// A room with instances of a glass ball, a light and a teapot. One of the teapots is mirrored, two
/// coincide and two intersect.
class InstancedScene : public Render {
 protected:
  InstancedScene() {
    folder_.write("lamp.mtl", "newmtl lamp\nKe 9 8 6\n");
    folder_.write("lamp.obj",
                  "mtllib lamp.mtl\nusemtl lamp\nv 0 0 0\nv 90 0 0\nv 0 0 90\nf 1 2 3\n");
    folder_.write("glass.mtl", "newmtl glass\nillum 7\nNi 1.5\nd 0\n");
    std::string ball = "mtllib glass.mtl\nusemtl glass\n", line;
    std::ifstream sphere(RAYGATE_MADE_SCENES "/sphere.obj");
    while (std::getline(sphere, line)) {
      if (line.starts_with("v ") || line.starts_with("f ")) ball += line + "\n";
    }
    folder_.write("ball.obj", ball);
    folder_.write("room.json", R"({"obj": ")" RAYGATE_SCENES R"(/cornell.obj",
        "camera": {"eye": [278, 273, -800], "target": [278, 273, 0], "fov": 39},
        "instances": [
          {"model": ")" RAYGATE_SCENES R"(/teapot.obj", "places": [
            [30, 0, 0, 150, 0, 30, 0, 0, 0, 0, 30, 90],
            [-30, 0, 0, 150, 0, 30, 3, 120, 0, 0, 30, 90],
            [21, 0, 21, 400, 5, 40, 0, 10, -21, 0, 21, 150],
            [21, 0, 21, 420, 5, 40, 0, 10, -21, 0, 21, 160],
            [21, 0, 21, 420, 5, 40, 0, 10, -21, 0, 21, 160],
            [10, 20, 5, 300, -20, 10, 5, 300, 0, 3, 20, 250]]},
          {"model": "lamp.obj", "places": [[100, 400, 100], [300, 420, 200]]},
          {"model": "ball.obj", "places": [
            [60, 0, 0, 350, 0, 60, 0, 420, 0, 0, 60, 150],
            [0, 0, 50, 170, 50, 0, 0, 250, 0, 50, 0, 120]]}]})");
  }
};

TEST_F(InstancedScene, IsTheSameKeptAndWrittenOut) {
  for (const char* integrator : {"primary", "whitted", "path"}) {
    const auto render_as = [&](const char* name, const std::vector<std::string>& more) {
      render(joined({"room.json", "--size", "96x96", "--engine", "cpu", "--spp", "4",
                     "--integrator", integrator, "--channels", "P,objectId", "-o", name},
                    more));
      expect_same_pictures("written", name);
    };
    render_as("written", {"--instances", "write"});
    render_as("kept", {"--instances", "keep"});
    render_as("threads", {"--instances", "keep", "--threads", "3"});
    render_as("auto", {});
  }
}

TEST_F(InstancedScene, IsTheSameForEveryEngine) {
  render({"room.json", "--size", "40x40", "--engine", "cpu", "--spp", "1", "--instances", "write",
          "-o", "cpu"});
  const json written = stats_;
  for (const char* engine : {"rtl", "model", "check"}) {
    render({"room.json", "--size", "40x40", "--engine", engine, "--spp", "1", "--instances", "keep",
            "-o", engine});
    EXPECT_EQ(stats_.at("triangles"), written.at("triangles"));
    expect_same_pictures("cpu", engine);
  }
}

/// Returns the commands in scenes/README.md that write a picture of scenes/gallery.
std::vector<std::string> gallery_commands() {
  const std::string text = read_file(RAYGATE_SCENES "/README.md");
  const std::regex command("`\\./render ([^`]*-o scenes/gallery/[^`]*)`");
  std::vector<std::string> commands;
  for (std::sregex_iterator i(text.begin(), text.end(), command), end; i != end; ++i) {
    commands.push_back((*i)[1]);
  }
  return commands;
}

class Gallery : public Render, public testing::WithParamInterface<std::string> {};

/// Compares only a crop, because a crop equals its part of the whole picture.
TEST_P(Gallery, PictureIsWhatItsCommandMakes) {
  std::istringstream words(GetParam());
  std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
  ASSERT_GE(arguments.size(), 3u);
  const std::string picture = arguments.back();
  arguments.back() = (folder_.path() / "made.png").string();
  png_image stored_size{};
  const std::vector<std::uint8_t> stored =
      decode_png(read_file(RAYGATE_SCENES "/../" + picture), &stored_size);
  constexpr std::size_t kSide = 16;
  const std::size_t x0 = stored_size.width / 3, y0 = stored_size.height / 2;
  std::string crop;
  for (const std::size_t edge : {x0, y0, x0 + kSide, y0 + kSide}) {
    crop.append(crop.empty() ? "" : ",").append(std::to_string(edge));
  }
  arguments.insert(arguments.end(), {"--crop", crop});
  const Outcome outcome = run_program({.arguments = arguments, .folder = RAYGATE_SCENES "/.."});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<std::uint8_t> made = decode_png(folder_.read("made.png"));
  ASSERT_EQ(made.size(), 3 * kSide * kSide);
  for (std::size_t i = 0; i < made.size(); ++i) {
    const std::size_t x = x0 + i / 3 % kSide, y = y0 + i / 3 / kSide;
    ASSERT_EQ(made[i], stored[3 * (y * stored_size.width + x) + i % 3]) << x << " " << y;
  }
  EXPECT_GT(std::set<std::uint8_t>(made.begin(), made.end()).size(), 3u) << "nothing to be seen";
}

INSTANTIATE_TEST_SUITE_P(Readme, Gallery, testing::ValuesIn(gallery_commands()),
                         [](const auto& info) { return fs::path(info.param).stem().string(); });

using Variants = Render;

TEST_F(Variants, DrawTheirOwnPictures) {
  const auto picture = [&](const std::string& name, const std::vector<std::string>& words) {
    render(joined({kCornell, "--size", "64x48", "--spp", "1", "-o", name + ".png"}, words));
    return folder_.read(name + ".png");
  };
  const std::string plain = picture("plain", {"--engine", "model"});
  EXPECT_TRUE(picture("binary32", {"--variant", "binary32"}) == plain);
  EXPECT_TRUE(picture("serial", {"--variant", "serial"}) ==
              picture("unit", {"--engine", "model", "--unit", "serial"}));
  EXPECT_FALSE(picture("raw", {"--variant", "e8p9-raw"}) == plain);
  EXPECT_EQ(stats_["variant"], "e8p9-raw");
  EXPECT_EQ(stats_["engine"], "model");
  // In formats with few digits, exact arithmetic decides more tests.
  (void)picture("few", {"--variant", "e8p12"});
  EXPECT_GT(stats_["exact_inside"], 0);
}

TEST_F(Render, ThreadsChangeNoByte) {
  for (const char* threads : {"1", "2", "8"}) {
    render({kCornell, "--size", "100x75", "--threads", threads, "-o", threads});
    EXPECT_EQ(stats_.at("threads"), std::stoi(threads));
  }
  expect_same_pictures("1", "2");
  expect_same_pictures("1", "8");
}

// The paths scatter randomly and also pass through glass.
TEST_F(Render, EnginesGiveTheSameBytesOfPaths) {
  for (const std::string scene : {"cornell", "paper"}) {
    const auto render_by = [&](const std::vector<std::string>& engine) {
      render(joined({RAYGATE_SCENES "/" + scene + ".obj", "--integrator", "path", "--size", "24x18",
                     "--spp", "2"},
                    engine));
    };
    render_by({"-o", "cpu", "--engine", "cpu"});
    EXPECT_GT(stats_.at("shadow_rays"), 0);
    render_by({"-o", "rtl", "--engine", "rtl"});
    EXPECT_GT(stats_.at("clocks"), 0);
    expect_same_pictures("cpu", "rtl");
    render_by({"-o", "serial", "--engine", "model", "--unit", "serial"});
    expect_same_pictures("cpu", "serial");
  }
}

// Tests rays with and without a common origin.
TEST_F(Render, EnginesGiveTheSameBytesThroughAnyLens) {
  for (const std::string projection : {"perspective", "orthographic"}) {
    for (const std::string aperture : {"0", "20"}) {
      for (const std::string engine : {"cpu", "rtl"}) {
        render({kCornell, "--projection", projection, "--aperture", aperture, "--size", "24x18",
                "--spp", "2", "-o", engine, "--engine", engine});
        EXPECT_GT(stats_.at("hits"), 0);
      }
      expect_same_pictures("cpu", "rtl");
      const ExrReader exr(folder_.read("cpu.exr"));
      EXPECT_EQ(exr.text("projection"), projection == "perspective" ? "(none)" : projection);
      EXPECT_EQ(exr.text("aperture"), aperture == "0" ? "(none)" : aperture);
    }
  }
}

TEST_F(Render, SavingInBetweenChangesNothingInTheEnd) {
  const std::vector<std::string> scene{kCornell, "--size", "96x96", "--engine",
                                       "cpu",    "--spp",  "16"};
  render(joined(scene, {"-o", "plain"}));
  render(joined(scene, {"-o", "saving", "--save-every", "0.1"}));
  expect_same_pictures("plain", "saving");
}

TEST_F(Render, CropIsThatPartOfTheWhole) {
  render({kCornell, "--size", "90x60", "--engine", "cpu", "--spp", "1", "-o", "whole.exr"});
  render({kCornell, "--size", "90x60", "--engine", "cpu", "--spp", "1", "--crop", "31,7,58,44",
          "-o", "part.exr"});
  EXPECT_EQ(stats_.at("window"), (json{31, 7, 58, 44}));
  EXPECT_EQ(stats_.at("camera_rays"), 27 * 37);
  ExrReader whole(folder_.read("whole.exr"));
  ExrReader part(folder_.read("part.exr"));
  const auto expect_part = [&]<typename T>(const char* name, Imf::PixelType type, T) {
    const std::vector<T> all = whole.read<T>(name, type);
    const std::vector<T> some = part.read<T>(name, type);
    ASSERT_EQ(all.size(), 90u * 60u);
    ASSERT_EQ(some.size(), 27u * 37u);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const std::size_t place = (i / 27 + 7) * 90 + i % 27 + 31;
      ASSERT_EQ(std::bit_cast<std::uint32_t>(some[i]), std::bit_cast<std::uint32_t>(all[place]))
          << name << " " << i;
    }
  };
  for (const char* name : {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z"}) {
    expect_part(name, Imf::FLOAT, float{});
  }
  expect_part("id", Imf::UINT, std::uint32_t{});
}

}  // namespace
}  // namespace raygate
