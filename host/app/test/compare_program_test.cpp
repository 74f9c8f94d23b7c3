// The program `compare` as its users run it: exit status, what it prints, the difference picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/app/test/program.h"
#include "host/film/display.h"
#include "host/film/exr.h"
#include "host/film/test/sample_film.h"

namespace raygate {
namespace {

using nlohmann::json;

class ComparePictures : public testing::Test {
 protected:
  void SetUp() override {
    Film film = make_sample_film(40, 30, {0, 0, 40, 30});
    folder_.write("a.exr", encode_exr(film, {}));
    film.color[77].g += 0.25f;
    folder_.write("b.exr", encode_exr(film, {}));
    folder_.write("crop.exr", encode_exr(make_sample_film(40, 30, {3, 4, 9, 9}), {}));
    folder_.write("small.exr", encode_exr(make_sample_film(20, 30, {0, 0, 20, 30}), {}));
    folder_.write("text.exr", "no picture");
  }
  [[nodiscard]] Outcome compare(std::vector<std::string> arguments) const {
    return run_program({.arguments = std::move(arguments), .folder = folder_.path()});
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& line) const {
    const Outcome outcome = compare(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(outcome.err.substr(0, 7 + line.size()), "error: " + line);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }

  ScratchFolder folder_;
};

TEST_F(ComparePictures, SaysHowFarTheyAre) {
  const Outcome outcome = compare({"a.exr", "b.exr", "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const json measures = json::parse(outcome.out);
  EXPECT_EQ(measures.at("pixels"), 1200);
  EXPECT_EQ(measures.at("differing"), 1);
  EXPECT_EQ(measures.at("max"), 0.25);
  EXPECT_DOUBLE_EQ(measures.at("mse").get<double>(), 0.0625 / 3600);
  EXPECT_LT(measures.at("ssim"), 1.0);
  const Outcome text = compare({"a.exr", "b.exr"});
  EXPECT_NE(text.out.find("\nmax           0.25\n"), std::string::npos) << text.out;
  const Outcome same = compare({"a.exr", "a.exr"});
  EXPECT_NE(same.out.find("psnr          inf\nssim          1\ndiffering     0\n"),
            std::string::npos)
      << same.out;
}

TEST_F(ComparePictures, PngsAreReadAsTheLightThatTheyShow) {
  const Image8 dark{20, 20, {0, 0, 20, 20}, std::vector<Rgb8>(400, {0, 0, 0}), {}};
  Image8 dot = dark;
  dot.pixels[30] = {0, 255, 0};
  folder_.write("dark.png", encode_png(dark));
  folder_.write("dot.png", encode_png(dot));
  const json measures = json::parse(compare({"dot.png", "dark.png", "--json"}).out);
  EXPECT_EQ(measures.at("pixels"), 400);
  EXPECT_EQ(measures.at("differing"), 1);
  EXPECT_EQ(measures.at("max"), 1.0);
  EXPECT_DOUBLE_EQ(measures.at("mse").get<double>(), 1.0 / 1200);
  expect_refused({"dark.png", "dot.png", "--channels", "Z"}, "dark.png: has no channel Z");
  // The picture beside an EXR.
  Film film = make_film(20, 20, {0, 0, 20, 20}, {});
  for (glm::vec4& color : film.color) color = {0.5f, 0.25f, 0.125f, 1.0f};
  folder_.write("a20.exr", encode_exr(film, {}));
  folder_.write("a20.png", encode_png(to_display(film)));
  EXPECT_EQ(compare({"a20.png", "a20.exr", "--threshold", "max=0.005"}).status, 0);
}

TEST_F(ComparePictures, ThresholdsDecideTheStatus) {
  EXPECT_EQ(compare({"a.exr", "b.exr", "--threshold", "max=0.25"}).status, 0);
  const Outcome exceeded =
      compare({"a.exr", "b.exr", "--threshold", "max=0.2", "--threshold", "mse=1"});
  EXPECT_EQ(exceeded.status, 1);
  EXPECT_EQ(exceeded.err, "threshold max=0.2 is exceeded\n");
  EXPECT_EQ(compare({"a.exr", "b.exr", "--threshold", "psnr=40"}).status, 0);
  EXPECT_EQ(compare({"a.exr", "b.exr", "--threshold", "psnr=60"}).status, 1);
  EXPECT_EQ(compare({"a.exr", "a.exr", "--threshold", "differing=0"}).status, 0);
  EXPECT_EQ(compare({"a.exr", "b.exr", "--channels", "Z,id", "--threshold", "max=0"}).status, 0);
}

TEST_F(ComparePictures, DifferenceAsAPicture) {
  const Outcome outcome = compare({"a.exr", "b.exr", "--difference", "d.png"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("difference: 0 (dark violet) to 0.25 (yellow)"), std::string::npos);
  EXPECT_EQ(folder_.read("d.png").substr(0, 4), "\x89PNG");
  EXPECT_EQ(compare({"a.exr", "b.exr", "--difference", "d.png", "--scale", "1"}).status, 0);
}

TEST_F(ComparePictures, WhatCannotBeComparedIsRefused) {
  expect_refused({"a.exr", "small.exr"}, "the pictures differ in size: 40x30 and 20x30");
  expect_refused({"a.exr", "none.exr"}, "none.exr: cannot read: ");
  expect_refused({"text.exr", "a.exr"}, "text.exr: not an OpenEXR file");
  expect_refused({"a.exr", "b.exr", "--channels", "P.X"}, "a.exr: no channel P.X; ");
  expect_refused({"a.exr", "b.exr", "--channels", "R,,G"}, "--channels: expected ");
  expect_refused({"a.exr", "b.exr", "--threshold", "beauty=1"}, "--threshold: expected ");
  EXPECT_NE(compare({"a.exr", "b.exr", "--threshold", "rsme=1"}).err.find("did you mean rmse?"),
            std::string::npos);
  expect_refused({"a.exr", "b.exr", "--threshold", "mse"}, "--threshold: expected ");
  expect_refused({"a.exr", "crop.exr", "--threshold", "ssim=1"}, "--threshold: ssim needs ");
  for (const char* scale : {"-1", "0", "nan", "inf", "x"}) {
    expect_refused({"a.exr", "b.exr", "--difference", "d.png", "--scale", scale},
                   "--scale: expected a number above 0");
  }
  expect_refused({"a.exr", "b.exr", "--scale", "1"}, "--scale: expected --difference beside it");
  expect_refused({"a.exr", "b.exr", "--difference", "d"}, "--difference: expected FILE.png");
  expect_refused({"a.exr", "b.exr", "--difference", "none/d.png"}, "none/d.png: cannot write: ");
  expect_refused({"a.exr", "b.exr", "c.exr"}, "");
  expect_refused({"a.exr"}, "");
}

TEST_F(ComparePictures, InputsAreKept) {
  const std::string before = folder_.read("a.exr");
  expect_refused({"a.exr", "b.exr", "--difference", "a.exr"}, "a.exr: would overwrite a.exr");
  expect_refused({"b.exr", "a.exr", "--difference", "./a.exr"}, "./a.exr: would overwrite a.exr");
  EXPECT_EQ(folder_.read("a.exr"), before);
}

TEST_F(ComparePictures, FullDisksAreErrors) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"a.exr", "b.exr"}, {"a.exr", "b.exr", "--json"}, {"--help"}}) {
    const Outcome outcome =
        run_program({.arguments = arguments, .folder = folder_.path(), .out_file = "/dev/full"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err, "error: standard output: cannot write: No space left on device\n");
  }
  const Outcome limited = run_program({.arguments = {"a.exr", "b.exr", "--difference", "d.png"},
                                       .folder = folder_.path(),
                                       .file_size_limit = 100});
  EXPECT_EQ(limited.signal, 0);
  EXPECT_EQ(limited.status, 2);
  EXPECT_EQ(limited.err, "error: d.png: cannot write: File too large\n");
}

TEST_F(ComparePictures, ControlCharactersDoNotReachTheTerminal) {
  std::string bytes = folder_.read("a.exr");
  const std::string depth("Z\0\2\0\0\0", 6);  // the channel's name, and that it is float
  ASSERT_NE(bytes.find(depth), std::string::npos);
  bytes[bytes.find(depth)] = '\x1b';
  folder_.write("odd.exr", bytes);
  const Outcome listed = compare({"odd.exr", "b.exr", "--channels", "none"});
  EXPECT_EQ(listed.status, 2);
  EXPECT_NE(listed.err.find("\\x1B"), std::string::npos) << listed.err;
  EXPECT_EQ(listed.err.find('\x1b'), std::string::npos) << listed.err;
  const Outcome drawn = compare({"a.exr", "b.exr", "--difference", "\x1b[31m.png"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(drawn.out.find('\x1b'), std::string::npos) << drawn.out;
}

}  // namespace
}  // namespace raygate
