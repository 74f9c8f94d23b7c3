#include "host/cli/options.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <initializer_list>
#include <vector>

#include "host/scene/input_error.h"

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
  const Options options = parse({"scenes/cornell.obj"});
  EXPECT_EQ(options.scene, "scenes/cornell.obj");
  EXPECT_EQ(options.exr, "cornell.exr");  // in the current folder
  EXPECT_EQ(options.png, "cornell.png");
  EXPECT_FALSE(options.stats);
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
  EXPECT_EQ(options.stats, "run.json");
  EXPECT_EQ(options.exr, "b.exr");
  EXPECT_EQ(options.png, "b.png");
}

TEST(Options, TheLastOfSeveralValuesCounts) {
  EXPECT_EQ(parse({"a.obj", "--threads", "3", "--threads", "5"}).threads, 5u);
}

TEST(Options, OutputNames) {
  EXPECT_EQ(parse({"a.obj", "-o", "x.exr"}).exr, "x.exr");
  EXPECT_FALSE(parse({"a.obj", "-o", "x.exr"}).png);
  EXPECT_EQ(parse({"a.obj", "-o", "x.png"}).png, "x.png");
  EXPECT_FALSE(parse({"a.obj", "-o", "x.png"}).exr);
  EXPECT_EQ(parse({"d/my.scene.obj"}).exr, "my.scene.exr");
  const std::string folder = std::filesystem::temp_directory_path().string();
  EXPECT_EQ(parse({"d/a.obj", "-o", folder.c_str()}).exr, std::filesystem::path(folder) / "a.exr");
  EXPECT_EQ(parse({"d/a.obj", "-o", "missing/"}).png, "missing/a.png");
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

TEST(Options, OtherValuesThatAreImpossible) {
  expect_error({"a.obj", "--engine", "gpu"}, "--engine: expected rtl, cpu or check");
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
    expect_error({"a.obj", unknown}, "unknown option; the options are -o/--output, --size, ");
    expect_error({"a.obj", unknown}, "--version");
  }
  expect_error({"a.obj", "b.obj"}, "b.obj: a second scene");
  expect_error({}, "no scene given");
}

TEST(Options, HelpNamesEveryOptionAndStatus) {
  const std::string help = parse({"--help"}).information;
  for (const char* word :
       {"--output", "--size", "--crop", "--camera", "--engine", "--unit", "--lanes", "--threads",
        "--seed", "--skip-degenerate", "--stats", "--quiet", "--help", "--version", "rtl|cpu|check",
        "  0  ", "  1  ", "  2  ", "  130  "}) {
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
