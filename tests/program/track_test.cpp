// `pliant track` as a program: how it ends, and what it leaves.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

class TrackProgramTest : public ProgramTest {
 protected:
  /// A head that turns for `frames` frames.
  void write_experiment(int frames) const {
    write("head.yaml",
          "data: {type: head, image_width: 160, image_height: 120, focal_length: 131.25, frames: " +
              std::to_string(frames) +
              ", motion: {rotation_y: 10}}\n"
              "model: {type: tsdf, volume: fitted, resolution: 64}\n");
  }

  /// Starts tracking, waits until so many frames have been told, sends a signal; gives the exit status.
  int track_until(std::size_t frames, int signal) const {
    const pid_t child = ::fork();
    if (child == 0) {
      ::execl(
          "/bin/sh", "sh", "-c",
          ("cd '" + file("") + "' && exec '" PLIANT_PROGRAM "' track head.yaml --out out >out.txt 2>err.txt")
              .c_str(),
          nullptr);
      ::_exit(127);
    }
    int status = 0;
    while (lines_of("out/unfinished/frames.jsonl").size() < frames && ::waitpid(child, &status, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ::kill(child, signal);
    ::waitpid(child, &status, 0);
    return status;
  }

  /// Of a file that may not be there; the last one may be torn.
  std::vector<std::string> lines_of(const std::string& name) const {
    if (!fs::exists(file(name))) return {};
    std::vector<std::string> lines;
    std::istringstream text(text_of(name));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  }
};

TEST_F(TrackProgramTest, AnInterruptionEndsItWithWhatThereIs) {
  write_experiment(100000);
  const int status = track_until(5, SIGINT);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << text_of("err.txt");
  EXPECT_THAT(text_of("err.txt"), HasSubstr("finishing with what there is"));
  const auto run = nlohmann::json::parse(text_of("out/result.json"))["runs"][0];
  EXPECT_GE(run["frames"], 5);
  EXPECT_EQ(lines_of("out/frames.jsonl").size(), run["frames"]);
  EXPECT_TRUE(fs::exists(file("out/model.ply")) && fs::exists(file("out/index.html")));
}

TEST_F(TrackProgramTest, WhatIsKilledKeepsItsFrames) {
  write_experiment(100000);
  const int status = track_until(5, SIGKILL);
  EXPECT_TRUE(WIFSIGNALED(status));
  const auto lines = lines_of("out/unfinished/frames.jsonl");
  ASSERT_GE(lines.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(nlohmann::json::parse(lines[i])["frame"], i + 1);
  EXPECT_GE(lines_of("out/unfinished/trajectory.txt").size(), 5U);
  write_experiment(3);
  EXPECT_EQ(call("track head.yaml --out out").exit_code, 0) << "what was left is in nobody's way";
  EXPECT_EQ(lines_of("out/frames.jsonl").size(), 3U);
  EXPECT_FALSE(fs::exists(file("out/unfinished")));
}

TEST_F(TrackProgramTest, RunDoesTheSameAndRegisteringNeedsNoModel) {
  write_experiment(3);
  ASSERT_EQ(call("run head.yaml --out out").exit_code, 0);
  EXPECT_EQ(lines_of("out/frames.jsonl").size(), 3U);
  write("pair.yaml", "data: {type: head}\n");
  const ProgramRun without_model = call("track pair.yaml");
  EXPECT_EQ(without_model.exit_code, 2);
  EXPECT_THAT(without_model.errors(), Each(AllOf(HasSubstr("pair.yaml"), HasSubstr("'model'"))));
}

}  // namespace
}  // namespace pliant::test
