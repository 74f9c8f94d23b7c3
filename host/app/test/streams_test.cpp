// Tests standard output, pipes and terminals as targets of a run's output.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "host/app/test/render_run.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

const std::vector<std::string> kSmall{kCornell, "--size", "16x12", "--engine", "cpu"};

std::vector<std::string> small(const std::vector<std::string>& more) {
  return joined(kSmall, more);
}

TEST_F(Render, AFullDiskUnderStandardOutputIsAnError) {
  for (const auto& arguments : {kSmall, {"--help"}, {"--version"}}) {
    const Outcome outcome =
        run_program({.arguments = arguments, .folder = folder_.path(), .out_file = "/dev/full"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err, "error: standard output: cannot write: No space left on device\n");
  }
}

TEST_F(Render, StatisticsGoToStandardOutputAlone) {
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1"}) {
    for (const char* file : {"", "out.json"}) {
      SCOPED_TRACE(std::string(name) + " " + file);
      const Outcome outcome = run_program({.arguments = small({"--stats", name, "-o", "a.png"}),
                                           .folder = folder_.path(),
                                           .out_file = file});
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      const json stats =
          json::parse(*file == '\0' ? outcome.out : folder_.read(file), nullptr, false);
      ASSERT_FALSE(stats.is_discarded());
      EXPECT_EQ(stats.at("width"), 16);
      EXPECT_TRUE(contains(outcome.err, "cornell.obj: ")) << "the summary is elsewhere";
    }
  }
}

/// Reading the pipe a second time would block for ever.
TEST_F(Render, AnEnvironmentFromAPipeIsReadOnce) {
  const std::filesystem::path pipe = folder_.path() / "sky.hdr";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::jthread writer([&] {
    std::ofstream(pipe) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x01\x02\x03\x80";
  });
  const Outcome outcome = run(small({"--environment", "sky.hdr"}));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST_F(Render, HelpThatNobodyReadsOnEndsWithoutAWord) {
  const Outcome outcome = run_program({.arguments = {"-c", RAYGATE_PROGRAM " --help | true"},
                                       .folder = folder_.path(),
                                       .program = "/bin/sh"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
}

/// "\x1b]0;gotcha\a" sets a terminal's title; U+009B begins a sequence, too.
TEST_F(Render, ControlCharactersDoNotReachTheTerminal) {
  const std::string name = "a\x1b]0;gotcha\a\x7f\xc2\x9b.obj";
  const auto expect_clean = [](const std::string& text) {
    for (const char* c : {"\x1b", "\a", "\x7f", "\x9b"}) {
      EXPECT_FALSE(contains(text, c));
    }
  };
  Outcome outcome = run({name});
  EXPECT_EQ(outcome.status, 2);
  expect_clean(outcome.err);
  EXPECT_TRUE(contains(outcome.err, "a\\x1B]0;gotcha\\x07\\x7F\\xC2\\x9B.obj"));
  // Checks a warning, the summary and the statistics.
  folder_.write(name, "mtllib \x1b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  outcome = run({name, "--size", "4x4", "--engine", "cpu", "--stats", "-"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.err, "warning: "));
  expect_clean(outcome.err);
  expect_clean(outcome.out);
  outcome = run({name, "--size", "4x4", "--engine", "cpu"});
  EXPECT_TRUE(contains(outcome.out, "gotcha"));
  expect_clean(outcome.out);
  const std::string lines = "a\nb.obj";
  folder_.write(lines, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  outcome = run({lines, "--size", "4x4", "--engine", "cpu"});
  EXPECT_EQ(outcome.out.substr(0, 12), "a\\x0Ab.obj: ");
  EXPECT_FALSE(contains(outcome.out, "a\nb"));
  // Other characters are kept: letters of all languages.
  folder_.write("Grüße 光.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  outcome = run({"Grüße 光.obj", "--size", "4x4", "--engine", "cpu"});
  EXPECT_TRUE(contains(outcome.out, "Grüße 光.obj"));
}

/// No output replaces a file that the scene was read from, under any of its names.
TEST_F(Render, InputsAreKept) {
  const std::string obj =
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
  const std::string mtl = "newmtl m\nmap_Kd m.png\n";
  const std::string png = test::tga(1, 1, {{1, 2, 3}});
  folder_.write("m.obj", obj);
  folder_.write("m.mtl", mtl);
  folder_.write("m.png", png);
  folder_.write("s.json", "{\"obj\": \"m.obj\"}");
  fs::create_hard_link(folder_.path() / "m.obj", folder_.path() / "hard.exr");
  const std::vector<std::vector<std::string>> runs{
      {"m.obj"},
      {"m.obj", "-o", "a.png", "--stats", "m.mtl"},
      {"m.obj", "-o", "hard.exr"},
      {"m.obj", "-o", "a.png", "--false-colour", "Z=m.png"},
      {"s.json", "-o", "a.png", "--stats", "s.json"}};
  for (const std::vector<std::string>& arguments : runs) {
    const Outcome outcome = run(joined(arguments, {"--size", "4x4", "--engine", "cpu"}));
    EXPECT_EQ(outcome.status, 2) << arguments[0];
    EXPECT_TRUE(contains(outcome.err, ": would overwrite "));
  }
  EXPECT_EQ(folder_.read("m.obj"), obj);
  EXPECT_EQ(folder_.read("m.mtl"), mtl);
  EXPECT_EQ(folder_.read("m.png"), png);
  EXPECT_EQ(folder_.list(),
            (std::vector<std::string>{"hard.exr", "m.mtl", "m.obj", "m.png", "s.json"}));
}

}  // namespace
}  // namespace raygate
