// Whole runs: the same picture whatever the engine, the threads and the crop; what is said on the
// way; statistics; interruption.
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <csignal>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>
#include <set>
#include <sstream>

#include "host/cli/test/program.h"
#include "host/image/test/exr_reader.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using namespace std::string_literals;

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

/// The scene files of the repository, the OBJ files without one, and a sphere of the build's.
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
  const std::string& scene = GetParam();
  render({scene, "--size", "64x48", "--engine", "cpu", "-o", "cpu"});
  const json cpu = stats_;
  EXPECT_GT(cpu.at("hits"), 0) << "an empty picture shows nothing";
  EXPECT_EQ(cpu.at("clocks"), 0);
  render({scene, "--size", "64x48", "--engine", "rtl", "-o", "rtl"});
  EXPECT_GT(stats_.at("clocks"), 0);
  EXPECT_GT(stats_.at("quotients"), 0);  // how many each engine needs is its own affair
  expect_same_pictures("cpu", "rtl");
  render({scene, "--size", "64x48", "--lanes", "4", "-o", "lanes"});
  expect_same_pictures("cpu", "lanes");
  render({scene, "--size", "64x48", "--unit", "serial", "--engine", "cpu", "-o", "serial"});
  expect_same_pictures("cpu", "serial");
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

TEST_F(Render, OnlyASceneGivesBothPicturesHere) {
  const Outcome outcome = render({kCornell});
  EXPECT_EQ(folder_.list(), (std::vector<std::string>{"cornell.exr", "cornell.png", "stats.json"}));
  EXPECT_NE(outcome.out.find("wrote   cornell.exr, cornell.png\n"), std::string::npos);
  EXPECT_EQ(outcome.err, "");
}

/// Pixels of a PNG file as 24-bit RGB; compressed bytes are a matter of zlib's version.
std::vector<std::uint8_t> decode_png(const std::string& bytes, png_image* size = nullptr) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  if (size != nullptr) *size = image;
  return pixels;
}

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The README's gallery: commands that write a picture of scenes/gallery.
std::vector<std::string> gallery_commands() {
  std::ifstream readme(RAYGATE_SCENES "/../README.md");
  const std::string text{std::istreambuf_iterator<char>(readme), {}};
  const std::regex command("`\\./render ([^`]*-o scenes/gallery/[^`]*)`");
  std::vector<std::string> commands;
  for (std::sregex_iterator i(text.begin(), text.end(), command), end; i != end; ++i) {
    commands.push_back((*i)[1]);
  }
  return commands;
}

class Gallery : public Render, public testing::WithParamInterface<std::string> {};

/// A crop of it is enough to tell, as a crop is that part of the whole.
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

TEST_F(Render, ThreadsChangeNoByte) {
  for (const char* threads : {"1", "2", "8"}) {
    render({kCornell, "--size", "100x75", "--threads", threads, "-o", threads});
    EXPECT_EQ(stats_.at("threads"), std::stoi(threads));
  }
  expect_same_pictures("1", "2");
  expect_same_pictures("1", "8");
}

// Rays that scatter at random, through glass too.
TEST_F(Render, EnginesGiveTheSameBytesOfPaths) {
  for (const std::string scene : {"cornell", "paper"}) {
    const auto with = [&](std::vector<std::string> rest) {
      rest.insert(rest.end(), {RAYGATE_SCENES "/" + scene + ".obj", "--integrator", "path",
                               "--size", "24x18", "--spp", "2"});
      return rest;
    };
    render(with({"-o", "cpu", "--engine", "cpu"}));
    EXPECT_GT(stats_.at("shadow_rays"), 0);
    render(with({"-o", "rtl", "--engine", "rtl"}));
    EXPECT_GT(stats_.at("clocks"), 0);
    expect_same_pictures("cpu", "rtl");
    render(with({"-o", "serial", "--engine", "cpu", "--unit", "serial", "--no-skip", "divisions"}));
    expect_same_pictures("cpu", "serial");
  }
}

TEST_F(Render, SkipsChangeNoByte) {
  const std::vector<std::string> arguments{
      RAYGATE_SCENES "/paper.obj", "--size", "40x30", "--engine", "cpu", "--depth", "2", "-o"};
  const auto with = [&](std::vector<std::string> rest) {
    rest.insert(rest.begin(), arguments.begin(), arguments.end());
    return rest;
  };
  render(with({"skips"}));
  const json done = stats_;
  for (const char* what : {"culled_tests", "lights_behind", "weightless"}) {
    EXPECT_GT(done.at("skipped").at(what), 0) << what;
  }
  // Of the paper's 34 polygons each comes near some ray, of the teapot's 4,032 not.
  render({RAYGATE_SCENES "/teapot.obj", "--size", "40x30", "--engine", "cpu", "-o", "teapot"});
  EXPECT_GT(stats_.at("skipped").at("records"), 0);
  render(with({"none", "--no-skip", "all"}));
  EXPECT_GT(stats_.at("tests"), 20 * done.at("tests").get<std::uint64_t>());
  EXPECT_EQ(stats_.at("skipped").at("culled_tests"), 0);
  expect_same_pictures("skips", "none");
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

TEST_F(Render, ChannelsOnDemand) {
  render({kCornell, "--size", "40x30", "--engine", "cpu", "-o", "plain.exr"});
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
  EXPECT_EQ(sum(doubts), stats_.at("edge_doubts"));
}

TEST_F(Render, FalseColoursOfAnyChannel) {
  const Outcome outcome = render({kCornell, "--size", "40x30", "--engine", "cpu", "-o", "a.exr",
                                  "--false-colour", "tests=t.png", "--false-colour",
                                  "Z:500:2000=z.png", "--false-colour", "objectId=o.png"});
  EXPECT_EQ(stats_.at("pictures"), (json{"a.exr", "t.png", "z.png", "o.png"}));
  for (const char* name : {"t.png", "z.png", "o.png"}) {
    const std::vector<std::uint8_t> pixels = decode_png(folder_.read(name));
    EXPECT_EQ(pixels.size(), 40u * 30u * 3u);
    EXPECT_GT(std::set<std::uint8_t>(pixels.begin(), pixels.end()).size(), 5u) << name;
  }
  EXPECT_NE(outcome.out.find("scale   tests: 0 (dark violet) to "), std::string::npos);
  EXPECT_NE(outcome.out.find("scale   Z: 500 (dark violet) to 2000 (yellow)"), std::string::npos);
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

TEST_F(Render, InterruptedRunsWriteWhatThereIs) {
  for (const int signal : {SIGINT, SIGTERM}) {
    // A crop without the empty border, so that the first tile has something to see.
    const Outcome outcome =
        run_program({.arguments = {kCornell, "--size", "640x480", "--crop", "200,120,520,440",
                                   "--threads", "1", "--spp", "4", "-o", "a", "--stats", "s.json"},
                     .folder = folder_.path(),
                     .terminal = true,
                     .signal_when_busy = signal});
    EXPECT_EQ(outcome.status, 128 + signal);
    ASSERT_NE(outcome.err.find("error: interrupted; wrote what there was: a.exr, a.png"),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(folder_.list(), (std::vector<std::string>{"a.exr", "a.png"}));
    ExrReader partial(folder_.read("a.exr"));
    EXPECT_EQ(partial.text("partial"), "not finished when it was saved");
    const auto ids = partial.read<std::uint32_t>("id", Imf::UINT);
    ASSERT_EQ(ids.size(), 102400u);
    const auto missing = std::ranges::count(ids, 4294967295u);
    EXPECT_GT(missing, 0);
    EXPECT_LT(missing, 102400);
    EXPECT_NE(folder_.read("a.png").find("tEXtComment\0not finished when it was saved"s),
              std::string::npos);
    fs::remove(folder_.path() / "a.exr");
    fs::remove(folder_.path() / "a.png");
  }
}

TEST_F(Render, FinishedPicturesAreNotCalledPartial) {
  render({kCornell, "--size", "9x9", "--engine", "cpu", "-o", "a"});
  EXPECT_EQ(ExrReader(folder_.read("a.exr")).text("partial"), "(none)");
  EXPECT_EQ(folder_.read("a.png").find("Comment"), std::string::npos);
}

TEST_F(Render, SavingInBetweenChangesNothingInTheEnd) {
  const std::vector<std::string> scene{kCornell, "--size", "96x96", "--engine",
                                       "cpu",    "--spp",  "16"};
  std::vector<std::string> plain = scene, saving = scene;
  plain.insert(plain.end(), {"-o", "plain"});
  saving.insert(saving.end(), {"-o", "saving", "--save-every", "0.1"});
  render(plain);
  render(saving);
  expect_same_pictures("plain", "saving");
}

/// Where the camera stands, from the file.
Imath::V3f eye_of(const std::string& bytes) {
  const ExrReader reader(bytes);
  return Imath::V3f(0) * Imf::worldToCamera(reader.header()).inverse();
}

TEST_F(Render, FramesGoRoundTheTarget) {
  const Outcome outcome =
      run_program({.arguments = {kCornell, "--size", "20x15", "--engine", "cpu", "--frames", "4",
                                 "--camera", "278,273,1300,278,273,280", "-o", "f.exr"},
                   .folder = folder_.path()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(folder_.list(),
            (std::vector<std::string>{"f-0001.exr", "f-0002.exr", "f-0003.exr", "f-0004.exr"}));
  EXPECT_NE(outcome.out.find("frame 4 of 4: "), std::string::npos);
  const Imath::V3f eyes[] = {
      {278, 273, 1300}, {1298, 273, 280}, {278, 273, -740}, {-742, 273, 280}};
  for (int i = 0; i < 4; ++i) {
    const Imath::V3f eye = eye_of(folder_.read("f-000" + std::to_string(i + 1) + ".exr"));
    EXPECT_LT((eye - eyes[i]).length(), 1e-2f) << i;
  }
}

constexpr const char* kSquare = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";

TEST_F(Render, FramesFollowThePathOfTheSceneFile) {
  folder_.write("s.obj", kSquare);
  folder_.write("s.json", R"({"camera": {"path": [{"eye": [0, 0, 4], "target": [0, 0, 0]},
                                                  {"eye": [2, 0, 4], "target": [0, 0, 0]}]}})");
  const Outcome outcome = run_program(
      {.arguments = {"s.json", "--size", "8x8", "--engine", "cpu", "--frames", "3", "-o", "f.exr"},
       .folder = folder_.path()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (int i = 0; i < 3; ++i) {
    const Imath::V3f eye = eye_of(folder_.read("f-000" + std::to_string(i + 1) + ".exr"));
    EXPECT_LT((eye - Imath::V3f(static_cast<float>(i), 0, 4)).length(), 1e-5f) << i;
  }
}

TEST_F(Render, TheSceneFileBesideAnObjIsReadWithIt) {
  folder_.write("s.obj", kSquare);
  folder_.write("s.json", R"({"camera": {"eye": [0, 0, 3], "target": [0, 0, 0]},
                              "render": {"size": "30x20"}})");
  render({"s.obj", "--engine", "cpu", "-o", "obj"});
  EXPECT_EQ(stats_.at("width"), 30);
  render({"s.json", "--engine", "cpu", "-o", "json"});
  expect_same_pictures("obj", "json");
  EXPECT_EQ(eye_of(folder_.read("obj.exr")), Imath::V3f(0, 0, 3));
  render({"s.obj", "--engine", "cpu", "-o", "alone", "--no-scene-file"});
  EXPECT_EQ(stats_.at("width"), 640);
}

TEST_F(Render, StatisticsAreWholeAndAgree) {
  const Outcome outcome =
      render({kCornell, "--size", "60x50", "--threads", "2", "--seed", "9", "-o", "a.png"});
  const std::set<std::string> expected{
      "software",      "scene",          "triangles",       "width",
      "height",        "window",         "engine",          "unit",
      "threads",       "seed",           "pictures",        "rays",
      "records",       "tests",          "misses",          "hits",
      "edge_doubts",   "depth_doubts",   "exact_inside",    "exact_depth",
      "plane_tests",   "clocks",         "clocks_per_test", "seconds",
      "lanes",         "unit_tests",     "quotients",       "idle_clocks",
      "output_stalls", "thread_seconds", "integrator",      "spp",
      "depth",         "camera_rays",    "shadow_rays",     "common_records",
      "skipped"};
  std::set<std::string> actual;
  for (const auto& [key, value] : stats_.items()) actual.insert(key);
  EXPECT_EQ(actual, expected);
  EXPECT_EQ(stats_.at("camera_rays"), 60 * 50);
  EXPECT_GT(stats_.at("shadow_rays"), 0);
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
