// In each run, one allocation, write, sync or rename fails. Each file then has its old or its new
// contents, and one line and the exit status report the error. There are 12 runs for each kind of
// call; RAYGATE_FAULTS=N makes N runs, and 0 one run for each call (`make test LONG=faults`).
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <random>
#include <sstream>

#include "host/app/test/render_run.h"

namespace raygate {
namespace {

/// Returns the numbers of the calls to fail, one per run: all, or some spread over a run.
std::vector<long> chosen(long calls, std::mt19937& random) {
  const char* const text = std::getenv("RAYGATE_FAULTS");
  const long wanted = text == nullptr ? 12 : std::atol(text);
  std::vector<long> some;
  if (wanted <= 0 || wanted >= calls) {
    for (long call = 1; call <= calls; ++call) some.push_back(call);
    return some;
  }
  for (long i = 0; i < wanted; ++i) {
    const long first = calls * i / wanted, next = calls * (i + 1) / wanted;
    some.push_back(std::uniform_int_distribution<long>(first + 1, next)(random));
  }
  return some;
}

class Faults : public Render {
 protected:
  /// A run that replaces the files `outputs`.
  struct Job {
    std::vector<std::string> arguments;
    std::vector<std::string> outputs;
    std::string program{};
  };

  /// Makes the inputs of all runs.
  void SetUp() override {
    const auto make = [&](const char* samples, const char* name) {
      ASSERT_EQ(run(joined(small_picture(), {"--samples", samples, "-o", name})).status, 0);
    };
    make("0:2", "a.exr");
    make("2:4", "b.exr");
  }

  static std::vector<std::string> small_picture() {
    return {kCornell, "--engine",  "cpu",          "--size", "24x18",     "--spp", "4",
            "--crop", "4,2,20,16", "--integrator", "path",   "--threads", "2",     "--quiet"};
  }

  Outcome run_with(const Job& job, const std::string& fault) const {
    return run_program(
        {.arguments = job.arguments,
         .folder = folder_.path(),
         .most_seconds = 60,
         .program = job.program,
         .environment = {"LD_PRELOAD=" RAYGATE_FAULTS_LIBRARY,
                         fault.empty() ? "RAYGATE_FAULT_COUNT=counts" : "RAYGATE_FAULT=" + fault}});
  }

  void survive(const Job& job) {
    const Outcome good = run_with(job, "");
    ASSERT_EQ(good.status, 0) << good.err;
    std::vector<std::string> made;
    for (const std::string& name : job.outputs) made.push_back(folder_.read(name));
    std::istringstream counts(folder_.read("counts"));
    const std::vector<std::string> before = folder_.list();
    std::mt19937 random(20261123);
    for (const char* kind : {"memory", "large", "write", "sync", "rename"}) {
      long calls = 0;
      ASSERT_TRUE(counts >> calls);
      ASSERT_GT(calls, 0) << kind;
      int runs = 0, refused = 0;
      for (const long call : chosen(calls, random)) {
        SCOPED_TRACE(kind + ":"s + std::to_string(call));
        for (const std::string& name : job.outputs) folder_.write(name, "old " + name);
        const Outcome outcome = run_with(job, kind + ":"s + std::to_string(call));
        ++runs;
        refused += outcome.status != 0;
        check(job, outcome, made);
        EXPECT_EQ(folder_.list(), before);
      }
      std::printf("%s: of %ld calls, in %d runs: %d refused, %d made the picture\n", kind, calls,
                  runs, refused, runs - refused);
    }
  }

  void check(const Job& job, const Outcome& outcome, const std::vector<std::string>& made) const {
    const bool is_done = outcome.status == 0;
    EXPECT_TRUE(is_done || outcome.status == 2)
        << "status " << outcome.status << ", signal " << outcome.signal << "\n"
        << outcome.err;
    std::istringstream lines(outcome.err);
    int errors = 0;
    for (std::string line; std::getline(lines, line);) {
      errors += line.starts_with("error: ");
      EXPECT_TRUE(line.starts_with("error: ") || line.starts_with("warning: ")) << line;
    }
    EXPECT_EQ(errors, is_done ? 0 : 1) << outcome.err;
    for (std::size_t i = 0; i < made.size(); ++i) {
      const std::string& name = job.outputs[i];
      const std::string bytes = folder_.read(name);
      if (!is_done && bytes == "old " + name) continue;
      // Statistics are not compared, because times differ between runs.
      const bool is_whole = name == "stats.json" ? json::accept(bytes) : bytes == made[i];
      EXPECT_TRUE(is_whole) << name << ", " << bytes.size() << " bytes";
    }
  }
};

TEST_F(Faults, OfARender) {
  survive({joined(small_picture(), {"-o", "c", "--stats", "stats.json"}),
           {"c.exr", "c.png", "stats.json"}});
}

/// In this scene, two threads build the BVH.
TEST_F(Faults, OfALargerScene) {
  survive({{RAYGATE_SCENES "/teapot.obj", "--engine", "cpu", "--size", "8x6", "--threads", "2",
            "--quiet", "--integrator", "primary", "-o", "c"},
           {"c.exr", "c.png"}});
}

TEST_F(Faults, OfAResume) {
  survive({joined(small_picture(), {"--resume", "a.exr", "-o", "c", "--channels", "sums"}),
           {"c.exr", "c.png"}});
}

/// Limits the address space to between the program's start-up need and that of a picture.
TEST_F(Faults, OfLittleMemory) {
  const Job job{{kCornell, "--engine", "cpu", "--size", "256x256", "--spp", "1", "--integrator",
                 "primary", "--threads", "2", "--quiet", "-o", "c"},
                {"c.exr", "c.png"}};
  const auto with_memory = [&](const std::vector<std::string>& arguments, long limit) {
    return run_program({.arguments = arguments, .folder = folder_.path(), .memory_limit = limit});
  };
  // Returns the least limit with which a run succeeds.
  const auto least = [&](const std::vector<std::string>& arguments) {
    long little = 0, enough = 1L << 32;
    while (enough - little > 1 << 14) {
      const long middle = (little + enough) / 2;
      (with_memory(arguments, middle).status == 0 ? enough : little) = middle;
    }
    return enough;
  };
  const long begin = least({"--version"}) + (1 << 21), end = least(job.arguments);
  ASSERT_EQ(with_memory(job.arguments, end + (1 << 24)).status, 0);
  const std::vector<std::string> made = {folder_.read("c.exr"), folder_.read("c.png")};
  std::mt19937 random(20261123);
  int refused = 0;
  const std::vector<long> below = chosen(1000, random);
  for (const long share : below) {
    const long limit = begin + (end - begin) / 1000 * share;
    SCOPED_TRACE(limit);
    for (const std::string& name : job.outputs) folder_.write(name, "old " + name);
    const Outcome outcome = with_memory(job.arguments, limit);
    refused += outcome.status != 0;
    check(job, outcome, made);
  }
  EXPECT_GT(refused, 0);
  std::printf("in %zu runs of %ld to %ld bytes: %d refused\n", below.size(), begin, end, refused);
}

TEST_F(Faults, OfAMerge) {
  survive({{"a.exr", "b.exr", "-o", "c"}, {"c.exr", "c.png"}, RAYGATE_MERGE});
}

}  // namespace
}  // namespace raygate
