// Pictures rendered in parts, merged, or interrupted and resumed have the bytes of a single run.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>

#include "host/app/test/render_run.h"

namespace raygate {
namespace {

class Parts : public Render {
 protected:
  /// Renders a small Cornell box with 12 samples per pixel and further arguments.
  Outcome part(const std::vector<std::string>& more) const {
    return run(joined({kCornell, "--size", "60x44", "--spp", "12", "--integrator", "path",
                       "--threads", "1", "--engine", "cpu"},
                      more));
  }
  void make(const std::vector<std::string>& more) {
    const Outcome outcome = part(more);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  Outcome merge(std::vector<std::string> arguments) {
    return run_program(
        {.arguments = std::move(arguments), .folder = folder_.path(), .program = RAYGATE_MERGE});
  }
  void expect_merged(const std::vector<std::string>& arguments) {
    const Outcome outcome = merge(joined(arguments, {"-o", "merged"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    expect_same_pictures("merged", "whole");
  }
  /// Returns the arguments of a run that resumes the last saved film, if there is one.
  std::vector<std::string> resuming(const std::vector<std::string>& arguments) const {
    return folder_.read("a.exr").empty() ? arguments : joined(arguments, {"--resume", "a.exr"});
  }
  /// Renders, kills the run at a random time, resumes the last saved film, and so on.
  void expect_to_survive(const std::vector<std::string>& long_run) {
    make(joined(long_run, {"-o", "whole"}));
    std::mt19937 random(20261122);
    int killed = 0;
    const char* const wanted = std::getenv("RAYGATE_KILLS");  // make test LONG=kills
    const int kills = wanted == nullptr ? 4 : std::atoi(wanted);
    const auto kill_soon = [&](int process) {
      std::this_thread::sleep_for(std::chrono::milliseconds(150 + random() % 300));
      ::kill(process, SIGKILL);
    };
    for (int runs = 0; killed < kills && runs < 2 * kills; ++runs) {
      const Outcome outcome = run_program(
          {.arguments = resuming(joined({kCornell, "--integrator", "path", "--threads", "2",
                                         "--engine", "cpu", "--save-every", "0.1", "-o", "a.exr"},
                                        long_run)),
           .folder = folder_.path(),
           .terminal = true,
           .when_said = {{"rendering: ", kill_soon}}});
      if (outcome.signal == SIGKILL) {
        ++killed;
        continue;
      }
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      ASSERT_TRUE(folder_.read("a.exr") == folder_.read("whole.exr"));
      fs::remove(folder_.path() / "a.exr");
    }
    EXPECT_GT(killed, 0);
    std::printf("killed %d times\n", killed);
    make(resuming(joined(long_run, {"-o", "resumed"})));
    expect_same_pictures("resumed", "whole");
  }
  void expect_refused(const Outcome& outcome, const std::string& line) const {
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "error: " + line));
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(folder_.read("merged.exr"), "");
  }
};

TEST_F(Parts, OfItsSamplesMakeThePicture) {
  make({"-o", "whole", "--channels", "Albedo,objectId"});
  for (const std::vector<int>& cuts :
       {std::vector{0, 5, 12}, {0, 1, 4, 12}, {0, 2, 3, 5, 6, 11, 12}}) {
    std::vector<std::string> names;
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      names.push_back(std::to_string(i) + ".exr");
      make({"-o", names.back(), "--samples",
            std::to_string(cuts[i - 1]) + ":" + std::to_string(cuts[i]), "--channels",
            "Albedo,objectId", "--engine", i % 2 == 0 ? "cpu" : "model"});
    }
    std::ranges::reverse(names);
    expect_merged(names);
  }
}

TEST_F(Parts, OfItsPixelsMakeThePicture) {
  make({"-o", "whole"});
  const std::vector<std::string> crops = {"0,0,31,20", "31,0,60,20", "0,20,60,21", "0,21,60,44"};
  std::vector<std::string> names;
  for (std::size_t i = 0; i < crops.size(); ++i) {
    for (const char* samples : {"0:7", "7:12"}) {
      names.push_back(std::to_string(i) + samples[0] + ".exr");
      make({"-o", names.back(), "--crop", crops[i], "--samples", samples});
    }
  }
  expect_merged(names);
}

/// Light paths also light pixels of other parts.
TEST_F(Parts, WithLightPathsMakeThePicture) {
  const auto render = [&](const std::vector<std::string>& more) {
    const Outcome outcome = run(joined({kPaper, "--size", "60x44", "--spp", "6", "--integrator",
                                        "path", "--engine", "cpu", "--exposure", "0"},
                                       more));  // exposure 0, because merge uses it
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  };
  render({"-o", "whole", "--threads", "1"});
  render({"-o", "chance", "--caustics", "off"});
  EXPECT_NE(folder_.read("chance.png"), folder_.read("whole.png"));
  std::vector<std::string> names;
  for (const char* crop : {"0,0,31,44", "31,0,60,44"}) {
    for (const char* samples : {"0:2", "2:6"}) {
      names.push_back(std::to_string(names.size()) + ".exr");
      render({"-o", names.back(), "--crop", crop, "--samples", samples, "--threads", "3"});
    }
  }
  expect_merged(names);
  render({"-o", "few.exr", "--spp", "3", "--channels", "sums"});
  render({"-o", "more", "--resume", "few.exr"});
  expect_same_pictures("more", "whole");
}

TEST_F(Parts, ThatAreNotAllKeepTheirSums) {
  make({"-o", "whole", "--channels", "sums"});
  make({"-o", "a.exr", "--samples", "0:3"});
  make({"-o", "b.exr", "--samples", "3:7"});
  make({"-o", "c.exr", "--samples", "7:12"});
  ASSERT_EQ(merge({"b.exr", "c.exr", "-o", "d.exr"}).status, 0);
  const Outcome outcome = merge({"a.exr", "d.exr", "-o", "merged", "--channels", "sums"});
  EXPECT_EQ(outcome.out, "wrote merged.exr, merged.png: samples 0:12\n");
  expect_same_pictures("merged", "whole");
}

TEST_F(Parts, GoOnWhereTheyWere) {
  make({"-o", "whole"});
  make({"-o", "a.exr", "--samples", "0:5"});
  make({"-o", "b.exr", "--resume", "a.exr", "--samples", "0:8"});
  make({"-o", "resumed", "--resume", "b.exr", "--engine", "model", "--threads", "2"});
  expect_same_pictures("resumed", "whole");
  // Resumes a complete picture of fewer samples.
  make({"-o", "few.exr", "--spp", "4", "--channels", "sums"});
  make({"-o", "more", "--resume", "few.exr"});
  expect_same_pictures("more", "whole");
}

/// A resumed picture that is interrupted again keeps its samples so far, whether or not sums are
/// requested for the finished picture.
TEST_F(Parts, KeepTheirSumsWhenInterruptedAgain) {
  const std::vector<std::string> picture = {"--size", "200x150", "--spp", "4000", "--threads", "2"};
  make(joined(picture, {"--samples", "0:4", "-o", "a.exr"}));
  for (const char* from : {"a.exr", "b.exr"}) {
    const Outcome outcome = run_program(
        {.arguments = joined(joined({kCornell, "--integrator", "path", "--engine", "cpu"}, picture),
                             {"--resume", from, "-o", "b.exr"}),
         .folder = folder_.path(),
         .terminal = true,
         .signal_when_busy = SIGINT});
    EXPECT_EQ(outcome.status, 128 + SIGINT) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "error: interrupted; wrote what there was: b.exr ("));
    EXPECT_TRUE(contains(outcome.err, " of 4000 samples per pixel); --resume"));
    EXPECT_TRUE(contains(outcome.err, "--resume b.exr goes on from there"));
  }
}

TEST_F(Parts, SurviveBeingKilled) {
  expect_to_survive({"--size", "200x150", "--spp", "48", "--channels", "sums"});
}

TEST_F(Parts, WithSamplesByErrorSurviveBeingKilled) {
  expect_to_survive({"--size", "200x150", "--spp", "256", "--error", "0.6", "--channels", "sums"});
}

TEST_F(Parts, WithSamplesByErrorMakeThePicture) {
  const auto with = [&](const std::vector<std::string>& more) {
    return joined(more, {"--error", "0.5", "--channels", "sums"});
  };
  make(with({"-o", "whole", "--spp", "70"}));
  make(with({"-o", "a.exr", "--spp", "70", "--crop", "0,0,32,20"}));
  make(with({"-o", "b.exr", "--spp", "70", "--crop", "32,0,60,20", "--engine", "model"}));
  make(with({"-o", "c.exr", "--spp", "70", "--crop", "0,20,60,44", "--threads", "3"}));
  const Outcome outcome = merge({"c.exr", "a.exr", "b.exr", "--channels", "sums", "-o", "merged",
                                 "--false-colour", "samples=samples.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_same_pictures("merged", "whole");
  EXPECT_NE(folder_.read("samples.png"), "");
  // Resumes a picture with a lower maximum, which some pixels have reached and some have not.
  make(with({"-o", "few.exr", "--spp", "37"}));
  make(with({"-o", "more", "--spp", "70", "--resume", "few.exr"}));
  expect_same_pictures("more", "whole");
}

TEST_F(Parts, WithSamplesByErrorAreRefusedWhereTheyMakeNone) {
  make({"-o", "a.exr", "--spp", "20", "--error", "2", "--channels", "sums"});
  expect_refused(part({"--resume", "a.exr", "--spp", "20", "--error", "3"}),
                 "a.exr: found error 2, expected error 3 as this run has it");
  expect_refused(part({"--resume", "a.exr", "--spp", "20"}),
                 "a.exr: found error 2, expected no error as this run has it");
  expect_refused(part({"--spp", "20", "--error", "2", "--crop", "0,0,30,44"}),
                 "--crop: found '0,0,30,44', expected multiples of 4");
  expect_refused(part({"--spp", "20", "--error", "2", "--samples", "0:18"}),
                 "--samples and --error exclude each other");
  expect_refused(part({"--error", "2"}), "--spp: found '12', expected more than the 16");
  expect_refused(part({"--false-colour", "samples=b.png"}),
                 "--false-colour: expected --error for the channel samples");
  make({"-o", "b.exr", "--samples", "0:5"});
  expect_refused(merge({"b.exr", "-o", "merged", "--false-colour", "error=b.png"}),
                 "--false-colour: found no channel error in the picture");
  expect_refused(
      merge({"b.exr", "-o", "merged", "--false-colour", "Z=c.png", "--false-colour", "R=c.png"}),
      "c.png: would overwrite c.png");
}

/// With the same options, an edited scene makes another picture.
TEST_F(Parts, OfAnEditedSceneAreRefused) {
  const auto write_scene = [&](const char* height, const char* colour) {
    folder_.write("s.obj",
                  "mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 "s + height + "\nusemtl m\nf 1 2 3\n");
    folder_.write("s.mtl", "newmtl m\nKd "s + colour + "\n");
  };
  const auto render_part = [&](const std::vector<std::string>& more) {
    return run(joined({"s.obj", "--engine", "cpu", "--size", "20x15", "--spp", "4", "--camera",
                       "0.3,0.3,3,0.3,0.3,0,30"},
                      more));
  };
  const std::string line = ".exr: found another geometry, material or light, expected those";
  write_scene("0", "0.5 0.5 0.5");
  ASSERT_EQ(render_part({"--samples", "0:2", "-o", "a.exr"}).status, 0);
  for (const auto& [height, colour] : {std::pair{"0.01", "0.5 0.5 0.5"}, {"0", "0.5 0.5 0.6"}}) {
    write_scene(height, colour);
    ASSERT_EQ(render_part({"--samples", "2:4", "-o", "b.exr"}).status, 0);
    expect_refused(merge({"a.exr", "b.exr", "-o", "merged"}), "b" + line + " as in a.exr");
    expect_refused(render_part({"--resume", "a.exr", "-o", "c"}),
                   "a" + line + " as this run has it");
  }
}

TEST_F(Parts, OfAnotherCameraAreRefused) {
  folder_.write("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string camera = R"({"camera": {"eye": [0.3, 0.3, 3], "target": [0.3, 0.3, 0],
      "up": [0, 1, 0], "fov": 30, "aperture": 0.125, "focus": 2}})";
  const auto render_part = [&](const std::string& text, const char* samples, const char* name) {
    folder_.write("s.json", text);
    return run({"s.json", "--engine", "cpu", "--size", "8x6", "--spp", "4", "--samples", samples,
                "-o", name});
  };
  ASSERT_EQ(render_part(camera, "0:2", "a.exr").status, 0);
  ASSERT_EQ(render_part(camera, "2:4", "b.exr").status, 0);
  EXPECT_EQ(merge({"a.exr", "b.exr", "-o", "both"}).status, 0);
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"3, 3]", "3, 4]"},
           {"3, 0]", "31, 0]"},
           {"1, 0]", "1, 1]"},
           {"30", "31"},
           {"125", "25"},
           {"2}", "2.5}"},
           {R"("fov")", R"("projection": "orthographic", "fov")"}}) {
    std::string other = camera;
    ASSERT_EQ(render_part(other.replace(other.find(from), from.size(), to), "2:4", "b.exr").status,
              0);
    expect_refused(merge({"a.exr", "b.exr", "-o", "merged"}), "b.exr: found");
  }
}

TEST_F(Parts, NothingButAFilmReplacesWhatTheyGoOnFrom) {
  make({"-o", "a.exr", "--samples", "0:5"});
  const std::string before = folder_.read("a.exr");
  fs::create_symlink("a.exr", folder_.path() / "b.json");
  expect_refused(part({"--resume", "a.exr", "-o", "c", "--stats", "a.exr"}),
                 "a.exr: would overwrite a.exr");
  expect_refused(part({"--resume", "a.exr", "-o", "c", "--stats", "b.json"}),
                 "b.json: would overwrite a.exr");
  EXPECT_EQ(folder_.read("a.exr"), before);
  make({"-o", "a.exr", "--resume", "a.exr"});
}

TEST_F(Parts, OfDifferentPicturesAreRefused) {
  make({"-o", "a.exr", "--samples", "0:5"});
  make({"-o", "b.exr", "--samples", "5:12", "--seed", "3"});
  expect_refused(merge({"a.exr", "b.exr", "-o", "merged"}),
                 "b.exr: found seed 3, expected seed 0 as in a.exr");
  make({"-o", "b.exr", "--samples", "6:12"});
  expect_refused(merge({"a.exr", "b.exr", "-o", "merged"}),
                 "b.exr: found samples 6:12 of pixel 0,0, expected some from 5 on");
  make({"-o", "b.exr", "--samples", "0:5", "--crop", "0,0,9,9"});
  expect_refused(merge({"a.exr", "b.exr", "-o", "merged"}),
                 "b.exr: found samples 0:5 of pixel 0,0, expected some from 5 on");
  make({"-o", "a.exr", "--samples", "0:5", "--crop", "9,9,60,44"});
  expect_refused(merge({"a.exr", "b.exr", "-o", "merged"}),
                 "the parts together lack samples from 0 on of pixel 9,0");
  make({"-o", "c.exr"});
  expect_refused(merge({"a.exr", "c.exr", "-o", "merged"}), "c.exr: found no sums of samples");
  expect_refused(merge({"a.exr", "none.exr", "-o", "merged"}), "none.exr: cannot read");
  expect_refused(merge({"a.exr"}), "expected parts of a picture and -o NAME");
  expect_refused(part({"--resume", "a.exr"}), "a.exr: found another crop");
  expect_refused(part({"--resume", "c.exr"}), "c.exr: found no sums of samples");
  make({"-o", "b.exr", "--samples", "0:5"});
  expect_refused(part({"--resume", "b.exr", "--seed", "1"}),
                 "b.exr: found seed 0, expected seed 1 as this run has it");
  expect_refused(part({"--resume", "b.exr", "--samples", "0:3"}),
                 "b.exr: found samples 0:5, expected the first of 0:3\n");
  expect_refused(part({"--resume", "b.exr", "--spp", "3"}),
                 "b.exr: found samples 0:5, expected the first of 0:3; try --spp 5\n");
  expect_refused(part({"--resume", "b.exr", "--channels", "Albedo"}),
                 "b.exr: found no channel Albedo");
  expect_refused(part({"--samples", "0:13"}), "--samples: found '0:13', expected some of the 12");
  expect_refused(part({"--samples", "5"}), "--samples: found '5', expected A:B");
}

}  // namespace
}  // namespace raygate
