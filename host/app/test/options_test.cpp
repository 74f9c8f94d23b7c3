// The command line: every option, and every impossible value.
#include "host/app/options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "host/app/console.h"
#include "host/base/test/temp_folder.h"

namespace raygate {
namespace {

using namespace std::string_literals;

Options parse(std::initializer_list<const char*> arguments) {
  return parse_options({arguments.begin(), arguments.end()});
}

std::string error_of(std::initializer_list<const char*> arguments) {
  return input_error_of([&] { (void)parse(arguments); });
}

/// Expects an error of one line that contains `part`.
void expect_error(std::initializer_list<const char*> arguments, const std::string& part) {
  const std::string error = error_of(arguments);
  EXPECT_NE(error.find(part), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST(Options, OnlyASceneMeansTheDefaults) {
  const Options options = parse({"d/cornell.obj"});
  EXPECT_EQ(options.scene, "d/cornell.obj");
  EXPECT_EQ(options.output.exr, "cornell.exr");  // in the current folder
  EXPECT_EQ(options.output.png, "cornell.png");
  EXPECT_FALSE(options.output.stats);
  EXPECT_EQ(options.render.width, 640);
  EXPECT_EQ(options.render.height, 480);
  EXPECT_EQ(options.render.window.x1, 640);
  EXPECT_EQ(options.render.window.y1, 480);
  EXPECT_EQ(options.engine, Engine::kRtl);
  EXPECT_EQ(options.unit, "pipeline");
  EXPECT_EQ(options.lanes, 1);
  EXPECT_GE(options.threads, 1);
  EXPECT_FALSE(options.camera.camera);
  EXPECT_EQ(options.render.seed, 0u);
  EXPECT_FALSE(options.quiet);
}

TEST(Options, ReadsEveryOption) {
  std::istringstream line(
      "--size 320x200 --crop=1,2,30,40 --camera -1,-.5,1e3,0,0,-2.5,40 --engine check "
      "--unit serial --threads 7 --seed 18446744073709551615 --up -z --fov=50 --stats run.json -q "
      "a.obj "
      "-o b");
  const Options options = parse_options({std::istream_iterator<std::string>(line), {}});
  EXPECT_EQ(options.render.width, 320);
  EXPECT_EQ(options.render.height, 200);
  EXPECT_EQ(options.render.window.x0, 1);
  EXPECT_EQ(options.render.window.y0, 2);
  EXPECT_EQ(options.render.window.x1, 30);
  EXPECT_EQ(options.render.window.y1, 40);
  ASSERT_TRUE(options.camera.camera);
  EXPECT_EQ(options.camera.camera->eye, glm::dvec3(-1, -0.5, 1000));
  EXPECT_EQ(options.camera.camera->target, glm::dvec3(0, 0, -2.5));
  EXPECT_EQ(options.camera.camera->fov, 40.0);
  EXPECT_EQ(options.camera.up, glm::dvec3(0, 0, -1));
  EXPECT_EQ(options.camera.fov, 50.0);
  EXPECT_FALSE(options.camera.angles);
  EXPECT_EQ(options.engine, Engine::kCheck);
  EXPECT_EQ(options.threads, 7);
  EXPECT_EQ(options.render.seed, 18446744073709551615u);
  EXPECT_TRUE(options.quiet);
  EXPECT_EQ(options.output.stats, "run.json");
  EXPECT_EQ(options.output.exr, "b.exr");
  EXPECT_EQ(options.output.png, "b.png");
}

TEST(Options, TheLastOfSeveralValuesCounts) {
  EXPECT_EQ(parse({"a.obj", "--threads", "3", "--threads", "5"}).threads, 5);
}

TEST(Options, NoOutputOverwritesTheSceneOrAnotherOutput) {
  expect_error({"a.obj", "--stats", "./a.obj"}, "./a.obj: would overwrite a.obj");
  expect_error({"a.obj", "--stats", "a.png"}, "a.png: would overwrite a.png");
  expect_error({"a.exr"}, "a.exr: would overwrite a.exr");
  expect_error({"a.obj", "--stats", "a.json"}, "a.json: would overwrite a.json");
}

TEST(Options, ValuesThatAreImpossible) {
  struct Row {
    const char* option;
    std::vector<const char*> values;
    const char* expected;
  };
  const Row rows[] = {
      {"--size",
       {"0x480", "640x0", "-1x5", "640", "640x", "x480", "640x480x3", "640X480", "1000000000x1",
        "1x1000000000", "65537x1", "99999999999999999999x1", "1.5x2", " 1x2", "1x2 ", "+1x2",
        "nanx1"},
       "WIDTHxHEIGHT, each from 1 to 65536"},
      {"--size", {"8193x8192"}, "at most 67108864 pixels in one run"},
      {"--crop",
       {"0,0,0,10", "5,5,5,6", "6,0,5,10", "0,0,641,10", "0,0,10,481", "-1,0,10,10", "0,0,10",
        "0,0,10,10,10", "a,b,c,d", "0,0,10,", "0,0,99999999999,1"},
       "X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 within the frame of 640x480"},
      {"--camera",
       {"0,0,0,1,1", "0,0,0,1,1,1,40,2", "0,0,0,1,1,x", "0,0,0,1,1,inf", "nan,0,0,1,1,1",
        "1,2,3,1,2,3", "0,0,0,1,1,1,0", "0,0,0,1,1,1,180", "0,0,0,1,1,1,-40", "0,0,0,1,1,1e999",
        "0 0 0 1 1 1"},
       "EX,EY,EZ,TX,TY,TZ"},
      {"--view", {"above", "33", "33,24,1", "33,91", "0,nan", "361,0"}, "front, back, "},
      {"--up", {"w", "0,0,1", "+z"}, "x, y, z, "},
      {"--fov", {"0", "180", "wide"}, "degrees above 0"},
      {"--projection", {"fisheye"}, "perspective or orthographic"},
      {"--aperture", {"-1"}, "the radius of a lens"},
      {"--focus", {"0"}, "a distance"},
      {"--smooth", {"-1", "181", "nan", "flat"}, "degrees from 0 to 180"},
      {"--ground", {"yes"}, "on or off"},
      {"--environment-rotation", {"10"}, "--environment, too"},
      {"--environment-strength", {"-1"}, "a factor"},
      {"--engine", {"gpu"}, "rtl, model, cpu or check"},
      {"--variant", {"e8p"}, "exponent bits and digits"},
      {"--unit", {"warp"}, "pipeline, serial, core or board"},
      {"--lanes", {"0", "3", "16", "-1", "x"}, "1, 2, 4 or 8"},
      {"--cores", {"2"}, "with --unit core"},
      {"--cores", {"0", "65", "two"}, "a whole number, 1 to 64"},
      {"--threads", {"0", "-1", "1025", "two", "1.5"}, "a whole number"},
      {"--seed", {"-1", "1.5", "x", "18446744073709551616"}, "a whole number"},
      {"--exposure", {"bright", "101", "nan", "inf", "1,5"}, "a number of stops"},
      {"--tone", {"aces"}, "clip or filmic"},
      {"--channels", {"p", "P,", ",P", "P tests", "Z", "P,,tests"}, "some of P, Albedo, "},
      {"--false-colour",
       {"tests", "tests=", "tests=t.exr", "tests=t", "=t.png", "N=t.png", "speed=t.png"},
       "CHANNEL=FILE.png"},
      {"--output", {"x.jpg"}, "a name that ends in .exr or .png"},
      {"--integrator", {"photon"}, "primary, whitted or path"},
      {"--spp", {"0"}, "a whole number from 1"},
      {"--error", {"0", "-1", "256", "nan", "few"}, "steps of an 8-bit display"},
      {"--depth", {"-1"}, "a whole number from 0"},
      {"--filter", {"lanczos"}, "box or blackman-harris"},
      {"--threshold", {"2", "nan"}, "a number from 0 to 1"},
      {"--point-error", {"-1", "nan"}, "a fraction of the distance"},
      {"--ambient", {"inf"}, "a radiance"},
      {"--caustics", {"on"}, "auto or off"}};
  for (const auto& [option, values, expected] : rows) {
    for (const char* value : values) {
      const std::string error = error_of({"a.obj", option, value});
      const std::string start = std::string(option) + ": found '" + value + "', expected ";
      EXPECT_EQ(error.find(start + expected), 0u) << error;
      EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    }
  }
  EXPECT_EQ(parse({"a.obj", "--size", "8192x8192"}).render.width, 8192);
  EXPECT_EQ(parse({"a.obj", "--size", "65536x1"}).render.width, 65536);
  for (const char* option : {"--size", "--stats", "--seed", "--engine", "-o"}) {
    expect_error({"a.obj", option}, "expected ");      // no value
    expect_error({"a.obj", option, ""}, "expected ");  // an empty value
  }
  for (const char* next : {"-o", "--size=9x9"}) {
    EXPECT_EQ(error_of({"a.obj", "--spp", next, "m"}), "--spp: expected a value (see --help)");
  }
  EXPECT_EQ(parse({"a.obj", "--stats=-q"}).output.stats, "-q");
}

TEST(Options, ThatExcludeEachOther) {
  expect_error({"a.obj", "--variant", "e8p10"}, "--variant: e8p10: doubts are resolved, expected");
  expect_error({"a.obj", "--variant", "e8p12", "--engine", "cpu"},
               "--engine: found 'cpu', expected model with --variant e8p12");
  expect_error({"a.obj", "--variant", "serial-paper", "--unit", "core"},
               "--unit: found 'core', expected serial with --variant serial-paper");
  expect_error({"a.obj", "--unit", "serial", "--lanes", "2"}, "--lanes: found '2', expected 1");
  expect_error({"a.obj", "--view", "top", "--camera", "0,0,9,0,0,0"},
               "--view and --camera exclude each other");
  expect_error({"a.obj", "--channels", "P", "-o", "a.png"}, "--channels: expected an EXR");
}

TEST(Options, PartOfAFrameTooLargeForOneRun) {
  EXPECT_EQ(parse({"a.obj", "--size", "65536x65536", "--crop", "0,0,65536,1024"}).render.window.y1,
            1024);
  expect_error({"a.obj", "--size", "65536x65536", "--crop", "0,0,65536,1025"},
               "--crop: found '0,0,65536,1025', expected at most 67108864 pixels");
}

TEST(Options, LensesAndEnvironments) {
  const Options none = parse({"a.obj"});
  EXPECT_FALSE(none.camera.lens.projection || none.camera.lens.aperture);
  EXPECT_TRUE(none.environment.file.empty());
  const Options all = parse({"a.obj", "--projection", "orthographic", "--aperture", "0.25",
                             "--focus", "3", "--environment", "sky.hdr", "--environment-rotation",
                             "-90", "--environment-strength=2"});
  EXPECT_EQ(all.camera.lens.projection, Projection::kOrthographic);
  EXPECT_EQ(all.camera.lens.aperture, 0.25);
  EXPECT_EQ(all.camera.lens.focus, 3.0);
  EXPECT_EQ(all.environment.file, "sky.hdr");
  EXPECT_EQ(all.environment.rotation, -90.0);
  EXPECT_EQ(all.environment.strength, 2.0);
}

/// Writes a scene file to a temporary folder.
class OptionsOfASceneFile : public testing::Test {
 protected:
  [[nodiscard]] std::string write(const char* name, std::string_view text) const {
    return folder_.write(name, text).string();
  }
  const TempFolder folder_;
};

TEST_F(OptionsOfASceneFile, AreTakenWhereTheCommandLineHasNone) {
  const std::string json = write("a.json", R"({
      "camera": {"eye": [1, 2, 3], "target": [0, 0, 0]},
      "render": {"size": "20x10", "exposure": -1.5, "seed": 18446744073709551615}})");
  const std::string obj = (folder_.path() / "a.obj").string();
  for (const std::string& scene : {json, obj}) {
    const Options options = parse({scene.c_str(), "--exposure", "2"});
    EXPECT_EQ(options.scene_file.obj, obj);
    EXPECT_EQ(options.render.width, 20);
    EXPECT_EQ(options.render.window.y1, 10);
    EXPECT_EQ(options.output.display.exposure, 2.0) << "the command line has the last word";
    EXPECT_EQ(options.output.exr, "a.exr");
    EXPECT_EQ(options.render.seed, 18446744073709551615u);
    ASSERT_TRUE(options.camera.camera);
    EXPECT_EQ(options.camera.camera->eye, glm::dvec3(1, 2, 3));
    const Options other = parse({scene.c_str(), "--camera", "0,0,9,0,0,0"});
    EXPECT_EQ(other.camera.camera->eye, glm::dvec3(0, 0, 9));
  }
  expect_error({obj.c_str(), "--stats", json.c_str()}, "would overwrite");
}

TEST_F(OptionsOfASceneFile, ACameraWithoutAFieldOfViewKeepsTheScenes) {
  const auto fov = [](const std::string& scene, const char* camera) {
    const CameraRequest request = parse({scene.c_str(), "--camera", camera}).camera;
    Scene with_camera;  // as of a glTF file
    with_camera.camera = {{1, 1, 1}, {0, 0, 0}, {}, 20.0};
    return frame_picture(request, with_camera, 1.0).camera.vertical_fov_degrees();
  };
  EXPECT_EQ(fov("a.gltf", "0,0,9,0,0,0"), 20.0);
  EXPECT_EQ(fov("a.gltf", "0,0,9,0,0,0,50"), 50.0);
  const std::string place = R"("eye": [1, 2, 3], "target": [0, 0, 0])";
  for (const std::string& camera : {R"("fov": 32)"s, R"("fov": 32, )" + place}) {
    const std::string json = write("a.json", R"({"camera": {)" + camera + "}}");
    EXPECT_EQ(fov(json, "0,0,9,0,0,0"), 32.0) << camera;
    EXPECT_EQ(fov(json, "0,0,9,0,0,0,50"), 50.0) << camera;
  }
  EXPECT_EQ(fov(write("a.json", R"({"camera": {)" + place + "}}"), "0,0,9,0,0,0"), 35.0);
}

TEST_F(OptionsOfASceneFile, AreRefusedWithTheirPlace) {
  const std::string json = write("a.json", "{\"render\": {\n\"size\": \"big\"}}");
  expect_error({json.c_str()}, json + ":2: --size: found 'big', expected WIDTHxHEIGHT");
  const std::string both = write("a.json", "{\"render\": {\n\"error\": 1,\n\"spp\": 4}}");
  expect_error({both.c_str()}, both + ":3: --spp: found '4', expected more than the 16");
  EXPECT_EQ(parse({both.c_str(), "--spp", "32"}).render.samples, 32) << "typed values count";
  expect_error({both.c_str(), "--spp", "32", "--samples", "0:2"},
               "--samples and --error exclude each other (" + both + ":2 sets error)");
  const std::string one = write("a.json", "{\"render\": {\n\"error\": 1}}");
  expect_error({one.c_str(), "--samples", "0:2"},
               "--samples and --error exclude each other (" + one + ":2 sets error)");
  const std::string unknown = write("a.json", "{\"render\": {\"spp\": 2,\n\"threads\": 1}}");
  expect_error({unknown.c_str()},
               unknown + ":2: unknown option 'threads', expected some of exposure, tone, ");
  const std::string other = write("b.json", R"({"obj": "c.obj"})");
  const std::string scene = folder_.path() / "b.obj";
  EXPECT_EQ(parse({scene.c_str()}).scene_file.obj, folder_.path() / "c.obj") << "there is no b.obj";
  EXPECT_EQ(write("b.obj", ""), scene);
  expect_error({scene.c_str()}, "b.json: is about ");
  EXPECT_EQ(parse({other.c_str()}).scene_file.obj, folder_.path() / "c.obj");
  expect_error({"missing.json"}, "missing.json: cannot read");
}

TEST(Options, AnEnvironmentNeedsPaths) {
  const RenderSettings plain = parse({"a.obj"}).render;
  EXPECT_EQ(plain.integrator, IntegratorKind::kWhitted);
  const RenderSettings lit = parse({"a.obj", "--environment", "sky.hdr"}).render;
  EXPECT_EQ(lit.integrator, IntegratorKind::kPath);
  EXPECT_EQ(lit.samples, 16);
  EXPECT_EQ(parse({"a.obj", "--environment", "sky.hdr", "--spp", "2"}).render.samples, 2);
  const RenderSettings asked =
      parse({"a.obj", "--environment", "sky.hdr", "--integrator", "whitted"}).render;
  EXPECT_EQ(asked.integrator, IntegratorKind::kWhitted);
  EXPECT_EQ(asked.samples, plain.samples);
}

TEST(Options, WordsThatMeanNothing) {
  EXPECT_EQ(error_of({"a.obj", "--frobnicate"}), "--frobnicate: unknown option (see --help)");
  EXPECT_EQ(error_of({"-x", "cpu", "a.obj"}), "-x: unknown option (see --help)");
  EXPECT_EQ(error_of({"a.obj", "--quiet=yes"}), "--quiet=yes: --quiet takes no value (see --help)");
  expect_error({"a.obj", "b.obj"}, "found 2 scenes, expected one");
  expect_error({}, "found 0 scenes, expected one");
  EXPECT_EQ(parse({"--", "--odd.obj"}).scene, "--odd.obj");
}

TEST(Options, Views) {
  using Angles = std::pair<double, double>;
  EXPECT_EQ(parse({"a.obj", "--view", "front"}).camera.angles, Angles(0, 0));
  EXPECT_EQ(parse({"a.obj", "--view", "left"}).camera.angles, Angles(-90, 0));
  EXPECT_EQ(parse({"a.obj", "--view", "top"}).camera.angles, Angles(0, 90));
  EXPECT_EQ(parse({"a.obj", "--view", "-33.5,24"}).camera.angles, Angles(-33.5, 24));
  EXPECT_EQ(parse({"a.obj", "--smooth", "30"}).smooth, 30.0);
  EXPECT_EQ(parse({"a.obj", "--ground", "off"}).camera.ground, false);
  EXPECT_FALSE(parse({"a.obj"}).camera.ground);
}

TEST(Options, FilesOfTheRayCore) {
  const auto core = [](std::initializer_list<const char*> more) {
    std::vector<std::string> words{"a.obj", "--unit", "core", "--size", "64x48"};
    words.insert(words.end(), more.begin(), more.end());
    return parse_options(words);
  };
  EXPECT_EQ(core({"--cores", "4"}).cores, 4);
  EXPECT_TRUE(core({}).core_files.paths().empty());
  EXPECT_EQ(core({"--dump-image", "a.bin"}).core_files.image, "a.bin");
  EXPECT_EQ(core({"--trace", "63,47=a.vcd"}).core_files.pixel, glm::ivec2(63, 47));
  for (const char* pixel : {"64,0", "0,48", "-1,0", "1", "1,2,3", "x,y"}) {
    EXPECT_THROW((void)core({"--trace", (std::string(pixel) + "=a.vcd").c_str()}), InputError);
  }
  EXPECT_THROW((void)core({"--trace", "a.vcd"}), InputError);
  EXPECT_THROW((void)core({"--trace", "1,1"}), InputError);
  EXPECT_THROW((void)core({"--dump-image", "a.obj"}), InputError);
  expect_error({"a.obj", "--dump-image", "a.bin"}, "--dump-image: found 'a.bin', expected");
  expect_error({"a.obj", "--trace", "1,1=a.vcd"}, "--trace: found '1,1=a.vcd', expected");
}

TEST(OutputOptions, OutputNames) {
  EXPECT_EQ(parse({"a.obj", "-o", "x.exr"}).output.exr, "x.exr");
  EXPECT_FALSE(parse({"a.obj", "-o", "x.exr"}).output.png);
  EXPECT_EQ(parse({"a.obj", "-o", "x.png"}).output.png, "x.png");
  EXPECT_FALSE(parse({"a.obj", "-o", "x.png"}).output.exr);
  EXPECT_EQ(parse({"d/my.scene.obj"}).output.exr, "my.scene.exr");
  const std::string folder = std::filesystem::temp_directory_path().string();
  EXPECT_EQ(parse({"d/a.obj", "-o", folder.c_str()}).output.exr,
            std::filesystem::path(folder) / "a.exr");
  EXPECT_EQ(parse({"d/a.obj", "-o", "missing/"}).output.png, "missing/a.png");
}

TEST(OutputOptions, ChannelsByName) {
  EXPECT_FALSE(parse({"a.obj"}).output.channels.position);
  const ExtraChannels some = parse({"a.obj", "--channels", "P,doubts"}).output.channels;
  EXPECT_TRUE(some.position && some.doubts);
  EXPECT_FALSE(some.albedo || some.object || some.tests);
  const ExtraChannels others =
      parse({"a.obj", "--channels", "tests,objectId,Albedo"}).output.channels;
  EXPECT_TRUE(others.albedo && others.object && others.tests);
}

TEST(OutputOptions, WhatThePngShows) {
  EXPECT_EQ(parse({"a.obj"}).output.display.exposure, 0.0);
  EXPECT_EQ(parse({"a.obj", "--exposure", "-1.5"}).output.display.exposure, -1.5);
  EXPECT_EQ(parse({"a.obj"}).output.display.tone, Tone::kClip);
  EXPECT_EQ(parse({"a.obj", "--tone", "filmic"}).output.display.tone, Tone::kFilmic);
}

TEST(OutputOptions, FalseColours) {
  const Options options = parse(
      {"a.obj", "--false-colour", "tests=t.png", "--false-color", "N.X=x=y.png", "-o", "b.png"});
  ASSERT_EQ(options.output.false_colors.size(), 2u);
  EXPECT_EQ(options.output.false_colors[0].channel, "tests");
  EXPECT_EQ(options.output.false_colors[0].path, "t.png");
  EXPECT_EQ(options.output.false_colors[1].channel, "N.X");
  EXPECT_EQ(options.output.false_colors[1].path, "x=y.png");
  expect_error({"a.obj", "--false-colour", "Z=a.png"}, "a.png: would overwrite a.png");
}

TEST(OutputOptions, LightByName) {
  const RenderSettings plain = parse({"a.obj"}).render;
  EXPECT_EQ(plain.integrator, IntegratorKind::kWhitted);
  EXPECT_EQ(plain.depth(), 4);
  for (const char* engine : {"rtl", "model", "cpu", "check"}) {
    EXPECT_EQ(parse({"a.obj", "--engine", engine}).render.samples, 4) << "whatever the engine";
  }
  EXPECT_EQ(parse({"a.obj", "--engine", "cpu", "--spp", "1"}).render.samples, 1);
  const RenderSettings path = parse({"a.obj", "--integrator", "path", "--spp", "16", "--filter",
                                     "box", "--threshold", "0.5", "--ambient", "0"})
                                  .render;
  EXPECT_EQ(path.integrator, IntegratorKind::kPath);
  EXPECT_EQ(path.depth(), 64);
  EXPECT_EQ(path.samples, 16);
  EXPECT_EQ(path.filter, ReconstructionFilter::kBox);
  EXPECT_EQ(path.threshold, 0.5);
  EXPECT_EQ(path.ambient, 0.0);
  EXPECT_EQ(parse({"a.obj", "--depth", "0"}).render.depth(), 0);
  EXPECT_EQ(parse({"a.obj", "--max-depth", "7"}).render.depth(), 7);
  EXPECT_FALSE(parse({"a.obj", "--caustics", "off"}).render.caustics);
  EXPECT_EQ(plain.point_error, 0x1p-16f);
  const auto point_error = [](const char* text) {
    return parse({"a.obj", "--point-error", text}).render.point_error;
  };
  EXPECT_EQ(point_error("0"), 0.0f);
  EXPECT_EQ(point_error("1e-4"), 1e-4f);
  EXPECT_EQ(point_error("inf"), std::numeric_limits<float>::max());
}

std::string information_of(const char* argument) {
  try {
    (void)parse({argument});
  } catch (const Information& asked) {
    return asked.what();
  }
  return "";
}

TEST(Options, HelpFitsATerminal) {
  const std::string help = information_of("--help");
  EXPECT_LE(std::ranges::count(help, '\n'), 95);
  for (std::size_t start = 0; start < help.size();) {
    const std::size_t end = help.find('\n', start);
    ASSERT_NE(end, std::string::npos);
    EXPECT_LE(end - start, 80u) << help.substr(start, end - start);
    start = end + 1;
  }
  EXPECT_EQ(information_of("-h"), help);
  EXPECT_EQ(information_of("--version").substr(0, 8), "raygate ");
}

}  // namespace
}  // namespace raygate
