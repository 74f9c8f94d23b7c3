// The program `trace` as its users run it.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "host/app/test/program.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;

class TraceRays : public testing::Test {
 protected:
  void SetUp() override {
    // Two squares across the z axis, at z = 0 and z = -2, each its own object.
    folder_.write("sheets.obj",
                  "o front\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"
                  "o back\nv -1 -1 -2\nv 1 -1 -2\nv 1 1 -2\nv -1 1 -2\nf 5 6 7 8\n");
    folder_.write("rays.csv", "0.5,0.25,1,0,0,-2\n0,0,1,0,0,1\n0.5,0.25,1,0,0,-2,0.5\n");
  }
  [[nodiscard]] Outcome trace(std::vector<std::string> arguments) const {
    return run_program({.arguments = std::move(arguments), .folder = folder_.path()});
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& line) const {
    const Outcome outcome = trace(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(outcome.err.substr(0, 7 + line.size()), "error: " + line);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }

  const TempFolder folder_{TempFolder::on_disk()};
};

TEST_F(TraceRays, SaysWhatIsNearest) {
  const Outcome outcome = trace({"sheets.obj", "rays.csv"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "ray,hit,triangle,object,t,x,y,z,u,v,nx,ny,nz,doubts\n"
            "0,1,0,0,0.5,0.5,0.25,0,0.125,0.625,0,0,1,0\n"
            "1,0,-1,-1,inf,nan,nan,nan,nan,nan,nan,nan,nan,0\n"
            "2,0,-1,-1,inf,nan,nan,nan,nan,nan,nan,nan,nan,0\n");
  EXPECT_EQ(outcome.err.substr(0, 15), "3 rays, 1 hit, ");
}

// Tests input as by `echo "0.5 0.25 1 0 0 -2" | ./trace sheets.obj -`.
TEST_F(TraceRays, ReadsRowsBetweenSpaces) {
  folder_.write("spaced.txt", "0.5 0.25 1 0 0 -2\n");
  EXPECT_EQ(trace({"sheets.obj", "spaced.txt", "--columns", "triangle,t"}).out,
            "triangle,t\n0,0.5\n");
}

TEST_F(TraceRays, SaysTheSameByEveryEngine) {
  const std::vector<std::string> common = {"sheets.obj", "rays.csv", "-q", "--columns",
                                           "ray,triangle,t,point"};
  const std::string expected = trace(common).out;
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 4);
  const std::vector<std::vector<std::string>> engines = {
      {"--engine", "rtl"},
      {"--engine", "check", "--lanes", "2"},
      {"--engine", "model"},
      {"--engine", "rtl", "--arith", "behavioural"},
      {"--engine", "rtl", "--unit", "serial"}};
  for (const std::vector<std::string>& engine : engines) {
    const Outcome outcome = trace(joined(common, engine));
    EXPECT_EQ(outcome.out, expected) << engine[1] << outcome.err;
  }
}

TEST_F(TraceRays, KeepsTheNumbersOfFaces) {
  // The first face has no area; the model has two instances.
  folder_.write("flat.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv 3 -1 0\nf 1 2 4\nf 1 2 3\n");
  folder_.write("flat.json",
                R"({"instances": [{"model": "flat.obj", "places": [[0, 0, -2], [0, 0, -4]]}]})");
  for (const char* how : {"keep", "write"}) {
    EXPECT_EQ(trace({"flat.json", "rays.csv", "--instances", how, "--hits", "all", "--columns",
                     "triangle,t,side"})
                  .out,
              "triangle,t,side\n1,0.5,-1\n3,1.5,-1\n5,2.5,-1\n")
        << how;
  }
}

TEST_F(TraceRays, HitsTheAreaLightsOfSceneFiles) {
  folder_.write("lit.json", R"({"obj": "sheets.obj", "area_lights": [
      {"corner": [-1, -1, 0.5], "edges": [[2, 0, 0], [0, 2, 0]], "radiance": 1}]})");
  EXPECT_EQ(trace({"lit.json", "rays.csv", "--hits", "all", "--columns", "triangle,object,t"}).out,
            "triangle,object,t\n4,2,0.25\n0,0,0.5\n2,1,1.5\n4,2,0.25\n");
}

TEST_F(TraceRays, SaysAllAndWhetherAny) {
  EXPECT_EQ(trace({"sheets.obj", "rays.csv", "--hits", "all", "--columns", "ray,triangle,t"}).out,
            "ray,triangle,t\n0,0,0.5\n0,2,1.5\n");
  EXPECT_EQ(trace({"sheets.obj", "rays.csv", "--hits", "any"}).out, "ray,hit\n0,1\n1,0\n2,0\n");
}

/// ./trace does not need textures.
TEST_F(TraceRays, LeavesTexturesAlone) {
  folder_.write("a.mtl", "newmtl a\nmap_Kd damaged.png\nnewmtl b\nmap_Kd missing.png\n");
  folder_.write("damaged.png", "no picture");
  folder_.write("textured.obj",
                "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nv 0 0 -1\nv 1 0 -1\n"
                "v 0 1 -1\nusemtl b\nf 4 5 6\n");
  const Outcome outcome =
      trace({"textured.obj", "rays.csv", "-q", "--hits", "all", "--columns", "ray,triangle"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "ray,triangle\n0,0\n0,1\n");
  EXPECT_EQ(outcome.err, "");
}

/// Returns more rays than a pipe holds and than are read at a time.
std::string many_rays() {
  std::string rays;
  for (int i = 0; i < 20000; ++i) rays += "0.5,0.25,1,0,0,-2\n";
  return rays;
}

/// Signals arrive while the program waits for rays, not between blocks of rays.
TEST_F(TraceRays, EndsSoonAfterASignal) {
  folder_.write("warned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
  ASSERT_EQ(::mkfifo((folder_.path() / "rays").c_str(), 0600), 0);
  for (const std::string output : {"-", "hits.csv"}) {
    std::jthread patience;
    std::atomic<bool> has_ended = false;
    const Outcome outcome = run_program(
        {.arguments = {"warned.obj", "rays", "-o", output},
         .folder = folder_.path(),
         .when_said = {{"warning", [&](int process) {
                          const int rays = ::open((folder_.path() / "rays").c_str(), O_WRONLY);
                          const std::string some = many_rays();
                          EXPECT_EQ(::write(rays, some.data(), some.size()), ssize_t(some.size()));
                          std::this_thread::sleep_for(std::chrono::milliseconds(300));
                          ::kill(process, SIGTERM);
                          patience = std::jthread([&has_ended, rays] {
                            for (int i = 0; i < 100 && !has_ended; ++i) {
                              std::this_thread::sleep_for(std::chrono::milliseconds(50));
                            }
                            EXPECT_TRUE(has_ended) << "5 seconds after the signal";
                            ::close(rays);
                          });
                        }}}});
    has_ended = true;
    EXPECT_EQ(outcome.status, 128 + SIGTERM);
    EXPECT_TRUE(contains(outcome.err, "error: interrupted; "));
    EXPECT_EQ(folder_.list(),
              (std::vector<std::string>{"rays", "rays.csv", "sheets.obj", "warned.obj"}));
  }
}

/// The output pipe is full, and its reader has stopped.
TEST_F(TraceRays, EndsSoonThoughItsReaderIsStuck) {
  folder_.write("warned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
  folder_.write("many.csv", many_rays());
  const fs::path pipe = folder_.path() / "hits.csv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  const Outcome outcome =
      run_program({.arguments = {"warned.obj", "many.csv", "-o", "hits.csv"},
                   .folder = folder_.path(),
                   .when_said = {{"warning",
                                  [](int process) {
                                    std::this_thread::sleep_for(std::chrono::milliseconds(500));
                                    ::kill(process, SIGTERM);
                                  }}},
                   .most_seconds = 10});
  ::close(reader);
  EXPECT_EQ(outcome.status, 128 + SIGTERM) << "signal " << outcome.signal;
}

TEST_F(TraceRays, GoesOnWithFewerThreads) {
  const fs::path home = folder_.path() / "home";
  fs::create_directory(home);
  fs::copy_file(RAYGATE_PROGRAM, home / "trace");
  for (const fs::path& path : {folder_.path(), home}) fs::permissions(path, fs::perms::all);
  const Outcome outcome =
      run_program({.arguments = {"sheets.obj", "rays.csv", "--threads", "4", "--columns", "t"},
                   .folder = folder_.path(),
                   .without_rights = true,
                   .most_threads = 1,
                   .program = home / "trace"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "t\n0.5\ninf\ninf\n");
}

TEST_F(TraceRays, EndsQuietlyWithItsReader) {
  folder_.write("many.csv", many_rays());
  const Outcome outcome = run_program(
      {.arguments = {"-c", RAYGATE_PROGRAM " sheets.obj many.csv --threads 1 | head -n 1"},
       .folder = folder_.path(),
       .program = "/bin/sh"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1);
  EXPECT_EQ(outcome.err, "");
}

TEST_F(TraceRays, LosesNothing) {
  folder_.write("hits.csv", "old");
  folder_.write("bad.csv", "0,0,1,0,0,1\n0,0,1,0\n");
  expect_refused({"sheets.obj", "bad.csv", "-o", "hits.csv"}, "bad.csv:2: found 4 numbers");
  EXPECT_EQ(folder_.read("hits.csv"), "old");
  expect_refused({"sheets.obj", "rays.csv", "-o", "rays.csv"},
                 "rays.csv: would overwrite rays.csv");
  EXPECT_EQ(folder_.list(),
            (std::vector<std::string>{"bad.csv", "hits.csv", "rays.csv", "sheets.obj"}));
}

TEST_F(TraceRays, RefusesWhatItCannotDo) {
  expect_refused({"sheets.obj"}, "found 'sheets.obj', expected SCENE and RAYS");
  expect_refused({"sheets.obj", "rays.csv", "more"},
                 "found 'sheets.obj, rays.csv, more', expected SCENE and RAYS");
  expect_refused({"sheets.obj", "none.csv"}, "none.csv: cannot read: No such file");
  expect_refused({"none.obj", "rays.csv"}, "none.obj: cannot read");
  const std::array<const char*, 3> options[] = {
      {"-o", "hits.txt", "--output: found 'hits.txt', expected FILE.csv or -"},
      {"--hits", "nearst", "--hits: found 'nearst', expected nearest, any or all"},
      {"--colums", "t", "--colums: unknown option (see --help)"},
      {"--columns", "ray,tt", "--columns: found 'tt', expected some of ray, hit, triangle"},
      {"--unit", "core", "--unit: found 'core', expected with --engine rtl, model or check"}};
  for (const auto& [name, value, line] : options) {
    expect_refused({"sheets.obj", "rays.csv", name, value}, line);
  }
  expect_refused({"sheets.obj", "rays.csv", "--hits", "any", "--columns", "t"},
                 "--columns: found 't', expected ray, hit or doubts with --hits any");
}

}  // namespace
}  // namespace raygate
