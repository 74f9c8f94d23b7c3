// Bad input gives one clear line and exit status 2, and leaves old files unchanged. These tests
// also run with sanitizers, where a crash or a leak changes the exit status.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <regex>

#include "host/app/test/program.h"

namespace raygate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGoodScene = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n";

class BadInput : public testing::Test {
 protected:
  /// Writes pictures and statistics of an earlier run, which must not change.
  void SetUp() override {
    for (const char* name : {"scene.exr", "scene.png", "stats.json"}) {
      folder_.write(name, std::string("old ") + name);
    }
  }

  [[nodiscard]] Outcome render(const std::vector<std::string>& arguments) const {
    return run_program(
        {.arguments =
             joined({"--engine", "cpu", "--size", "8x6", "--stats", "stats.json"}, arguments),
         .folder = folder_.path()});
  }

  void expect_old_files() const {
    for (const char* name : {"scene.exr", "scene.png", "stats.json"}) {
      EXPECT_EQ(folder_.read(name), std::string("old ") + name);
    }
    for (const std::string& name : folder_.list()) {
      EXPECT_NE(name[0], '.') << "a temporary file was left: " << name;
    }
  }

  /// Expects status 2, and one line on standard error that matches `pattern` after "error: ".
  void expect_refused(const Outcome& outcome, const std::string& pattern) const {
    EXPECT_EQ(outcome.status, 2) << "signal " << outcome.signal << "\n" << outcome.err;
    EXPECT_TRUE(std::regex_match(outcome.err, std::regex("error: " + pattern + "\n")))
        << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    expect_old_files();
  }

  const TempFolder folder_{TempFolder::on_disk()};
};

TEST_F(BadInput, TheGoodSceneIsGood) {
  folder_.write("scene.obj", kGoodScene);
  const Outcome outcome = render({"scene.obj"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(folder_.read("scene.png").substr(0, 4), "\x89PNG");
  EXPECT_EQ(folder_.read("scene.exr").substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_EQ(folder_.read("stats.json").substr(0, 1), "{");
  EXPECT_EQ(folder_.list().size(), 4u);
}

TEST_F(BadInput, MissingFile) {
  expect_refused(render({"missing.obj"}), "missing\\.obj: [^\n]+");
  folder_.write("scene.obj", kGoodScene);
  folder_.write("scene.json", "{}");
  expect_refused(render({"scene.jso"}), "scene\\.jso: found a \\.jso file, expected [^\n]+");
}

TEST_F(BadInput, UnreadableFile) {
  folder_.write("scene.obj", kGoodScene);
  ::chmod((folder_.path() / "scene.obj").c_str(), 0);
  ::chmod(folder_.path().c_str(), 0777);
  for (const char* name : {"scene.exr", "scene.png", "stats.json"}) {
    ::chmod((folder_.path() / name).c_str(), 0666);
  }
  const Outcome outcome = run_program({.arguments = {"scene.obj", "--engine", "cpu"},
                                       .folder = folder_.path(),
                                       .without_rights = true});
  expect_refused(outcome, "scene\\.obj: [^\n]+");
}

/// Files beside the scene, in a folder without access, are reported as unreadable, not missing.
TEST_F(BadInput, UnreadableFolder) {
  ::chmod(folder_.path().c_str(), 0777);
  for (const char* name : {"scene.obj", "alone.obj"}) {
    folder_.write(name, std::string("mtllib locked/m.mtl\n") + kGoodScene);
  }
  fs::create_directory(folder_.path() / "locked");
  folder_.write("scene.json", R"({"obj": "scene.obj", "environment": {"file": "locked/sky.hdr"}})");
  ::chmod((folder_.path() / "locked").c_str(), 0);
  for (const std::string scene : {"scene.json", "alone.obj"}) {
    std::vector<std::string> words{scene, "--engine", "cpu", "--size", "8x6", "-o", "new"};
    if (scene == "alone.obj") words.insert(words.end(), {"--environment", "locked/sky.hdr"});
    const Outcome outcome =
        run_program({.arguments = words, .folder = folder_.path(), .without_rights = true});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "error: locked/sky.hdr: cannot read: Permission denied\n"));
    expect_old_files();
  }
  const Outcome outcome =
      run_program({.arguments = {"alone.obj", "--engine", "cpu", "--size", "8x6", "-o", "new"},
                   .folder = folder_.path(),
                   .without_rights = true});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.err, "'locked/m.mtl' cannot be read: Permission denied"));
}

/// Unwritable outputs are reported before the scene is loaded.
TEST_F(BadInput, OutputIsCheckedFirst) {
  expect_refused(render({"missing.obj", "-o", "missing/new"}),
                 "missing/new\\.exr: cannot write: No such file or directory");
}

TEST_F(BadInput, FullDisk) {
  folder_.write("scene.obj", kGoodScene);
  for (const long limit : {1L, 200L, 600L}) {
    const Outcome outcome = run_program({.arguments = {"scene.obj", "--engine", "cpu"},
                                         .folder = folder_.path(),
                                         .file_size_limit = limit});
    expect_refused(outcome, "scene\\.exr: cannot write: File too large");
  }
  // The pictures are staged when this file fails, and must not replace the old ones.
  expect_refused(render({"scene.obj", "--stats", "/dev/full"}),
                 "/dev/full: cannot write: No space left on device");
}

TEST_F(BadInput, SceneFiles) {
  folder_.write("scene.obj", kGoodScene);
  for (const char* text : {"{\n", "{\n\"colour\": 1}", "{\"render\":\n{\"size\": \"0x0\"}}"}) {
    folder_.write("scene.json", text);
    for (const char* scene : {"scene.obj", "scene.json"}) {
      expect_refused(render({scene}), "scene\\.json:[12]: [^\n]+");
    }
  }
  folder_.write("scene.json", "{\"obj\": \"none.obj\"}");
  expect_refused(render({"scene.json"}), "scene\\.json: found no none\\.obj, expected [^\n]+");
}

/// More triangles than an index can number are reported before any loop over all triangles.
TEST_F(BadInput, TooManyInstances) {
  constexpr int kSide = 300, kPlaces = 12100;
  std::string model, places;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      model += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
      if (x == 0 || y == 0) continue;
      const int a = y * kSide + x + 1;  // number of this vertex; b: of an earlier neighbour
      for (const int b : {a - kSide - 1, a - 1}) {
        model += "f " + std::to_string(a) + " " + std::to_string(b) + " " +
                 std::to_string(b == a - 1 ? a - kSide - 1 : a - kSide) + "\n";
      }
    }
  }
  for (int i = 0; i < kPlaces; ++i) places += (i == 0 ? "[" : ",\n[") + std::to_string(i) + ",0,0]";
  folder_.write("model.obj", model);
  folder_.write("scene.obj", kGoodScene);
  folder_.write("scene.json",
                R"({"instances": [{"model": "model.obj", "places": [)" + places + "]}]}");
  expect_refused(render({"scene.obj"}),
                 "scene\\.json: found 2163504202 triangles with all instances, expected fewer than "
                 "2\\^31");
}

TEST_F(BadInput, VectorsThatNoMachineHas) {
  folder_.write("scene.obj", kGoodScene);
  setenv("RAYGATE_VECTORS", "sse9", 1);
  expect_refused(render({"scene.obj"}), "RAYGATE_VECTORS: found sse9, expected one .*: baseline.*");
  unsetenv("RAYGATE_VECTORS");
  expect_old_files();
}

/// Coordinates are so extreme that differences, products or the camera's distance overflow float.
TEST_F(BadInput, ExtremeCoordinatesNeverCrash) {
  for (const char* size : {"1e-40", "1e-30", "1e15", "1e30", "3e38", "1e300"}) {
    SCOPED_TRACE(size);
    const std::string s = size;
    folder_.write("scene.obj", "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nf 1 2 3\n");
    const Outcome outcome = render({"scene.obj", "-o", "new"});
    EXPECT_EQ(outcome.signal, 0);
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << outcome.err;
    EXPECT_FALSE(contains(outcome.err, "runtime error"));
  }
}

}  // namespace
}  // namespace raygate
