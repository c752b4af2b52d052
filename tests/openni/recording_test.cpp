#include <gmock/gmock.h>

#include <OpenNI.h>
#include <fmt/format.h>

#include "framework/geometry/prefetched_stream.h"
#include "tests/datasets/data_of.h"
#include "tests/openni/scripted_files.h"

namespace pliant {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int count = 12;  // images that the camera plays

class OpenNiRecording : public test::ScriptedFiles {
 protected:
  /// Of a camera with these lines before its images.
  std::string recorded(const std::string& sensors) const {
    plug_in(sensors + images(count));
    const bool has_color = sensors.find("mode color") != std::string::npos;
    return record("r.oni", has_color ? 2 * count : count);
  }

  std::vector<Frame> read(const std::string& entries) const {
    return frames_of(*open("recording: '" + file("r.oni") + "', " + entries));
  }

  /// Expects the last of the images that the camera played, most of them, without a bit lost.
  static void expect_last_images(const std::vector<Frame>& frames, bool with_color) {
    ASSERT_GE(frames.size(), static_cast<std::size_t>(count) / 2);
    const int first = count + 1 - static_cast<int>(frames.size());
    // The recorder may have missed the first depth and not the colour after it; it counts the times of both
    // from 0.
    const bool is_apart = with_color && frames[0].color.pixels() != color(first).pixels();
    for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
      const Frame& frame = frames[static_cast<std::size_t>(i)];
      EXPECT_EQ(frame.depth.pixels(), depth(first + i).pixels());
      const ColorImage expected = with_color ? color(first + i - (is_apart ? 1 : 0)) : ColorImage();
      EXPECT_EQ(frame.color.pixels(), expected.pixels());
      EXPECT_NEAR(frame.time, i * 0.033333, 1e-9);
    }
  }
};

TEST_F(OpenNiRecording, LosesNothing) {
  recorded(both_sensors());
  const auto stream = open("registered: true, recording: '" + file("r.oni") + "'");
  EXPECT_EQ(stream->name(), "r");
  EXPECT_FALSE(stream->rig().color);
  expect_last_images(frames_of(*stream), true);
  EXPECT_FALSE(stream->next()) << "the end is the end";
  EXPECT_THAT(stream->warnings(), IsEmpty());
}

TEST_F(OpenNiRecording, OfDepthAloneLosesNothing) {
  recorded(depth_sensor());
  expect_last_images(read("first: 1"), false);
}

TEST_F(OpenNiRecording, WithoutItsColourLosesNothing) {
  recorded(both_sensors());
  expect_last_images(read("color: false"), false);
}

TEST_F(OpenNiRecording, PlaysAgainAndFromAnyFrameOn) {
  recorded(both_sensors());
  const auto all = read("registered: true");
  for (int again = 0; again < 10; ++again) EXPECT_EQ(read("registered: true").size(), all.size());
  const auto some = read("registered: true, first: 2, step: 3, frames: 2");
  ASSERT_EQ(some.size(), 2U);
  EXPECT_EQ(some[0].depth.pixels(), all[1].depth.pixels());
  EXPECT_EQ(some[1].depth.pixels(), all[4].depth.pixels());
  EXPECT_EQ(some[1].time, all[4].time);
  EXPECT_THAT(error_of("first: 100, recording: '" + file("r.oni") + "'"),
              HasSubstr(fmt::format("frame 100 is to be the first, but it has {}", all.size())));
}

TEST_F(OpenNiRecording, IsReadAheadToTheSameBits) {
  recorded(both_sensors());
  const auto stream = open("registered: true, recording: '" + file("r.oni") + "'");
  ASSERT_TRUE(stream->reads_on_host());
  PrefetchedStream ahead(*stream);
  expect_last_images(frames_of(ahead), true);
}

TEST_F(OpenNiRecording, IsClosedAtAnyFrame) {
  recorded(both_sensors());
  for (int frames = 0; frames < 5; ++frames)
    EXPECT_EQ(frames_of(*open("recording: '" + file("r.oni") + "'"), frames).size(),
              static_cast<std::size_t>(frames));
}

TEST_F(OpenNiRecording, ThatDoesNotTellItsRegistrationIsTakenForNone) {
  recorded(both_sensors());
  const auto stream = open("recording: '" + file("r.oni") + "'");
  EXPECT_TRUE(stream->rig().color);
  EXPECT_THAT(stream->warnings(),
              ElementsAre(HasSubstr("say by 'registered'"), HasSubstr("'color_from_depth'")));
}

TEST_F(OpenNiRecording, OfAMirroredCameraIsTurnedRound) {
  recorded(depth_sensor() + "mirrored\n");
  const auto frames = read("frames: 1");
  int number = 1;  // of the first that the recorder did not miss
  while (number < count && frames.front().depth(width - 1, 3) != depth(number)(0, 3)) ++number;
  EXPECT_EQ(frames.front().depth(4, 9), depth(number)(width - 1 - 4, 9));
}

TEST_F(OpenNiRecording, ThatIsNoneIsAnError) {
  const std::string good = recorded(both_sensors());
  const auto error_with = [&](const std::string& path) { return error_of("recording: '" + path + "'"); };
  EXPECT_THAT(error_with(file("")), HasSubstr(": it is no file"));
  EXPECT_THAT(error_with(write("text.oni", std::string("hello"))),
              AllOf(HasSubstr("text.oni: OpenNI2 cannot play it"), HasSubstr("expected a recording")));
  EXPECT_THAT(error_with(cut(good, 40)), HasSubstr("cut40.oni"));
  EXPECT_THAT(error_with(cut(good, 20000)), HasSubstr("cut20000"));
  std::filesystem::create_directories(file(std::string(200, 'x')));
  EXPECT_THAT(
      error_with(write(std::string(200, 'x') + "/" + std::string(60, 'y') + ".oni", std::string("NI10"))),
      HasSubstr("OpenNI2 takes 255 at most"));
}

}  // namespace
}  // namespace pliant
