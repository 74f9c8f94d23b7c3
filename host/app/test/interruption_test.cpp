// Interrupted runs, and runs that continue after a failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "host/app/test/render_run.h"
#include "host/film/test/exr_reader.h"

namespace raygate {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kSoon = 10.0;  // seconds, on a busy machine; a whole run takes minutes

TEST_F(Render, InterruptedRunsWriteWhatThereIs) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    // The crop excludes the empty border, so the first tile shows something.
    const Outcome outcome =
        run_program({.arguments = {kCornell, "--size", "640x480", "--crop", "200,120,520,440",
                                   "--threads", "1", "--spp", "4", "-o", "a", "--stats", "s.json"},
                     .folder = folder_.path(),
                     .terminal = true,
                     .signal_when_busy = signal});
    EXPECT_EQ(outcome.status, 128 + signal);
    ASSERT_TRUE(contains(outcome.err, "error: interrupted; wrote what there was: a.exr, a.png"));
    EXPECT_EQ(folder_.list(), (std::vector<std::string>{"a.exr", "a.png"}));
    ExrReader partial(folder_.read("a.exr"));
    EXPECT_EQ(partial.text("partial"), "not finished when it was saved");
    const auto ids = partial.read<std::uint32_t>("id", Imf::UINT);
    ASSERT_EQ(ids.size(), 102400u);
    const auto missing = std::ranges::count(ids, 4294967295u);
    EXPECT_GT(missing, 0);
    EXPECT_LT(missing, 102400);
    EXPECT_TRUE(contains(folder_.read("a.png"), "tEXtComment\0not finished when it was saved"s));
    fs::remove(folder_.path() / "a.exr");
    fs::remove(folder_.path() / "a.png");
  }
}

/// Sends SIGINT half a second after the progress line appears. Returns the seconds to the exit.
double seconds_to_answer(const fs::path& folder, std::vector<std::string> arguments) {
  Clock::time_point sent;
  const Outcome outcome =
      run_program({.arguments = std::move(arguments),
                   .folder = folder,
                   .terminal = true,
                   .when_said = {{"rendering: ", [&](int process) {
                                    std::this_thread::sleep_for(std::chrono::milliseconds(500));
                                    sent = Clock::now();
                                    ::kill(process, SIGINT);
                                  }}}});
  EXPECT_EQ(outcome.status, 128 + SIGINT) << outcome.err;
  return std::chrono::duration<double>(Clock::now() - sent).count();
}

/// Every ray meets all triangles, because no BVH can separate them. So one batch takes minutes.
TEST_F(Render, InterruptionIsAnsweredAmongCoincidentTriangles) {
  std::string obj = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\n";
  for (int i = 0; i < 300000; ++i) obj += "f 1 2 3\n";
  folder_.write("a.obj", obj);
  EXPECT_LT(seconds_to_answer(folder_.path(), {"a.obj", "--engine", "cpu"}), kSoon);
}

TEST_F(Render, InterruptionIsAnsweredAmongLights) {
  std::string obj = "mtllib a.mtl\nusemtl lamp\n";
  constexpr int kSide = 447;  // squared: 200,000
  for (int i = 0; i < kSide * kSide; ++i) {
    const std::string x = std::to_string(i % kSide), z = std::to_string(i / kSide);
    obj += "o " + std::to_string(i) + "\nv " + x + " 9 " + z + "\nv " + x + ".5 9 " + z + "\nv " +
           x + " 9 " + z + ".5\n" + "f -3 -2 -1\n";
  }
  obj += "usemtl matte\nv 0 0 0\nv 447 0 0\nv 0 0 447\nv 447 0 447\nf -4 -3 -1 -2\n";
  folder_.write("a.obj", obj);
  folder_.write("a.mtl", "newmtl lamp\nKe 1 1 1\nnewmtl matte\nKd 1 1 1\n");
  EXPECT_LT(seconds_to_answer(folder_.path(),
                              {"a.obj", "--engine", "cpu", "--camera", "220,5,-10,220,0,220"}),
            kSoon);
}

TEST_F(Render, AFailedSaveIsTriedAgain) {
  fs::create_directory(folder_.path() / "out");
  const auto rename = [&](const char* from, const char* to) {
    fs::rename(folder_.path() / from, folder_.path() / to);
  };
  std::atomic<bool> saved = false;
  std::jthread onlooker;  // this thread must read the program's output
  const Outcome outcome = run_program(
      {.arguments = {kCornell, "--engine", "cpu", "--threads", "2", "--spp", "65536",
                     "--save-every", "0.1", "-o", "out/a.png"},
       .folder = folder_.path(),
       .terminal = true,
       .when_said = {{"rendering: ", [&](int) { rename("out", "away"); }},
                     {"warning: out/a.png: cannot write: No such file or directory; the render "
                      "goes on",
                      [&](int process) {
                        rename("away", "out");
                        fs::remove(folder_.path() / "out" / "a.png");
                        onlooker = std::jthread([&, process] {
                          for (int i = 0; i < 600 && !saved; ++i) {
                            std::this_thread::sleep_for(std::chrono::milliseconds(50));
                            saved = fs::exists(folder_.path() / "out" / "a.png");
                          }
                          ::kill(process, SIGINT);
                        });
                      }}}});
  EXPECT_TRUE(saved) << outcome.err;
  EXPECT_EQ(outcome.status, 128 + SIGINT) << outcome.err;
}

/// If threads cannot start, fewer threads make the same picture. The program is in a folder that
/// its user may not enter, as if the repository were in root's home.
TEST_F(Render, ThreadsThatCannotStartAreDoneWithout) {
  const fs::path home = folder_.path() / "home";
  fs::create_directory(home);
  fs::copy_file(RAYGATE_PROGRAM, home / "render");
  fs::permissions(home, fs::perms::owner_all);
  for (const char* name : {"cornell.obj", "cornell.mtl", "cornell.json"}) {
    fs::copy_file(fs::path(RAYGATE_SCENES) / name, folder_.path() / name);
  }
  (void)render({"cornell.obj", "--size", "64x48", "--engine", "cpu", "--spp", "4", "-o", "a"});
  fs::permissions(folder_.path(), fs::perms::all);
  const Outcome outcome =
      run_program({.arguments = {"cornell.obj", "--size", "64x48", "--engine", "cpu", "--spp", "4",
                                 "--threads", "4", "-o", "b"},
                   .folder = folder_.path(),
                   .without_rights = true,
                   .most_threads = 1,
                   .program = home / "render"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expect_same_pictures("a", "b");
}

}  // namespace
}  // namespace raygate
