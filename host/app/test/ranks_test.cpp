// Pictures that ranks share, whole, broken off and gone on with: the bytes of one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "host/app/test/render_run.h"

namespace raygate {
namespace {

using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Processes that `parent` has started.
std::vector<int> children_of(int parent) {
  std::vector<int> children;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (!std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; })) continue;
    std::ifstream file(entry.path() / "stat");
    std::string stat(std::istreambuf_iterator<char>(file), {});
    const std::size_t end = stat.rfind(')');  // of the program's name
    if (end != std::string::npos && std::stoi(stat.substr(end + 4)) == parent) {
      children.push_back(std::stoi(name));
    }
  }
  return children;
}

int rank_of(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/environ");
  const std::string environment(std::istreambuf_iterator<char>(file), {});
  const std::string name = "OMPI_COMM_WORLD_RANK=";
  const std::size_t at = environment.find(name);
  return at == std::string::npos ? -1 : std::stoi(environment.substr(at + name.size()));
}

class Ranks : public Render {
 protected:
  Ranks() {
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  }

  Outcome on_ranks(int count, const Words& arguments,
                   std::vector<std::pair<std::string, std::function<void(int)>>> when_said = {},
                   const Words& environment = {}) {
    return run_program({.arguments = Words{"--oversubscribe", "--bind-to", "none", "-n",
                                           std::to_string(count), RAYGATE_PROGRAM} +
                                     arguments,
                        .folder = folder_.path(),
                        .when_said = std::move(when_said),
                        .program = RAYGATE_MPIRUN,
                        .environment = environment});
  }
  void alone(const Words& arguments) {
    const Outcome outcome = run_program({.arguments = arguments, .folder = folder_.path()});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
};

Words small() { return {kCornell, "--size", "60x44", "--integrator", "path", "--threads", "1"}; }

TEST_F(Ranks, ShareLightPaths) {
  const Words arguments = {kPaper, "--size",   "60x44", "--integrator", "path", "--spp",
                           "9",    "--engine", "cpu",   "--threads",    "1"};
  alone(arguments + Words{"-o", "whole"});
  for (const int count : {2, 3}) {
    const Outcome outcome = on_ranks(count, arguments + Words{"-o", "shared"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expect_same_pictures("shared", "whole");
  }
}

TEST_F(Ranks, ShareAPicture) {
  const Words arguments = small() + Words{"--spp", "9", "--channels", "Albedo,objectId"};
  alone(arguments + Words{"--engine", "cpu", "-o", "whole"});
  for (const int count : {1, 2, 4}) {
    const Outcome outcome = on_ranks(count, arguments + Words{"--engine", "cpu", "-o", "shared"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expect_same_pictures("shared", "whole");
    if (count == 1) continue;
    EXPECT_NE(outcome.out.find(std::to_string(count) + " ranks of 1 thread"), std::string::npos)
        << outcome.out;
    EXPECT_EQ(std::ranges::count(outcome.out, '\n'), 5) << "of rank 0 alone:\n" << outcome.out;
    EXPECT_NE(outcome.err.find("rendering: 100 %"), std::string::npos) << outcome.err;
  }
}

TEST_F(Ranks, ShareAPictureOfTheHardware) {
  const Words arguments = {kCornell, "--size", "24x16", "--spp", "4", "--threads", "1"};
  alone(arguments + Words{"--engine", "cpu", "-o", "whole"});
  for (const int count : {1, 2, 4}) {
    const Outcome outcome = on_ranks(count, arguments + Words{"--engine", "rtl", "-o", "shared"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expect_same_pictures("shared", "whole");
  }
}

TEST_F(Ranks, ShareOneSampleCropsAndRanges) {
  const Words one = {kCornell, "--size", "300x200", "--engine", "cpu", "--spp", "1"};
  alone(one + Words{"-o", "whole"});
  EXPECT_EQ(on_ranks(3, one + Words{"-o", "shared"}).status, 0);
  expect_same_pictures("shared", "whole");
  const Words part =
      small() + Words{"--engine", "cpu", "--spp", "12", "--crop", "9,7,50,41", "--samples", "3:11"};
  alone(part + Words{"-o", "whole"});
  EXPECT_EQ(on_ranks(2, part + Words{"-o", "shared"}).status, 0);
  expect_same_pictures("shared", "whole");
}

TEST_F(Ranks, ShareAPictureWithSamplesByItsError) {
  const Words arguments = small() + Words{"--engine", "cpu", "--spp", "200", "--error", "4"};
  alone(arguments + Words{"-o", "whole"});
  for (const int count : {2, 4}) {
    EXPECT_EQ(on_ranks(count, arguments + Words{"-o", "shared"}).status, 0);
    expect_same_pictures("shared", "whole");
  }
}

TEST_F(Ranks, GoOnWhereAnotherNumberOfThemWas) {
  const Words arguments = small() + Words{"--engine", "cpu"};
  alone(arguments + Words{"--spp", "13", "-o", "whole"});
  const Words begun = arguments + Words{"--spp", "5", "--channels", "sums", "-o", "a.exr"};
  EXPECT_EQ(on_ranks(3, begun).status, 0);
  const Words resumed = arguments + Words{"--spp", "13", "--resume", "a.exr", "-o", "resumed"};
  EXPECT_EQ(on_ranks(2, resumed).status, 0);
  expect_same_pictures("resumed", "whole");
  alone(resumed);
  expect_same_pictures("resumed", "whole");
}

TEST_F(Ranks, SayOnceWhatIsWrong) {
  const auto refused = [&](const Words& arguments, const std::string& line) {
    const Outcome outcome = on_ranks(3, arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    const std::size_t at = outcome.err.find("error: ");
    ASSERT_NE(at, std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.compare(at, line.size(), line), 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("error: ", at + 1), std::string::npos) << outcome.err;
  };
  refused({"none.obj"}, "error: none.obj: ");
  refused({kCornell, "--spp", "-3"}, "error: --spp: ");
  refused({kCornell, "-o", "no/such/folder/a.exr"}, "error: no/such/folder/a.exr: ");
  EXPECT_TRUE(folder_.list().empty());
}

TEST_F(Ranks, EndAlikeWhoeverIsInTrouble) {
  const std::tuple<std::string, int, std::string> endings[] = {
      {"difference", 1, "a ray"}, {"interrupted", 143, "interrupted; "}};
  for (const auto& [ending, status, line] : endings) {
    for (const int rank : {0, 2}) {
      const Outcome outcome =
          run_program({.arguments = {"--oversubscribe", "-n", "3", RAYGATE_ENDINGS, ending,
                                     std::to_string(rank)},
                       .folder = folder_.path(),
                       .program = RAYGATE_MPIRUN});
      EXPECT_EQ(outcome.status, status) << ending << " on rank " << rank << "\n" << outcome.err;
      const std::string whose = rank == 0 ? "" : "rank " + std::to_string(rank) + ": ";
      EXPECT_NE(outcome.err.find("error: " + whose + line), std::string::npos) << outcome.err;
    }
  }
}

/// Killed at any time, a film is there to go on from: of a rank's death, without --save-every, all
/// but the tiles in flight. RAYGATE_KILLS says how often; each takes up what the last one left.
class KilledRanks : public Ranks {
 protected:
  enum class Who { kWorker, kRank0, kAll };
  void kill_at_random(Who who, const Words& more) {
    const Words arguments = {kCornell,   "--size",   "200x150",      "--spp", "128",
                             "--engine", "cpu",      "--integrator", "path",  "--threads",
                             "1",        "--filter", "box"};
    const Words begun = arguments + Words{"-o", "a.exr"} + more;
    const char* const wanted = std::getenv("RAYGATE_KILLS");
    const int kills = wanted != nullptr ? std::stoi(wanted) : 2;
    constexpr unsigned kSeed = 20261122;
    std::mt19937 random(kSeed + static_cast<unsigned>(who));
    int killed = 0, saved = 0;
    int runs = 0;
    for (; runs < kills || (saved == 0 && runs < 10 * kills); ++runs) {
      const std::string before = folder_.read("a.exr");
      const auto kill_some = [&](int launcher) {
        std::this_thread::sleep_for(std::chrono::milliseconds(250 + random() % 600));
        std::vector<int> ranks = children_of(launcher);
        std::ranges::sort(ranks, {}, rank_of);
        if (ranks.size() != 3) return;  // it is over
        if (who == Who::kAll) {
          ranks.push_back(launcher);
        } else {
          ranks = {who == Who::kRank0 ? ranks[0] : ranks[1 + random() % 2]};
        }
        for (const int rank : ranks) ::kill(rank, SIGKILL);
        ++killed;
      };
      const Outcome outcome =
          on_ranks(3, begun + (before.empty() ? Words{} : Words{"--resume", "a.exr"}),
                   {{"rendering: ", kill_some}});
      if (outcome.status == 0)
        fs::remove(folder_.path() / "a.exr");  // from the beginning again
      else
        saved += folder_.read("a.exr") != before;
      if (who == Who::kWorker && outcome.status != 0) {
        EXPECT_NE(outcome.err.find("--resume a.exr goes on from there"), std::string::npos)
            << outcome.err;
      }
    }
    std::printf("%d runs of 3 ranks, %d killed (seed %u), %d saved something\n", runs, killed,
                kSeed, saved);
    EXPECT_GT(killed, 0);
    EXPECT_GT(saved, 0);
    if (folder_.read("a.exr").empty()) return;
    alone(arguments + Words{"--resume", "a.exr", "-o", "resumed"});
    alone(arguments + Words{"-o", "whole"});
    expect_same_pictures("resumed", "whole");
  }
};

/// Each message of each rank is its last: the old film or more of it is there to go on from.
TEST_F(KilledRanks, AtTheirMessages) {
  const Words arguments = small() + Words{"--engine", "cpu"};
  alone(arguments + Words{"--spp", "2", "--channels", "sums", "-o", "begun.exr"});
  alone(arguments + Words{"--spp", "4", "-o", "whole"});
  const std::string begun = folder_.read("begun.exr");
  const Words more = arguments + Words{"--spp", "4", "--resume", "a.exr"};
  const auto run = [&](const Words& fault) {
    folder_.write("a.exr", begun);
    return on_ranks(3, more + Words{"--channels", "sums", "-o", "a.exr"}, {},
                    fault + Words{"LD_PRELOAD=" RAYGATE_FAULTS_LIBRARY});
  };
  EXPECT_EQ(run({"RAYGATE_FAULT_COUNT=messages"}).status, 0);
  const int messages = std::stoi(folder_.read("messages"));
  ASSERT_GT(messages, 6);
  const char* const wanted = std::getenv("RAYGATE_KILLS");
  const int step = wanted != nullptr ? 1 : messages / 3;  // all that rank 0 has, or some
  int runs = 0, all_broken = 0;
  for (int rank = 0; rank < 3; ++rank) {
    int broken = 0;
    for (int message = 1; message <= messages; message += step) {
      SCOPED_TRACE("rank " + std::to_string(rank) + ", message " + std::to_string(message));
      const Outcome outcome = run({"RAYGATE_FAULT_RANK=" + std::to_string(rank),
                                   "RAYGATE_FAULT_MESSAGE=" + std::to_string(message)});
      ++runs;
      broken += outcome.status != 0;
      alone(more + Words{"-o", "resumed"});
      expect_same_pictures("resumed", "whole");
    }
    EXPECT_GT(broken, 0) << "of rank " << rank << " no message failed";
    all_broken += broken;
  }
  std::printf("%d runs of 3 ranks, of %d messages at rank 0: %d broken off\n", runs, messages,
              all_broken);
}

/// Rank 0 doesn't wait for the rest of what a dead rank began to send; it saves what it has.
TEST_F(KilledRanks, InTheMiddleOfAMessage) {
  const Words arguments = {kCornell, "--size",    "200x150", "--spp", "32",   "--engine",
                           "cpu",    "--threads", "1",       "-o",    "a.exr"};
  const Outcome outcome = on_ranks(
      2, arguments, {},
      {"RAYGATE_FAULT_RANK=1", "RAYGATE_FAULT_BYTES=65536", "LD_PRELOAD=" RAYGATE_FAULTS_LIBRARY});
  EXPECT_NE(outcome.status, 0) << "no message was that long";
  EXPECT_NE(outcome.err.find("--resume a.exr goes on from there"), std::string::npos)
      << outcome.err;
}

TEST_F(KilledRanks, OneOfThem) { kill_at_random(Who::kWorker, {}); }
TEST_F(KilledRanks, Rank0) { kill_at_random(Who::kRank0, {"--save-every", "0.2"}); }
TEST_F(KilledRanks, AllAndTheLauncher) { kill_at_random(Who::kAll, {"--save-every", "0.2"}); }

}  // namespace
}  // namespace raygate
