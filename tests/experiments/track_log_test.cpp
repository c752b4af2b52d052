// What a tracked run tells of its frames outlasts whatever ends it.
#include "experiments/tasks/track_log.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "experiments/runner/run_frames.h"
#include "experiments/tasks/json_file.h"
#include "tests/io/test_files.h"

namespace pliant::test {
namespace {

using ::testing::HasSubstr;

FrameRecord tracked(int number) {
  FrameRecord record;
  record.number = number;
  record.time = number / 30.0;
  record.state = FrameState::tracked;
  record.pose.mean_error = 0.5 + number;
  record.time_ms = {{"icp", 1.25}, {"integrate", 3.5}};
  return record;
}

class TrackLogTest : public TestFiles {
 protected:
  /// Logs frames in a process of its own until that is killed; gives how many of them it said it had
  /// finished.
  int log_until_killed(std::chrono::microseconds after) const {
    int ends[2];
    if (::pipe(ends) != 0) return -1;
    const pid_t child = ::fork();
    if (child == 0) {
      TrackLog log(file(""));
      for (int number = 1;; ++number) {
        log.add(tracked(number), PoseError{0.5, 0.25}, {});
        if (::write(ends[1], &number, sizeof number) != sizeof number) ::_exit(1);
      }
    }
    ::close(ends[1]);
    int finished = 0;
    while (finished < 1 && ::read(ends[0], &finished, sizeof finished) == sizeof finished) continue;
    std::thread killer([&] {
      std::this_thread::sleep_for(after);
      ::kill(child, SIGKILL);
    });
    for (int number = 0; ::read(ends[0], &number, sizeof number) == sizeof number;) finished = number;
    killer.join();
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    ::close(ends[0]);
    return finished;
  }
};

TEST_F(TrackLogTest, KilledAtAnyMomentItHoldsEveryFinishedFrame) {
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    for (const auto& name : TrackLog::files()) std::filesystem::remove(file(name));
    const int finished = log_until_killed(std::chrono::microseconds(random() % 20000));
    ASSERT_GE(finished, 1);
    const auto lines = read_json_lines(file("frames.jsonl"));
    ASSERT_GE(static_cast<int>(lines.size()), finished);
    ASSERT_LE(static_cast<int>(lines.size()), finished + 1) << "one may be logged that was not finished";
    for (std::size_t at = 0; at < lines.size(); ++at) {
      ASSERT_EQ(lines[at]["frame"], at + 1);
      ASSERT_EQ(lines[at]["error"]["rotation"], 0.25) << "the line is whole";
    }
    EXPECT_GE(static_cast<int>(read_whole_lines(file("frames.csv")).size()), finished + 1);
    EXPECT_GE(static_cast<int>(read_whole_lines(file("trajectory.txt")).size()), finished);
  }
}

TEST_F(TrackLogTest, IsReadAsNumbersOfFramesThatWereTracked) {
  EXPECT_TRUE(read_run_frames(file("")).empty());
  {
    TrackLog log(file(""));
    FrameRecord lost = tracked(1);
    lost.state = FrameState::lost;
    log.add(lost, {}, {});
    log.add(tracked(2), PoseError{0.5, 0.25}, {});
  }
  const auto frames = read_run_frames(file(""));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0], (Numbers{{"frame", 1}}));
  EXPECT_EQ(frames[1].at("mean_error"), 2.5);
  EXPECT_EQ(frames[1].at("time_ms.icp"), 1.25);
  EXPECT_EQ(frames[1].at("error.translation"), 0.5);
  write("frames.jsonl", "{\"number\": 3}\n");
  EXPECT_THAT(data_error_of([&] { read_run_frames(file("")); }),
              HasSubstr("frames.jsonl: is no log of frames"));
}

}  // namespace
}  // namespace pliant::test
