// Whole runs: the same picture whatever the engine, the threads and the crop; what is said on the
// way; statistics; interruption.
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <csignal>
#include <nlohmann/json.hpp>
#include <set>

#include "host/cli/test/program.h"
#include "host/image/test/exr_reader.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const std::string kCornell = RAYGATE_SCENES "/cornell.obj";

class Render : public testing::Test {
 protected:
  /// Runs, expects success, and keeps the statistics in `stats_`.
  Outcome render(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--stats", "stats.json"});
    const Outcome outcome = run_program({.arguments = arguments, .folder = folder_.path()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    stats_ = json::parse(folder_.read("stats.json"), nullptr, false);
    EXPECT_FALSE(stats_.is_discarded());
    return outcome;
  }

  /// Both pictures of two runs are the same bytes.
  void expect_same_pictures(const std::string& a, const std::string& b) const {
    EXPECT_NE(folder_.read(a + ".exr"), "");
    EXPECT_NE(folder_.read(a + ".png"), "");
    EXPECT_TRUE(folder_.read(a + ".exr") == folder_.read(b + ".exr")) << a << " " << b;
    EXPECT_TRUE(folder_.read(a + ".png") == folder_.read(b + ".png")) << a << " " << b;
  }

  ScratchFolder folder_;
  json stats_;
};

/// The OBJ files of the repository and those that the build makes, without ending.
std::vector<std::string> all_scenes() {
  std::vector<std::string> scenes{RAYGATE_MADE_SCENES "/sphere",
                                  RAYGATE_MADE_SCENES "/sphereflake"};
  for (const auto& entry : fs::directory_iterator(RAYGATE_SCENES)) {
    if (entry.path().extension() != ".obj") continue;
    scenes.push_back((entry.path().parent_path() / entry.path().stem()).string());
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

class EveryScene : public Render, public testing::WithParamInterface<std::string> {};

TEST_P(EveryScene, EnginesGiveTheSameBytes) {
  const std::string scene = GetParam() + ".obj";
  render({scene, "--size", "64x48", "--engine", "cpu", "-o", "cpu"});
  const json cpu = stats_;
  EXPECT_GT(cpu.at("hits"), 0) << "an empty picture shows nothing";
  EXPECT_EQ(cpu.at("clocks"), 0);
  render({scene, "--size", "64x48", "--engine", "rtl", "-o", "rtl"});
  EXPECT_GT(stats_.at("clocks"), 0);
  EXPECT_EQ(stats_.at("quotients"), cpu.at("quotients"));
  expect_same_pictures("cpu", "rtl");
  render({scene, "--size", "64x48", "--lanes", "4", "-o", "lanes"});
  expect_same_pictures("cpu", "lanes");
  render({scene, "--size", "64x48", "--unit", "serial", "--engine", "cpu", "-o", "serial"});
  expect_same_pictures("cpu", "serial");
}

TEST_P(EveryScene, CheckFindsNoDifference) {
  const std::string scene = GetParam() + ".obj";
  render({scene, "--size", "80x60", "--engine", "check"});
  EXPECT_GT(stats_.at("plane_tests"), 0) << "nothing was compared";
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(all_scenes()), [](const auto& info) {
  std::string name = fs::path(info.param).filename().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
});

TEST_F(Render, OnlyASceneGivesBothPicturesHere) {
  const Outcome outcome = render({kCornell});
  EXPECT_EQ(folder_.list(), (std::vector<std::string>{"cornell.exr", "cornell.png", "stats.json"}));
  EXPECT_NE(outcome.out.find("wrote   cornell.exr, cornell.png\n"), std::string::npos);
  EXPECT_EQ(outcome.err, "");
}

/// Pixels of a PNG file as 24-bit RGB; compressed bytes are a matter of zlib's version.
std::vector<std::uint8_t> decode_png(const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  return pixels;
}

TEST_F(Render, PictureOfTheReadmeIsWhatItsCommandMakes) {
  fs::copy(RAYGATE_SCENES "/cornell.png", folder_.path() / "stored.png");
  render({kCornell, "--size", "480x360", "-o", "made.png"});
  const std::vector<std::uint8_t> stored = decode_png(folder_.read("stored.png"));
  EXPECT_EQ(stored.size(), 3u * 480u * 360u);
  EXPECT_TRUE(stored == decode_png(folder_.read("made.png")));
}

TEST_F(Render, ThreadsChangeNoByte) {
  for (const char* threads : {"1", "2", "8"}) {
    render({kCornell, "--size", "100x75", "--threads", threads, "-o", threads});
    EXPECT_EQ(stats_.at("threads"), std::stoi(threads));
  }
  expect_same_pictures("1", "2");
  expect_same_pictures("1", "8");
}

TEST_F(Render, RunsAreRepeatable) {
  render({kCornell, "--size", "40x30", "-o", "first"});
  render({kCornell, "--size", "40x30", "-o", "second"});
  expect_same_pictures("first", "second");
}

TEST_F(Render, CropIsThatPartOfTheWhole) {
  render({kCornell, "--size", "90x60", "--engine", "cpu", "-o", "whole.exr"});
  render(
      {kCornell, "--size", "90x60", "--engine", "cpu", "--crop", "31,7,58,44", "-o", "part.exr"});
  EXPECT_EQ(stats_.at("window"), (json{31, 7, 58, 44}));
  EXPECT_EQ(stats_.at("rays"), 27 * 37);
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

TEST_F(Render, CameraIsTakenInTheFilesCoordinates) {
  // A square at z = -5, far from the world's origin, seen from 10 in front of it.
  folder_.write("square.obj",
                "v 99999 -1 -5\nv 100001 -1 -5\nv 100001 1 -5\nv 99999 1 -5\nf 1 2 3 4\n");
  render({"square.obj", "--size", "9x9", "--engine", "cpu", "--camera", "100000,0,5,100000,0,0,20",
          "-o", "a.exr"});
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

TEST_F(Render, LooksStraightDown) {
  folder_.write("floor.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 4 3 2\n");
  render(
      {"floor.obj", "--size", "9x9", "--engine", "cpu", "--camera", "0,3,0,0,0,0", "-o", "a.exr"});
  EXPECT_EQ(ExrReader(folder_.read("a.exr")).read<float>("Z", Imf::FLOAT)[40], 3.0f);
}

TEST_F(Render, ProgressBarOnTerminalsOnly) {
  const std::vector<std::string> arguments{kCornell, "--size", "64x48"};
  const Outcome piped = run_program({.arguments = arguments, .folder = folder_.path()});
  EXPECT_EQ(piped.status, 0);
  EXPECT_EQ(piped.err, "");
  const Outcome shown =
      run_program({.arguments = arguments, .folder = folder_.path(), .terminal = true});
  EXPECT_EQ(shown.status, 0);
  EXPECT_NE(shown.err.find("rendering ["), std::string::npos) << shown.err;
  const std::string erased = "\r\x1b[K";
  ASSERT_GE(shown.err.size(), erased.size());
  EXPECT_EQ(shown.err.substr(shown.err.size() - erased.size()), erased) << "the bar stays";
  std::vector<std::string> quiet = arguments;
  quiet.push_back("--quiet");
  const Outcome silent =
      run_program({.arguments = quiet, .folder = folder_.path(), .terminal = true});
  EXPECT_EQ(silent.status, 0);
  EXPECT_EQ(silent.err, "");
  EXPECT_EQ(silent.out, "");
}

TEST_F(Render, InterruptedRunsChangeNothing) {
  folder_.write("cornell.exr", "old");
  for (const int signal : {SIGINT, SIGTERM}) {
    const Outcome outcome = run_program({.arguments = {kCornell, "--size", "2000x2000"},
                                         .folder = folder_.path(),
                                         .terminal = true,
                                         .signal_when_busy = signal});
    EXPECT_EQ(outcome.status, 128 + signal);
    EXPECT_NE(outcome.err.find("error: interrupted; no file was changed"), std::string::npos);
    EXPECT_EQ(folder_.list(), (std::vector<std::string>{"cornell.exr"}));
    EXPECT_EQ(folder_.read("cornell.exr"), "old");
  }
}

TEST_F(Render, StatisticsAreWholeAndAgree) {
  const Outcome outcome =
      render({kCornell, "--size", "60x50", "--threads", "2", "--seed", "9", "-o", "a.png"});
  const std::set<std::string> expected{
      "software",      "scene",         "triangles",       "width",
      "height",        "window",        "engine",          "unit",
      "threads",       "seed",          "pictures",        "rays",
      "records",       "tests",         "misses",          "hits",
      "edge_doubts",   "depth_doubts",  "exact_inside",    "exact_depth",
      "plane_tests",   "clocks",        "clocks_per_test", "seconds",
      "lanes",         "unit_tests",    "quotients",       "idle_clocks",
      "output_stalls", "thread_seconds"};
  std::set<std::string> actual;
  for (const auto& [key, value] : stats_.items()) actual.insert(key);
  EXPECT_EQ(actual, expected);
  EXPECT_EQ(stats_.at("rays"), 60 * 50);
  EXPECT_EQ(stats_.at("window"), (json{0, 0, 60, 50}));
  EXPECT_EQ(stats_.at("engine"), "rtl");
  EXPECT_EQ(stats_.at("unit"), "pipeline");
  EXPECT_EQ(stats_.at("seed"), 9);
  EXPECT_EQ(stats_.at("pictures"), json{"a.png"});
  const auto count = [&](const char* key) { return stats_.at(key).get<std::uint64_t>(); };
  EXPECT_EQ(count("misses") + count("hits") + count("edge_doubts"), count("tests"));
  EXPECT_GT(count("hits"), 0u);
  EXPECT_EQ(count("unit_tests"), count("tests"));
  EXPECT_GE(count("clocks"), count("tests"));
  EXPECT_DOUBLE_EQ(stats_.at("clocks_per_test").get<double>(),
                   static_cast<double>(count("clocks")) / static_cast<double>(count("unit_tests")));
  const json& seconds = stats_.at("seconds");
  double parts = 0.0;
  for (const char* part : {"load", "tree", "render", "write"}) {
    EXPECT_GE(seconds.at(part), 0.0);
    parts += seconds.at(part).get<double>();
  }
  EXPECT_LE(parts, seconds.at("total").get<double>() + 1e-3);
  // The text says the same.
  EXPECT_NE(outcome.out.find("cornell.obj: "), std::string::npos);
  EXPECT_NE(outcome.out.find("60x50, engine rtl, unit pipeline, 2 threads\n"), std::string::npos);
  for (const char* row : {"\nrays ", "\ntests ", "\nhits ", "\ndoubts ", "\nclocks ", "\ntime "}) {
    EXPECT_NE(outcome.out.find(row), std::string::npos) << row;
  }
}

TEST_F(Render, WarningsAreSaidOnce) {
  folder_.write("a.obj",
                "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
                "usemtl red\nf 1 3 2\n");
  const Outcome outcome = render({"a.obj", "--size", "4x4", "--engine", "cpu", "--quiet"});
  std::multiset<std::string> lines;
  for (std::size_t start = 0; start < outcome.err.size();) {
    const std::size_t end = outcome.err.find('\n', start);
    ASSERT_NE(end, std::string::npos);
    lines.insert(outcome.err.substr(start, end - start));
    start = end + 1;
  }
  EXPECT_FALSE(lines.empty());
  for (const std::string& line : lines) {
    EXPECT_EQ(line.substr(0, 15), "warning: a.obj:") << line;
    EXPECT_EQ(lines.count(line), 1u) << line;
  }
}

TEST_F(Render, HelpAndVersionGoToStandardOutput) {
  for (const char* option : {"--help", "-h", "--version"}) {
    const Outcome outcome = run_program({.arguments = {option}, .folder = folder_.path()});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
  }
}

}  // namespace
}  // namespace raygate
