// Output of a run: progress, warnings, summary and statistics.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "host/app/test/render_run.h"

namespace raygate {
namespace {

TEST_F(Render, ProgressOnTerminalsOnly) {
  const std::vector<std::string> arguments{kCornell, "--size", "64x48"};
  const Outcome piped = run(arguments);
  EXPECT_EQ(piped.status, 0);
  EXPECT_EQ(piped.err, "");
  const Outcome shown =
      run_program({.arguments = arguments, .folder = folder_.path(), .terminal = true});
  EXPECT_EQ(shown.status, 0);
  EXPECT_TRUE(contains(shown.err, "rendering: "));
  const std::string erased = "\r\x1b[K";
  ASSERT_GE(shown.err.size(), erased.size());
  EXPECT_EQ(shown.err.substr(shown.err.size() - erased.size()), erased) << "the line stays";
  const Outcome silent = run_program(
      {.arguments = joined(arguments, {"--quiet"}), .folder = folder_.path(), .terminal = true});
  EXPECT_EQ(silent.status, 0);
  EXPECT_EQ(silent.err, "");
  EXPECT_EQ(silent.out, "");
}

/// Returns all keys, as "seconds.load" for a nested key.
std::set<std::string> keys_of(const json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) {
    if (!value.is_object()) keys.insert(key);
    if (value.is_object()) {
      for (const std::string& inner : keys_of(value)) keys.insert(key + "." + inner);
    }
  }
  return keys;
}

TEST_F(Render, StatisticsAgree) {
  const Outcome outcome = render(
      {kCornell, "--size", "60x50", "--spp", "1", "--threads", "2", "--seed", "9", "-o", "a.png"});
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
  // The summary agrees.
  EXPECT_TRUE(contains(outcome.out, "cornell.obj: "));
  EXPECT_TRUE(contains(outcome.out, "60x50, engine rtl (pipeline, structural), 2 threads\n"));
  for (const char* row : {"\nrays ", "\ntests ", "\nrounded ", "\nwrote "}) {
    EXPECT_TRUE(contains(outcome.out, row)) << row;
  }
  EXPECT_EQ(std::ranges::count(outcome.out, '\n'), 5) << outcome.out;
}

TEST_F(Render, TheSummaryNamesNoUnitWhereNoneIsAtWork) {
  const Outcome brief = render({kCornell, "--size", "60x50", "--engine", "cpu"});
  EXPECT_EQ(std::ranges::count(brief.out, '\n'), 5) << brief.out;
  EXPECT_FALSE(contains(brief.out, "unit"));
  EXPECT_TRUE(contains(brief.out, " rays/s\n"));
  EXPECT_TRUE(contains(brief.out, " tests/s\n"));
  for (std::size_t start = 0; start < brief.out.size(); start = brief.out.find('\n', start) + 1) {
    EXPECT_LE(brief.out.find('\n', start) - start, 80u) << brief.out;
  }
  const Outcome verbose = render({kCornell, "--size", "60x50", "--engine", "cpu", "--verbose"});
  for (const std::string& key : keys_of(stats_)) {
    const bool is_number =
        stats_.at(json::json_pointer("/" + std::regex_replace(key, std::regex("\\."), "/")))
            .is_number();
    const bool is_option = key == "width" || key == "height" || key == "lanes" || key == "cores" ||
                           key == "threads" || key == "spp" || key == "error" || key == "depth" ||
                           key == "seed";
    EXPECT_EQ(verbose.out.find("\n" + key + " ") != std::string::npos, is_number && !is_option)
        << key;
  }
}

// Runs the program that `make cpu` builds.
TEST_F(Render, WithoutVerilatorTheSimulatedUnitsAreNamed) {
  const auto render_without = [&](const std::vector<std::string>& arguments) {
    return run_program({.arguments = joined({kCornell, "--size", "16x16"}, arguments),
                        .folder = folder_.path(),
                        .program = RAYGATE_WITHOUT_SIMULATION});
  };
  const Outcome plain = render_without({});
  EXPECT_EQ(plain.status, 0) << plain.err;
  EXPECT_TRUE(contains(plain.out, "engine cpu"));
  EXPECT_EQ(render_without({"--engine", "model"}).status, 0);
  for (const char* unit : {"pipeline", "serial", "core"}) {
    const Outcome outcome = render_without({"--engine", "rtl", "--unit", unit});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(contains(outcome.err, "which was built without Verilator; `make verilate`"));
  }
}

TEST_F(Render, ACheckSaysThatTheEnginesAgreed) {
  const Outcome outcome = render({kCornell, "--size", "16x16", "--engine", "check"});
  EXPECT_NE(outcome.out.find("\ncheck    rtl and cpu agreed on all "), std::string::npos)
      << outcome.out;
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

TEST_F(Render, ShadowCatchersUnderOtherLightsAreWarnedAbout) {
  folder_.write("a.obj",
                "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n"
                "usemtl ground\nf 1 3 2\n");
  for (const char* emission : {"0", "1"}) {
    folder_.write("a.mtl",
                  "newmtl ground\nillum 10\nnewmtl lamp\nKe 0 0 " + std::string(emission) + "\n");
    EXPECT_EQ(contains(render({"a.obj", "--size", "4x4", "--engine", "cpu", "--quiet"}).err,
                       "warning: illum 10: matches the background under point lights alone\n"),
              *emission == '1');
  }
}

TEST_F(Render, ManyWarningsAreCounted) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 1; i <= 12; ++i) text += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
  folder_.write("a.obj", text);
  const auto warnings = [&](const char* option) {
    return render({"a.obj", "--size", "4x4", "--engine", "cpu", option}).err;
  };
  const std::string brief = warnings("--quiet");
  EXPECT_EQ(std::ranges::count(brief, '\n'), 11) << brief;
  EXPECT_TRUE(contains(brief, "\nwarning: and 2 more; --verbose lists them\n"));
  const std::string all = warnings("--verbose");
  EXPECT_EQ(std::ranges::count(all, '\n'), 12) << all;
}

}  // namespace
}  // namespace raygate
