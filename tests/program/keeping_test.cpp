// What the user has is kept: inputs, earlier results and other files, whatever happens to a run.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "framework/io/images.h"
#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class KeepingTest : public ProgramTest {
 protected:
  KeepingTest() {
    write("small.yaml",
          "extends: methods/ed.yaml\n"
          "data: {type: synthetic_sheet, image_width: 160, image_height: 120, focal_length: 131.25}\n"
          "graph: {spacing: 12}\n");
  }

  /// Does what a shell does with `script` in the test's folder; $PLIANT is the program. Gives its exit code.
  int shell(const std::string& script) const {
    write("script.sh", "PLIANT='" PLIANT_PROGRAM "'\n" + script + "\n");
    const int status =
        std::system(("cd '" + file("") + "' && sh script.sh >script.out 2>script.err").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

/// Files of the user with the names that a result has.
class OwnNamesTest : public KeepingTest {
 protected:
  OwnNamesTest() {
    write_depth(file("depth_source.png"), DepthImage(160, 120, 800));
    write_depth(file("depth_target.png"), DepthImage(160, 120, 805));
    write("K.txt", "131.25 0 79.5\n0 131.25 59.5\n0 0 1\n");
    write("experiment.yaml",
          "extends: methods/ed.yaml\n"
          "data:\n"
          "  type: rgbd_pair\n"
          "  source: {depth: depth_source.png}\n"
          "  target: {depth: depth_target.png}\n"
          "  intrinsics: K.txt\n"
          "graph: {spacing: 12}\n"
          "solvers: {device: gauss_newton}\n");
  }
};

TEST_F(OwnNamesTest, InputsAreNeverReplaced) {
  const auto before = all_of(".");
  for (const char* command : {"run", "compare"}) {
    const ProgramRun run = call(std::string(command) + " experiment.yaml --out .");
    EXPECT_EQ(run.exit_code, 3) << command;
    EXPECT_THAT(run.errors(), ElementsAre(HasSubstr("experiment.yaml is read by this experiment")));
  }
  EXPECT_THAT(call("run experiment.yaml --out .").err,
              AllOf(HasSubstr("depth_source.png is read"), HasSubstr("depth_target.png is read")));
  fs::remove(file("stdout.txt"));
  fs::remove(file("stderr.txt"));
  EXPECT_EQ(all_of("."), before);
}

TEST_F(OwnNamesTest, TheExperimentBesideAResultIsNotReplacedByItsOwnRun) {
  ASSERT_EQ(call("run experiment.yaml --out out").exit_code, 0);
  const auto before = all_of("out");
  EXPECT_THAT(call("run out/experiment.yaml --out out").err, HasSubstr("experiment.yaml is read"));
  EXPECT_EQ(all_of("out"), before);
  EXPECT_EQ(call("run out/experiment.yaml --out other").exit_code, 0);
}

TEST_F(KeepingTest, RunsMayNotBeCalledAsFilesOfAResultAre) {
  write("names.yaml",
        "extends: methods/ed.yaml\ndata: {type: synthetic_sheet}\nruns: {result.json: , index.html: , "
        "unfinished: }\n");
  const ProgramRun run = call("check names.yaml");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.errors(), ElementsAre(MatchesRegex("names.yaml:3:8: .*'result.json'.*"),
                                        MatchesRegex("names.yaml:3:23: .*'index.html'.*"),
                                        MatchesRegex("names.yaml:3:37: .*'unfinished'.*")));
}

// A limit on the size of files (2 MB, more than kernels take) stands for a full disk, which only root can
// make.
TEST_F(KeepingTest, AFullDiskIsToldWithTheFileAndLosesNothing) {
  write("large.yaml",
        "extends: small.yaml\ndata: {image_width: 640, image_height: 480, focal_length: 525}\n");
  ASSERT_EQ(call("run large.yaml --out out").exit_code, 0);
  const auto before = all_of("out");
  EXPECT_EQ(shell("ulimit -f 4000; $PLIANT run large.yaml --out out"), 3);
  EXPECT_THAT(text_of("script.err"), MatchesRegex(".*error: out/unfinished/source.ply: cannot be written: "
                                                  "File too large\n"));
  EXPECT_EQ(all_of("out"), before);
  EXPECT_EQ(shell("ulimit -f 4000; $PLIANT run large.yaml --out new"), 3);
  EXPECT_FALSE(fs::exists(file("new")));
}

TEST_F(KeepingTest, OutputThatCannotBeWrittenEndsNoRunAndIsNoSuccess) {
  const struct {
    const char* where;
    const char* why;
  } cases[] = {{">/dev/full", "No space left on device"}, {">&-", "Bad file descriptor"}};
  for (const auto& [where, why] : cases) {
    EXPECT_EQ(shell(std::string("$PLIANT run small.yaml --out out ") + where), 3) << where;
    EXPECT_THAT(text_of("script.err"), HasSubstr(std::string("standard output cannot be written: ") + why));
    EXPECT_TRUE(fs::exists(file("out/result.json"))) << where;
    fs::remove_all(file("out"));
    for (const char* command : {"components", "devices", "--help", "--version"})
      EXPECT_EQ(shell(std::string("$PLIANT ") + command + " " + where), 3) << command << where;
  }
}

TEST_F(KeepingTest, APipeThatNobodyReadsEndsNoRunAndIsNoSuccess) {
  EXPECT_EQ(shell("{ $PLIANT run small.yaml --out out; echo $? >code; } | true"), 0);
  EXPECT_EQ(text_of("code"), "3\n");
  EXPECT_THAT(text_of("script.err"), HasSubstr("standard output cannot be written: Broken pipe"));
  EXPECT_TRUE(fs::exists(file("out/result.json")));
}

TEST_F(KeepingTest, MessagesThatCannotBeWrittenDisturbNothing) {
  ASSERT_EQ(call("run small.yaml --out expected").exit_code, 0);
  for (const char* where : {"2>/dev/full", "2>&-", "2>&- 0<&-"}) {
    EXPECT_EQ(shell(std::string("$PLIANT run small.yaml --out out ") + where), 0) << where;
    EXPECT_EQ(read_file(file("out/registered.ply")), read_file(file("expected/registered.ply"))) << where;
    EXPECT_EQ(shell(std::string("$PLIANT run none.yaml ") + where), 2) << where;
  }
}

TEST_F(KeepingTest, AnInterruptionLeavesTheOldResultAndNothingElse) {
  ASSERT_EQ(call("run small.yaml --out out").exit_code, 0);
  const auto before = all_of("out");
  const struct {
    const char* signal;
    int exit_code;
  } cases[] = {{"INT", 130}, {"TERM", 143}};
  for (const auto& [signal, exit_code] : cases)
    for (const char* folder : {"out", "new"}) {
      // It would go on for minutes.
      const std::string script = "$PLIANT run small.yaml --repeat 1000 --out " + std::string(folder) +
                                 " & pid=$!\n"
                                 "until [ -d " +
                                 folder +
                                 "/unfinished ]; do sleep 0.01; done\n"
                                 "kill -" +
                                 signal + " $pid; wait $pid";
      EXPECT_EQ(shell(script), exit_code) << signal;
      EXPECT_THAT(text_of("script.err"), HasSubstr("interrupted\n"));
      EXPECT_EQ(all_of("out"), before) << signal;
      EXPECT_FALSE(fs::exists(file("new"))) << signal;
    }
}

TEST_F(KeepingTest, AnInterruptedSweepGoesOnWhereItWasInterrupted) {
  write("sweep.yaml",
        "extends: small.yaml\n"
        "runs: {first: , second: {data: {image_width: 640, image_height: 480, focal_length: 525}}}\n");
  for (const char* signal : {"INT", "KILL"}) {
    fs::remove_all(file("out"));
    const std::string script = std::string("$PLIANT run sweep.yaml --out out & pid=$!\n") +
                               "until [ -f out/unfinished/first/run.json ]; do sleep 0.01; done\n" +
                               "kill -" + signal + " $pid; wait $pid";
    EXPECT_EQ(shell(script), signal == std::string("INT") ? 130 : 137);
    if (signal == std::string("INT")) {
      EXPECT_THAT(text_of("script.err"), HasSubstr("interrupted\nout/unfinished: what is finished; the same "
                                                   "command goes on from whole runs of several"));
    }
    EXPECT_FALSE(fs::exists(file("out/result.json")));
    const auto first = nlohmann::ordered_json::parse(text_of("out/unfinished/first/run.json"))["run"];
    const ProgramRun run = call("run sweep.yaml --out out");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("Taken from the earlier result, which was not finished: first\n"));
    EXPECT_FALSE(fs::exists(file("out/unfinished")));
    const auto result = nlohmann::ordered_json::parse(text_of("out/result.json"));
    EXPECT_EQ(result["runs"][0].dump(), first.dump());
    EXPECT_EQ(result["runs"].size(), 2U);
  }
}

TEST_F(KeepingTest, ARunThatFailsIsToldAndTheOthersAreKept) {
  write("sweep.yaml", "extends: small.yaml\nruns: {bad: {graph: {spacing: 1000}}, good: }\n");
  const ProgramRun run = call("run sweep.yaml --out out");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("bad: failed: sweep.yaml, run bad: "), HasSubstr("Results are in out")));
  EXPECT_THAT(run.err, HasSubstr("error: sweep.yaml, run bad: "));
  EXPECT_EQ(nlohmann::json::parse(text_of("out/result.json"))["runs"][0]["name"], "good");
  EXPECT_TRUE(fs::exists(file("out/good/registered.ply")));
}

TEST_F(KeepingTest, TwoCallsDoNotWriteIntoOneFolder) {
  const std::string script =
      "$PLIANT run small.yaml --repeat 1000 --out out & pid=$!\n"
      "until [ -d out/unfinished ]; do sleep 0.01; done\n"
      "$PLIANT run small.yaml --out out; code=$?\n"
      "kill -INT $pid; wait $pid; exit $code";
  EXPECT_EQ(shell(script), 3);
  EXPECT_THAT(text_of("script.err"), HasSubstr("error: out: another process is writing a result here"));
}

TEST_F(KeepingTest, RepeatsTellMedianAndSpread) {
  const ProgramRun once = call("run small.yaml --out once");
  EXPECT_THAT(once.out, HasSubstr("small: the time includes building kernels"));
  const ProgramRun run = call("run small.yaml --repeat 3 --out out");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr(" to "), Not(HasSubstr("building kernels"))));
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("small: warm-up, iteration 1: "), HasSubstr("small: 3 of 3, iteration 1: ")));
  const auto timing = nlohmann::json::parse(text_of("out/result.json"))["runs"][0]["timing"];
  EXPECT_EQ(timing["repeats"], 3);
  EXPECT_EQ(timing["built_kernels"], false);
  EXPECT_EQ(call("run small.yaml --repeat 0").exit_code, 2);
}

}  // namespace
}  // namespace pliant::test
