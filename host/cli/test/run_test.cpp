// What a run says on its way, and at its end; interruption.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "host/cli/test/render_run.h"
#include "host/film/test/exr_reader.h"

namespace raygate {
namespace {

TEST_F(Render, ProgressBarOnTerminalsOnly) {
  const std::vector<std::string> arguments{kCornell, "--size", "64x48"};
  const Outcome piped = run_program({.arguments = arguments, .folder = folder_.path()});
  EXPECT_EQ(piped.status, 0);
  EXPECT_EQ(piped.err, "");
  const Outcome shown =
      run_program({.arguments = arguments, .folder = folder_.path(), .terminal = true});
  EXPECT_EQ(shown.status, 0);
  EXPECT_NE(shown.err.find("rendering ["), std::string::npos) << shown.err;
  const std::string erased = "\r\x1b[K";
  ASSERT_GE(shown.err.size(), erased.size());
  EXPECT_EQ(shown.err.substr(shown.err.size() - erased.size()), erased) << "the bar stays";
  std::vector<std::string> quiet = arguments;
  quiet.push_back("--quiet");
  const Outcome silent =
      run_program({.arguments = quiet, .folder = folder_.path(), .terminal = true});
  EXPECT_EQ(silent.status, 0);
  EXPECT_EQ(silent.err, "");
  EXPECT_EQ(silent.out, "");
}

TEST_F(Render, InterruptedRunsWriteWhatThereIs) {
  for (const int signal : {SIGINT, SIGTERM}) {
    // A crop without the empty border, so that the first tile has something to see.
    const Outcome outcome =
        run_program({.arguments = {kCornell, "--size", "640x480", "--crop", "200,120,520,440",
                                   "--threads", "1", "--spp", "4", "-o", "a", "--stats", "s.json"},
                     .folder = folder_.path(),
                     .terminal = true,
                     .signal_when_busy = signal});
    EXPECT_EQ(outcome.status, 128 + signal);
    ASSERT_NE(outcome.err.find("error: interrupted; wrote what there was: a.exr, a.png"),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(folder_.list(), (std::vector<std::string>{"a.exr", "a.png"}));
    ExrReader partial(folder_.read("a.exr"));
    EXPECT_EQ(partial.text("partial"), "not finished when it was saved");
    const auto ids = partial.read<std::uint32_t>("id", Imf::UINT);
    ASSERT_EQ(ids.size(), 102400u);
    const auto missing = std::ranges::count(ids, 4294967295u);
    EXPECT_GT(missing, 0);
    EXPECT_LT(missing, 102400);
    EXPECT_NE(folder_.read("a.png").find("tEXtComment\0not finished when it was saved"s),
              std::string::npos);
    fs::remove(folder_.path() / "a.exr");
    fs::remove(folder_.path() / "a.png");
  }
}

TEST_F(Render, StatisticsAreWholeAndAgree) {
  const Outcome outcome =
      render({kCornell, "--size", "60x50", "--threads", "2", "--seed", "9", "-o", "a.png"});
  const std::set<std::string> expected{
      "software",      "scene",          "triangles",       "width",
      "height",        "window",         "engine",          "unit",
      "threads",       "seed",           "pictures",        "rays",
      "records",       "tests",          "misses",          "hits",
      "edge_doubts",   "depth_doubts",   "exact_inside",    "exact_depth",
      "plane_tests",   "clocks",         "clocks_per_test", "seconds",
      "lanes",         "unit_tests",     "quotients",       "idle_clocks",
      "output_stalls", "thread_seconds", "integrator",      "spp",
      "depth",         "camera_rays",    "shadow_rays",     "common_records",
      "skipped",       "input_bytes",     "arith",
      "point_doubts"};
  std::set<std::string> actual;
  for (const auto& [key, value] : stats_.items()) actual.insert(key);
  EXPECT_EQ(actual, expected);
  EXPECT_EQ(stats_.at("camera_rays"), 60 * 50);
  EXPECT_GT(stats_.at("shadow_rays"), 0);
  EXPECT_EQ(stats_.at("window"), (json{0, 0, 60, 50}));
  EXPECT_EQ(stats_.at("engine"), "rtl");
  EXPECT_EQ(stats_.at("unit"), "pipeline");
  EXPECT_EQ(stats_.at("seed"), 9);
  EXPECT_EQ(stats_.at("pictures"), json{"a.png"});
  const auto count = [&](const char* key) { return stats_.at(key).get<std::uint64_t>(); };
  EXPECT_EQ(count("misses") + count("hits") + count("edge_doubts"), count("tests"));
  EXPECT_GT(count("hits"), 0u);
  EXPECT_EQ(count("unit_tests"), count("tests"));
  EXPECT_EQ(count("input_bytes"), 64 * count("tests"));
  EXPECT_GE(count("clocks"), count("tests"));
  EXPECT_DOUBLE_EQ(stats_.at("clocks_per_test").get<double>(),
                   static_cast<double>(count("clocks")) / static_cast<double>(count("unit_tests")));
  const json& seconds = stats_.at("seconds");
  double parts = 0.0;
  for (const char* part : {"load", "tree", "render", "write"}) {
    EXPECT_GE(seconds.at(part), 0.0);
    parts += seconds.at(part).get<double>();
  }
  EXPECT_LE(parts, seconds.at("total").get<double>() + 1e-3);
  // The text says the same.
  EXPECT_NE(outcome.out.find("cornell.obj: "), std::string::npos);
  EXPECT_NE(outcome.out.find("60x50, engine rtl, unit pipeline (structural), 2 threads\n"), std::string::npos);
  for (const char* row : {"\nrays ", "\ntests ", "\nhits ", "\ndoubts ", "\nclocks ", "\ntime "}) {
    EXPECT_NE(outcome.out.find(row), std::string::npos) << row;
  }
}

TEST_F(Render, WarningsAreSaidOnce) {
  folder_.write("a.obj",
                "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
                "usemtl red\nf 1 3 2\n");
  const Outcome outcome = render({"a.obj", "--size", "4x4", "--engine", "cpu", "--quiet"});
  std::multiset<std::string> lines;
  for (std::size_t start = 0; start < outcome.err.size();) {
    const std::size_t end = outcome.err.find('\n', start);
    ASSERT_NE(end, std::string::npos);
    lines.insert(outcome.err.substr(start, end - start));
    start = end + 1;
  }
  EXPECT_FALSE(lines.empty());
  for (const std::string& line : lines) {
    EXPECT_EQ(line.substr(0, 15), "warning: a.obj:") << line;
    EXPECT_EQ(lines.count(line), 1u) << line;
  }
}

TEST_F(Render, HelpAndVersionGoToStandardOutput) {
  for (const char* option : {"--help", "-h", "--version"}) {
    const Outcome outcome = run_program({.arguments = {option}, .folder = folder_.path()});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
  }
}

}  // namespace
}  // namespace raygate
