// Which files are written, what they show, and how light is followed.
#include <filesystem>
#include <limits>

#include "host/app/test/parsed.h"

namespace raygate {
namespace {

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
  expect_error({"a.obj", "-o", "x.jpg"}, ".exr or .png");
  expect_error({"a.obj", "-o", ""}, "--output");
}

TEST(OutputOptions, ChannelsByName) {
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

TEST(OutputOptions, WhatThePngShows) {
  EXPECT_EQ(parse({"a.obj"}).output.display.exposure, 0.0);
  EXPECT_EQ(parse({"a.obj", "--exposure", "-1.5"}).output.display.exposure, -1.5);
  EXPECT_EQ(parse({"a.obj"}).output.display.tone, Tone::kClip);
  EXPECT_EQ(parse({"a.obj", "--tone", "filmic"}).output.display.tone, Tone::kFilmic);
  for (const char* stops : {"bright", "101", "nan", "inf", "1,5"}) {
    expect_error({"a.obj", "--exposure", stops}, "--exposure: expected a number of stops");
  }
  expect_error({"a.obj", "--tone", "aces"}, "--tone: expected clip or filmic");
}

TEST(OutputOptions, FalseColours) {
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

TEST(OutputOptions, LightByName) {
  const RenderSettings plain = parse({"a.obj"}).render;
  EXPECT_EQ(plain.integrator, IntegratorKind::kWhitted);
  EXPECT_EQ(plain.depth(), 4);
  for (const char* engine : {"rtl", "model", "cpu", "check"}) {
    EXPECT_EQ(parse({"a.obj", "--engine", engine}).render.samples, 4) << "whatever the engine";
  }
  EXPECT_EQ(parse({"a.obj", "--engine", "cpu", "--spp", "1"}).render.samples, 1);
  const RenderSettings path =
      parse({"a.obj", "--integrator", "path", "--spp", "16", "--filter", "tent", "--threshold",
             "0.5", "--ambient", "0", "--no-skip", "culling,records"})
          .render;
  EXPECT_EQ(path.integrator, IntegratorKind::kPath);
  EXPECT_EQ(path.depth(), 64);
  EXPECT_EQ(path.samples, 16);
  EXPECT_EQ(path.filter, ReconstructionFilter::kTent);
  EXPECT_EQ(path.threshold, 0.5);
  EXPECT_EQ(path.ambient, 0.0);
  EXPECT_FALSE(path.skips.culling || path.skips.records);
  EXPECT_TRUE(path.skips.weightless && path.skips.divisions);
  EXPECT_EQ(parse({"a.obj", "--depth", "0"}).render.depth(), 0);
  EXPECT_EQ(plain.point_error, 0x1p-16f);
  const auto point_error = [](const char* text) {
    return parse({"a.obj", "--point-error", text}).render.point_error;
  };
  EXPECT_EQ(point_error("0"), 0.0f);
  EXPECT_EQ(point_error("1e-4"), 1e-4f);
  EXPECT_EQ(point_error("inf"), std::numeric_limits<float>::max());
  const Skips none = parse({"a.obj", "--no-skip", "all"}).render.skips;
  for (const SkipName& skip : kSkipNames) EXPECT_FALSE(none.*skip.on) << skip.name;
  expect_error({"a.obj", "--integrator", "photon"}, "--integrator: expected primary, whitted or");
  expect_error({"a.obj", "--spp", "0"}, "--spp: expected a whole number from 1");
  expect_error({"a.obj", "--depth", "-1"}, "--depth: expected a whole number from 0");
  expect_error({"a.obj", "--filter", "lanczos"}, "--filter: expected box, tent, gauss");
  expect_error({"a.obj", "--threshold", "2"}, "--threshold: expected a number from 0 to 1");
  expect_error({"a.obj", "--threshold", "nan"}, "--threshold: expected");
  expect_error({"a.obj", "--point-error", "-1"}, "--point-error: expected a share of the distance");
  expect_error({"a.obj", "--point-error", "nan"},
               "--point-error: expected a share of the distance");
  expect_error({"a.obj", "--ambient", "inf"}, "--ambient: expected a radiance");
  expect_error({"a.obj", "--no-skip", "rays"}, "--no-skip: expected some of culling, records");
}

}  // namespace
}  // namespace raygate
