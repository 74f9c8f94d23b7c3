// The command line: every option, every impossible value, and what a misspelt one is answered with.
#include <algorithm>
#include <utility>

#include "host/app/test/parsed.h"
#include "host/base/test/temp_folder.h"

namespace raygate {
namespace {

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
  EXPECT_FALSE(options.strict);
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
                                 "--up",
                                 "-z",
                                 "--fov=50",
                                 "--strict",
                                 "--stats",
                                 "run.json",
                                 "-q",
                                 "a.obj",
                                 "-o",
                                 "b"});
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
  EXPECT_TRUE(options.strict);
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
  EXPECT_EQ(parse({"a.obj", "--size", "8192x8192"}).render.width, 8192);
  EXPECT_EQ(parse({"a.obj", "--size", "65536x1"}).render.width, 65536);
}

TEST(Options, PartOfAFrameTooLargeForOneRun) {
  EXPECT_EQ(parse({"a.obj", "--size", "65536x65536", "--crop", "0,0,65536,1024"}).render.window.y1,
            1024);
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

TEST(Options, LensesAndEnvironments) {
  const Options none = parse({"a.obj"});
  EXPECT_FALSE(none.camera.lens.projection || none.camera.lens.aperture || none.environment);
  const Options all = parse({"a.obj", "--projection", "orthographic", "--aperture", "0.25",
                             "--focus", "3", "--environment", "sky.hdr", "--environment-rotation",
                             "-90", "--environment-strength=2"});
  EXPECT_EQ(all.camera.lens.projection, Projection::kOrthographic);
  EXPECT_EQ(all.camera.lens.aperture, 0.25);
  EXPECT_EQ(all.camera.lens.focus, 3.0);
  ASSERT_TRUE(all.environment);
  EXPECT_EQ(all.environment->file, "sky.hdr");
  EXPECT_EQ(all.environment->rotation, -90.0);
  EXPECT_EQ(all.environment->strength, 2.0);
  expect_error({"a.obj", "--projection", "fisheye"}, "--projection: expected ");
  expect_error({"a.obj", "--aperture", "-1"}, "--aperture: expected ");
  expect_error({"a.obj", "--focus", "0"}, "--focus: expected ");
  expect_error({"a.obj", "--environment-rotation", "10"},
               "--environment-rotation: expected --environment beside it");
  expect_error({"a.obj", "--environment", "s.exr", "--environment-strength", "-1"},
               "--environment-strength: expected ");
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
  EXPECT_EQ(parse({obj.c_str(), "--no-scene-file"}).render.width, 640);
  expect_error({json.c_str(), "--no-scene-file"}, "--no-scene-file: expected an OBJ");
  expect_error({obj.c_str(), "--stats", json.c_str()}, "would overwrite");
}

TEST_F(OptionsOfASceneFile, AreRefusedWithTheirPlace) {
  const std::string json = write("a.json", "{\"render\": {\n\"size\": \"big\"}}");
  expect_error({json.c_str()}, json + ":2: --size: expected WIDTHxHEIGHT");
  const std::string both = write("a.json", "{\"render\": {\n\"error\": 1,\n\"spp\": 4}}");
  expect_error({both.c_str()}, both + ":3: --spp: expected more than the 16 that --error begins");
  EXPECT_EQ(parse({both.c_str(), "--spp", "32"}).render.samples, 32) << "typed values count";
  expect_error({both.c_str(), "--spp", "32", "--samples", "0:2"},
               "--samples and --error exclude each other (" + both + ":2 sets error)");
  const std::string one = write("a.json", "{\"render\": {\n\"error\": 1}}");
  expect_error({one.c_str(), "--samples", "0:2"},
               "--samples and --error exclude each other (" + one + ":2 sets error)");
  const std::string unknown = write("a.json", "{\"render\": {\"spp\": 2,\n\"threads\": 1}}");
  expect_error({unknown.c_str()},
               unknown + ":2: render: unknown key 'threads', expected some of exposure, tone, ");
  const std::string other = write("b.json", R"({"obj": "c.obj"})");
  const std::string scene = folder_.path() / "b.obj";
  EXPECT_EQ(parse({scene.c_str()}).scene_file.obj, folder_.path() / "c.obj") << "there is no b.obj";
  EXPECT_EQ(write("b.obj", ""), scene);
  expect_error({scene.c_str()}, "b.json: is about ");
  EXPECT_EQ(parse({other.c_str()}).scene_file.obj, folder_.path() / "c.obj");
  expect_error({"missing.json"}, "missing.json: cannot read");
}

TEST_F(OptionsOfASceneFile, MayNotBeOverwrittenBeforeItIsThere) {
  expect_error({"a.obj", "--stats", "a.json"}, "a.json: would overwrite a.json");
}

TEST(Options, OtherValuesThatAreImpossible) {
  expect_error({"a.obj", "--engine", "gpu"}, "--engine: expected rtl, model, cpu or check");
  expect_error({"a.obj", "--variant", "e8p"}, "--variant: expected exponent bits and digits");
  expect_error({"a.obj", "--variant", "e8p10"}, "--variant: e8p10: doubts are resolved, expected");
  expect_error({"a.obj", "--variant", "e8p12", "--engine", "cpu"},
               "--engine: expected model with --variant e8p12, got cpu");
  expect_error({"a.obj", "--variant", "serial-paper", "--unit", "core"},
               "--unit: expected serial with --variant serial-paper, got core");
  expect_error({"a.obj", "--unit", "warp"}, "--unit: expected pipeline, serial, core or board");
  for (const char* lanes : {"0", "3", "16", "-1", "x"}) {
    expect_error({"a.obj", "--lanes", lanes}, "--lanes: expected 1, 2, 4 or 8");
  }
  expect_error({"a.obj", "--unit", "serial", "--lanes", "2"}, "--lanes: expected 1 with");
  for (const char* memory :
       {"latency", "latency=0", "bytes=24", "cache=3", "speed=1", "latency=1,", "bytes=128"}) {
    expect_error({"a.obj", "--unit", "core", "--memory", memory}, "--memory: expected latency=1");
  }
  expect_error({"a.obj", "--memory", "latency=9"}, "--memory: expected with --unit core");
  expect_error({"a.obj", "--cores", "2"}, "--cores: expected with --unit core");
  for (const char* cores : {"0", "65", "two"}) {
    expect_error({"a.obj", "--unit", "core", "--cores", cores}, "--cores: expected a whole number");
  }
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

TEST(Options, MisspeltOnesAreAnsweredWithTheRightOnes) {
  const std::pair<const char*, const char*> options[] = {
      {"--siz", "--size"},         {"--size2=5", "--size"},    {"--smaples", "--samples"},
      {"--integ", "--integrator"}, {"--thread", "--threads"},  {"--max_depth", "--max-depth"},
      {"--width", "--size"},       {"--height=480", "--size"}, {"--hdri", "--environment"}};
  for (const auto& [typed, meant] : options) {
    expect_error({"a.obj", typed}, std::string(typed) + ": unknown option; did you mean " + meant);
  }
  EXPECT_EQ(error_of({"a.obj", "--frobnicate"}), "--frobnicate: unknown option (see --help)");
  EXPECT_EQ(error_of({"-x", "cpu", "a.obj"}), "-x: unknown option (see --help)");
  const std::pair<const char*, const char*> values[] = {{"--engine=rlt", "rtl"},
                                                        {"--engine=CPU", "cpu"},
                                                        {"--unit=serail", "serial"},
                                                        {"--integrator=whited", "whitted"},
                                                        {"--tone=flimic", "filmic"},
                                                        {"--no-skip=recods", "records"},
                                                        {"--filter=blackman", "blackman-harris"},
                                                        {"--channels=albedo", "Albedo"}};
  for (const auto& [typed, meant] : values) {
    expect_error({"a.obj", typed}, "'; did you mean " + std::string(meant) + "?");
  }
  EXPECT_EQ(error_of({"a.obj", "--engine", "gpgpu"}),
            "--engine: expected rtl, model, cpu or check, got 'gpgpu'");
  expect_error({"a.obj", "b.obj"}, "b.obj: a second scene");
  expect_error({}, "no scene given");
}

TEST(Options, Views) {
  using Angles = std::pair<double, double>;
  EXPECT_EQ(parse({"a.obj", "--view", "front"}).camera.angles, Angles(0, 0));
  EXPECT_EQ(parse({"a.obj", "--view", "left"}).camera.angles, Angles(-90, 0));
  EXPECT_EQ(parse({"a.obj", "--view", "top"}).camera.angles, Angles(0, 90));
  EXPECT_EQ(parse({"a.obj", "--view", "-33.5,24"}).camera.angles, Angles(-33.5, 24));
  for (const char* view : {"above", "33", "33,24,1", "33,91", "0,nan", "361,0"}) {
    expect_error({"a.obj", "--view", view}, "--view: expected ");
  }
  for (const char* up : {"w", "0,0,1", "+z"})
    expect_error({"a.obj", "--up", up}, "--up: expected ");
  for (const char* fov : {"0", "180", "wide"}) {
    expect_error({"a.obj", "--fov", fov}, "--fov: expected ");
  }
  for (const char* angle : {"-1", "181", "nan", "flat"}) {
    expect_error({"a.obj", "--smooth", angle}, "--smooth: expected degrees from 0 to 180");
  }
  EXPECT_EQ(parse({"a.obj", "--smooth", "30"}).smooth, 30.0);
  expect_error({"a.obj", "--ground", "yes"}, "--ground: expected on or off");
  EXPECT_EQ(parse({"a.obj", "--ground", "off"}).camera.ground, false);
  EXPECT_FALSE(parse({"a.obj"}).camera.ground);
  expect_error({"a.obj", "--view", "top", "--camera", "0,0,9,0,0,0"},
               "--view and --camera exclude each other");
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
  EXPECT_EQ(core({"--trace-pixel", "63,47", "--trace", "a.vcd"}).core_files.pixel,
            glm::ivec2(63, 47));
  for (const char* pixel : {"64,0", "0,48", "-1,0", "1", "1,2,3", "x,y"}) {
    EXPECT_THROW((void)core({"--trace-pixel", pixel, "--trace", "a.vcd"}), InputError) << pixel;
  }
  EXPECT_THROW((void)core({"--trace", "a.vcd"}), InputError);
  EXPECT_THROW((void)core({"--trace-pixel", "1,1"}), InputError);
  EXPECT_THROW((void)core({"--dump-image", "a.obj"}), InputError);
  expect_error({"a.obj", "--dump-image", "a.bin"}, "--dump-image: expected with --unit core");
  expect_error({"a.obj", "--trace-pixel", "1,1", "--trace", "a.vcd"},
               "--trace: expected with --unit core");
}

TEST(Options, CausticsOnNeedWhatLightPathsNeed) {
  const RenderSettings off = parse({"a.obj", "--caustics", "off"}).render;
  EXPECT_EQ(off.caustics, Caustics::kOff);
  const RenderSettings on = parse({"a.obj", "--caustics", "on", "--integrator", "path"}).render;
  EXPECT_EQ(on.caustics, Caustics::kOn);
  expect_error({"a.obj", "--caustics", "maybe"}, "--caustics: expected on, off or auto");
  expect_error({"a.obj", "--caustics", "on"}, "--caustics on: expected --integrator path");
  expect_error({"a.obj", "--caustics", "on", "--integrator", "path", "--spp", "1"},
               "--caustics on: expected --spp 2 or more");
  expect_error({"a.obj", "--caustics", "on", "--integrator", "path", "--error", "1"},
               "--caustics on and --error exclude each other");
}

TEST(Options, NamesThatPeopleType) {
  EXPECT_EQ(parse({"a.obj", "--max-depth", "7"}).render.depth(), 7);
}

TEST(Options, HelpNamesEveryOptionAndFitsATerminal) {
  const std::string help = parse({"--help"}).information;
  for (const char* option : {"-o, --output",    "--size",        "--crop",
                             "--camera",        "--view",        "--up AXIS",
                             "--fov",           "--exposure",    "--ground on|off",
                             "--smooth",        "--tone",        "--channels",
                             "--false-colour",  "--save-every",  "--stats",
                             "--integrator",    "--spp",         "--samples",
                             "--resume",        "--filter",      "--depth, --max-depth",
                             "--threshold",     "--ambient",     "--seed",
                             "--engine",        "--unit",        "--lanes",
                             "--threads",       "--no-skip",     "--strict",
                             "--no-scene-file", "-q, --quiet",   "-v, --verbose",
                             "--arith",         "--point-error", "--cores",
                             "--dump-image",    "--trace",       "--trace-pixel",
                             "--caustics",      "-h, --help",    "--version"}) {
    EXPECT_NE(help.find(option), std::string::npos) << option;
  }
  for (const SkipName& skip : kSkipNames) {
    EXPECT_NE(help.find(skip.name), std::string::npos) << skip.name;
  }
  EXPECT_LE(std::ranges::count(help, '\n'), 90);
  for (std::size_t start = 0; start < help.size();) {
    const std::size_t end = help.find('\n', start);
    ASSERT_NE(end, std::string::npos);
    EXPECT_LE(end - start, 80u) << help.substr(start, end - start);
    start = end + 1;
  }
  EXPECT_EQ(parse({"-h"}).information, help);
  EXPECT_EQ(parse({"--version"}).information.substr(0, 8), "raygate ");
  EXPECT_TRUE(parse({"a.obj"}).information.empty());
}

}  // namespace
}  // namespace raygate
