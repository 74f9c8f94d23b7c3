#include "host/cli/options.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <initializer_list>
#include <vector>

#include "host/scene/io/input_error.h"
#include "host/scene/test/temp_folder.h"

namespace raygate {
namespace {

Options parse(std::initializer_list<const char*> arguments) {
  std::vector<const char*> argv{"render"};
  argv.insert(argv.end(), arguments);
  return parse_options(static_cast<int>(argv.size()), argv.data());
}

std::string error_of(std::initializer_list<const char*> arguments) {
  try {
    (void)parse(arguments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

/// The error is one line and says `part`.
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
  EXPECT_EQ(options.width, 640);
  EXPECT_EQ(options.height, 480);
  EXPECT_EQ(options.window.x1, 640);
  EXPECT_EQ(options.window.y1, 480);
  EXPECT_EQ(options.engine, Engine::kRtl);
  EXPECT_EQ(options.unit, "pipeline");
  EXPECT_EQ(options.lanes, 1);
  EXPECT_GE(options.threads, 1u);
  EXPECT_FALSE(options.camera);
  EXPECT_EQ(options.seed, 0u);
  EXPECT_FALSE(options.quiet);
  EXPECT_FALSE(options.skip_degenerate);
}

TEST(Options, ReadsEveryOption) {
  const Options options = parse({"--size",
                                 "320x200",
                                 "--crop=1,2,30,40",
                                 "--camera",
                                 "-1,-.5,1e3,0,0,-2.5,40",
                                 "--engine",
                                 "check",
                                 "--unit",
                                 "serial",
                                 "--threads",
                                 "7",
                                 "--seed",
                                 "18446744073709551615",
                                 "--skip-degenerate",
                                 "--stats",
                                 "run.json",
                                 "-q",
                                 "a.obj",
                                 "-o",
                                 "b"});
  EXPECT_EQ(options.width, 320);
  EXPECT_EQ(options.height, 200);
  EXPECT_EQ(options.window.x0, 1);
  EXPECT_EQ(options.window.y0, 2);
  EXPECT_EQ(options.window.x1, 30);
  EXPECT_EQ(options.window.y1, 40);
  ASSERT_TRUE(options.camera);
  EXPECT_EQ(options.camera->eye, glm::dvec3(-1, -0.5, 1000));
  EXPECT_EQ(options.camera->target, glm::dvec3(0, 0, -2.5));
  EXPECT_EQ(options.camera->fov, 40.0);
  EXPECT_EQ(options.engine, Engine::kCheck);
  EXPECT_EQ(options.threads, 7u);
  EXPECT_EQ(options.seed, 18446744073709551615u);
  EXPECT_TRUE(options.skip_degenerate);
  EXPECT_TRUE(options.quiet);
  EXPECT_EQ(options.output.stats, "run.json");
  EXPECT_EQ(options.output.exr, "b.exr");
  EXPECT_EQ(options.output.png, "b.png");
}

TEST(Options, TheLastOfSeveralValuesCounts) {
  EXPECT_EQ(parse({"a.obj", "--threads", "3", "--threads", "5"}).threads, 5u);
}

TEST(Options, OutputNames) {
  EXPECT_EQ(parse({"a.obj", "-o", "x.exr"}).output.exr, "x.exr");
  EXPECT_FALSE(parse({"a.obj", "-o", "x.exr"}).output.png);
  EXPECT_EQ(parse({"a.obj", "-o", "x.png"}).output.png, "x.png");
  EXPECT_FALSE(parse({"a.obj", "-o", "x.png"}).output.exr);
  EXPECT_EQ(parse({"d/my.scene.obj"}).output.exr, "my.scene.exr");
  const std::string folder = std::filesystem::temp_directory_path().string();
  EXPECT_EQ(parse({"d/a.obj", "-o", folder.c_str()}).output.exr,
            std::filesystem::path(folder) / "a.exr");
  EXPECT_EQ(parse({"d/a.obj", "-o", "missing/"}).output.png, "missing/a.png");
  expect_error({"a.obj", "-o", "x.jpg"}, ".exr or .png");
  expect_error({"a.obj", "-o", ""}, "--output");
}

TEST(Options, NoOutputOverwritesTheSceneOrAnotherOutput) {
  expect_error({"a.obj", "--stats", "./a.obj"}, "./a.obj: would overwrite a.obj");
  expect_error({"a.obj", "--stats", "a.png"}, "a.png: would overwrite a.png");
  expect_error({"a.exr"}, "a.exr: would overwrite a.exr");
}

TEST(Options, SizesThatAreImpossible) {
  for (const char* size : {"0x480", "640x0", "-1x5", "640", "640x", "x480", "640x480x3", "640X480",
                           "1000000000x1", "1x1000000000", "65537x1", "99999999999999999999x1",
                           "1.5x2", " 1x2", "1x2 ", "+1x2", "nanx1"}) {
    expect_error({"a.obj", "--size", size},
                 std::string("--size: expected WIDTHxHEIGHT, each from 1 to 65536"));
    expect_error({"a.obj", "--size", size}, std::string("'") + size + "'");
  }
  expect_error({"a.obj", "--size", "8193x8192"}, "at most 67108864 pixels in one run");
  EXPECT_EQ(parse({"a.obj", "--size", "8192x8192"}).width, 8192);
  EXPECT_EQ(parse({"a.obj", "--size", "65536x1"}).width, 65536);
}

TEST(Options, PartOfAFrameTooLargeForOneRun) {
  EXPECT_EQ(parse({"a.obj", "--size", "65536x65536", "--crop", "0,0,65536,1024"}).window.y1, 1024);
  expect_error({"a.obj", "--size", "65536x65536", "--crop", "0,0,65536,1025"},
               "--crop: expected at most 67108864 pixels");
}

TEST(Options, CropsThatAreImpossible) {
  for (const char* crop :
       {"0,0,0,10", "5,5,5,6", "6,0,5,10", "0,0,641,10", "0,0,10,481", "-1,0,10,10", "0,0,10",
        "0,0,10,10,10", "a,b,c,d", "0,0,10,", "0,0,99999999999,1"}) {
    expect_error({"a.obj", "--crop", crop}, "--crop: expected X0,Y0,X1,Y1");
    expect_error({"a.obj", "--crop", crop}, "640x480");
  }
}

TEST(Options, CamerasThatAreImpossible) {
  for (const char* camera : {"0,0,0,1,1", "0,0,0,1,1,1,40,2", "0,0,0,1,1,x", "0,0,0,1,1,inf",
                             "nan,0,0,1,1,1", "1,2,3,1,2,3", "0,0,0,1,1,1,0", "0,0,0,1,1,1,180",
                             "0,0,0,1,1,1,-40", "0,0,0,1,1,1e999", "0 0 0 1 1 1"}) {
    expect_error({"a.obj", "--camera", camera}, "--camera: expected ");
  }
}

TEST(Options, ChannelsByName) {
  EXPECT_FALSE(parse({"a.obj"}).output.channels.position);
  const ExtraChannels some = parse({"a.obj", "--channels", "P,doubts"}).output.channels;
  EXPECT_TRUE(some.position && some.doubts);
  EXPECT_FALSE(some.albedo || some.object || some.tests);
  const ExtraChannels others =
      parse({"a.obj", "--channels", "tests,objectId,Albedo"}).output.channels;
  EXPECT_TRUE(others.albedo && others.object && others.tests);
  for (const char* names : {"p", "P,", ",P", "P tests", "Z", "P,,tests"}) {
    expect_error({"a.obj", "--channels", names}, "--channels: expected some of P, Albedo, ");
  }
  expect_error({"a.obj", "--channels", "P", "-o", "a.png"}, "--channels: expected an EXR");
}

TEST(Options, WhatThePngShows) {
  EXPECT_EQ(parse({"a.obj"}).output.display.exposure, 0.0);
  EXPECT_EQ(parse({"a.obj", "--exposure", "-1.5"}).output.display.exposure, -1.5);
  EXPECT_EQ(parse({"a.obj"}).output.display.tone, Tone::kClip);
  EXPECT_EQ(parse({"a.obj", "--tone", "filmic"}).output.display.tone, Tone::kFilmic);
  for (const char* stops : {"bright", "101", "nan", "inf", "1,5"}) {
    expect_error({"a.obj", "--exposure", stops}, "--exposure: expected a number of stops");
  }
  expect_error({"a.obj", "--tone", "aces"}, "--tone: expected clip or filmic");
}

TEST(Options, FalseColours) {
  const Options options = parse({"a.obj", "--false-colour", "tests=t.png", "--false-color",
                                 "N.X:-1:1=x=y.png", "-o", "b.png"});
  ASSERT_EQ(options.output.false_colors.size(), 2u);
  EXPECT_EQ(options.output.false_colors[0].channel, "tests");
  EXPECT_FALSE(options.output.false_colors[0].scale);
  EXPECT_EQ(options.output.false_colors[0].path, "t.png");
  EXPECT_EQ(options.output.false_colors[1].channel, "N.X");
  ASSERT_TRUE(options.output.false_colors[1].scale);
  EXPECT_EQ(options.output.false_colors[1].scale->low, -1.0);
  EXPECT_EQ(options.output.false_colors[1].scale->high, 1.0);
  EXPECT_EQ(options.output.false_colors[1].path, "x=y.png");
  for (const char* text : {"tests", "tests=", "tests=t.exr", "tests=t"}) {
    expect_error({"a.obj", "--false-colour", text}, "expected CHANNEL=FILE.png");
  }
  for (const char* text : {"=t.png", "N=t.png", "speed=t.png"}) {
    expect_error({"a.obj", "--false-colour", text}, "expected one of the EXR's channels");
  }
  for (const char* text :
       {"Z:=t.png", "Z:1=t.png", "Z:1:1=t.png", "Z:2:1=t.png", "Z:0:inf=t.png", "Z:0:1:2=t.png"}) {
    expect_error({"a.obj", "--false-colour", text}, "with numbers LOW < HIGH");
  }
  expect_error({"a.obj", "--false-colour", "Z=a.png"}, "a.png: would overwrite a.png");
}

TEST(Options, LightByName) {
  const LightOptions plain = parse({"a.obj"}).light;
  EXPECT_EQ(plain.integrator, IntegratorKind::kWhitted);
  EXPECT_EQ(plain.max_depth(), 4);
  EXPECT_EQ(plain.samples, 1);
  const LightOptions path =
      parse({"a.obj", "--integrator", "path", "--spp", "16", "--filter", "tent", "--threshold",
             "0.5", "--ambient", "0", "--no-skip", "culling,records"})
          .light;
  EXPECT_EQ(path.integrator, IntegratorKind::kPath);
  EXPECT_EQ(path.max_depth(), 64);
  EXPECT_EQ(path.samples, 16);
  EXPECT_EQ(path.filter, PixelFilter::kTent);
  EXPECT_EQ(path.threshold, 0.5);
  EXPECT_EQ(path.ambient, 0.0);
  EXPECT_FALSE(path.skips.culling || path.skips.records);
  EXPECT_TRUE(path.skips.weightless && path.skips.divisions);
  EXPECT_EQ(parse({"a.obj", "--depth", "0"}).light.max_depth(), 0);
  EXPECT_EQ(plain.point_error, 0x1p-16f);
  const auto point_error = [](const char* text) {
    return parse({"a.obj", "--point-error", text}).light.point_error;
  };
  EXPECT_EQ(point_error("0"), 0.0f);
  EXPECT_EQ(point_error("1e-4"), 1e-4f);
  EXPECT_EQ(point_error("inf"), std::numeric_limits<float>::max());
  const Skips none = parse({"a.obj", "--no-skip", "all"}).light.skips;
  for (const SkipName& skip : kSkipNames) EXPECT_FALSE(none.*skip.on) << skip.name;
  expect_error({"a.obj", "--integrator", "photon"}, "--integrator: expected primary, whitted or");
  expect_error({"a.obj", "--spp", "0"}, "--spp: expected a whole number from 1");
  expect_error({"a.obj", "--depth", "-1"}, "--depth: expected a whole number from 0");
  expect_error({"a.obj", "--filter", "lanczos"}, "--filter: expected box, tent, gauss");
  expect_error({"a.obj", "--threshold", "2"}, "--threshold: expected a number from 0 to 1");
  expect_error({"a.obj", "--threshold", "nan"}, "--threshold: expected");
  expect_error({"a.obj", "--point-error", "-1"}, "--point-error: expected a share of the distance");
  expect_error({"a.obj", "--point-error", "nan"}, "--point-error: expected a share of the distance");
  expect_error({"a.obj", "--ambient", "inf"}, "--ambient: expected a radiance");
  expect_error({"a.obj", "--no-skip", "rays"}, "--no-skip: expected some of culling, records");
}

TEST(Options, Films) {
  EXPECT_EQ(parse({"a.obj"}).output.frames, 0);
  const OutputOptions output = parse({"a.obj", "--frames", "24", "-o", "f/x", "--stats", "s.json",
                                      "--false-colour", "Z=z.png"})
                                   .output;
  EXPECT_EQ(output.frames, 24);
  const OutputOptions seventh = output.numbered(7);
  EXPECT_EQ(seventh.exr, "f/x-0007.exr");
  EXPECT_EQ(seventh.png, "f/x-0007.png");
  EXPECT_EQ(seventh.stats, "s-0007.json");
  EXPECT_EQ(seventh.false_colors[0].path, "z-0007.png");
  for (const char* frames : {"0", "-1", "10000", "1.5", "all"}) {
    expect_error({"a.obj", "--frames", frames}, "--frames: expected a whole number from 1 to 9999");
  }
}

/// A scene file in a folder of its own.
class OptionsOfASceneFile : public testing::Test {
 protected:
  [[nodiscard]] std::string write(const char* name, std::string_view text) const {
    return folder_.write(name, text).string();
  }
  const TempFolder folder_;
};

TEST_F(OptionsOfASceneFile, AreTakenWhereTheCommandLineHasNone) {
  const std::string json = write("a.json", R"({
      "camera": {"eye": [1, 2, 3], "target": [0, 0, 0],
                 "path": [{"eye": [1, 2, 3], "target": [0, 0, 0]},
                          {"eye": [4, 2, 3], "target": [0, 0, 0]}]},
      "render": {"size": "20x10", "exposure": -1.5, "seed": 18446744073709551615}})");
  const std::string obj = (folder_.path() / "a.obj").string();
  for (const std::string& scene : {json, obj}) {
    const Options options = parse({scene.c_str(), "--exposure", "2"});
    EXPECT_EQ(options.obj(), obj);
    EXPECT_EQ(options.width, 20);
    EXPECT_EQ(options.window.y1, 10);
    EXPECT_EQ(options.output.display.exposure, 2.0) << "the command line has the last word";
    EXPECT_EQ(options.output.exr, "a.exr");
    EXPECT_EQ(options.seed, 18446744073709551615u);
    ASSERT_TRUE(options.camera);
    EXPECT_EQ(options.camera->eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(options.path.size(), 2u);
    const Options other = parse({scene.c_str(), "--camera", "0,0,9,0,0,0"});
    EXPECT_EQ(other.camera->eye, glm::dvec3(0, 0, 9));
    EXPECT_TRUE(other.path.empty()) << "the camera of the command line goes round its target";
  }
  EXPECT_EQ(parse({obj.c_str(), "--no-scene-file"}).width, 640);
  expect_error({json.c_str(), "--no-scene-file"}, "--no-scene-file: expected an OBJ");
  expect_error({obj.c_str(), "--stats", json.c_str()}, "would overwrite");
}

TEST_F(OptionsOfASceneFile, AreRefusedWithTheirPlace) {
  const std::string json = write("a.json", "{\"render\": {\n\"size\": \"big\"}}");
  expect_error({json.c_str()}, json + ":2: --size: expected WIDTHxHEIGHT");
  const std::string other = write("b.json", R"({"obj": "c.obj"})");
  expect_error({(folder_.path() / "b.obj").c_str()}, "b.json: is about ");
  EXPECT_EQ(parse({other.c_str()}).obj(), folder_.path() / "c.obj");
  expect_error({"missing.json"}, "missing.json: cannot read");
}

TEST_F(OptionsOfASceneFile, MayNotBeOverwrittenBeforeItIsThere) {
  expect_error({"a.obj", "--stats", "a.json"}, "a.json: would overwrite a.json");
}

TEST(Options, OtherValuesThatAreImpossible) {
  expect_error({"a.obj", "--engine", "gpu"}, "--engine: expected rtl, model, cpu or check");
  expect_error({"a.obj", "--unit", "warp"}, "--unit: expected pipeline or serial");
  for (const char* lanes : {"0", "3", "16", "-1", "x"}) {
    expect_error({"a.obj", "--lanes", lanes}, "--lanes: expected 1, 2, 4 or 8");
  }
  expect_error({"a.obj", "--unit", "serial", "--lanes", "2"}, "--lanes: expected 1 with");
  for (const char* threads : {"0", "-1", "1025", "two", "1.5"}) {
    expect_error({"a.obj", "--threads", threads}, "--threads: expected a whole number");
  }
  for (const char* seed : {"-1", "1.5", "x", "18446744073709551616"}) {
    expect_error({"a.obj", "--seed", seed}, "--seed: expected a whole number");
  }
  for (const char* option : {"--size", "--stats", "--seed", "--engine"}) {
    expect_error({"a.obj", option}, option);      // no value
    expect_error({"a.obj", option, ""}, option);  // an empty one
  }
}

TEST(Options, UnknownOptionsAreAnsweredWithTheKnownOnes) {
  for (const char* unknown : {"--foo", "-x", "--siz", "--size2=5"}) {
    expect_error({"a.obj", unknown}, "unknown option; the options are --size, --crop, ");
    expect_error({"a.obj", unknown}, "--version");
  }
  expect_error({"a.obj", "b.obj"}, "b.obj: a second scene");
  expect_error({}, "no scene given");
}

TEST(Options, HelpNamesEveryOptionAndStatus) {
  const std::string help = parse({"--help"}).information;
  for (const char* word : {"--output",          "--size",  "--crop",  "--camera",  "--channels",
                           "--engine",          "--unit",  "--lanes", "--threads", "--seed",
                           "--skip-degenerate", "--stats", "--quiet", "--help",    "--version",
                           "rtl|model|cpu|check", "  0  ",   "  1  ",   "  2  ",     "  130  "}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(parse({"-h"}).information, help);
  EXPECT_EQ(parse({"--version"}).information.substr(0, 8), "raygate ");
  EXPECT_TRUE(parse({"a.obj"}).information.empty());
}

TEST(Options, HelpFitsATerminal) {
  const std::string help = parse({"--help"}).information;
  for (std::size_t start = 0; start < help.size();) {
    const std::size_t end = help.find('\n', start);
    ASSERT_NE(end, std::string::npos);
    EXPECT_LE(end - start, 90u) << help.substr(start, end - start);
    start = end + 1;
  }
}

}  // namespace
}  // namespace raygate
