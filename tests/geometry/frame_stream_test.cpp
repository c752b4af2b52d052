#include "framework/geometry/frame_stream.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <utility>

#include "framework/core/error.h"

namespace pliant {
namespace {

using ::testing::ElementsAre;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Frame frame_at(double time) { return {DepthImage(8, 6, 500), ColorImage(8, 6), MaskImage(8, 6, 1), time}; }

/// Gives what it is made of.
class ScriptedStream : public FrameStream {
 public:
  explicit ScriptedStream(std::vector<Frame> frames) : frames_(std::move(frames)) {}
  std::string name() const override { return "street"; }
  const Rig& rig() const override { return rig_; }
  std::optional<Frame> next() override {
    if (given_ == frames_.size()) return std::nullopt;
    return frames_[given_++];
  }
  std::vector<std::string> warnings() const override { return {"read " + std::to_string(given_)}; }

  Rig rig_{{100, 100, 3.5, 2.5, 8, 6}};

 private:
  std::vector<Frame> frames_;
  std::size_t given_ = 0;
};

/// What is wrong with a stream of three frames once it is spoilt; empty: nothing.
std::string complaint(const std::function<void(std::vector<Frame>&)>& spoil) {
  std::vector<Frame> frames{frame_at(0), frame_at(0.5), frame_at(0.75)};
  spoil(frames);
  ScriptedStream stream(std::move(frames));
  try {
    CheckedStream checked(stream);
    while (checked.next()) continue;
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckedStream, GivesTheFramesAsTheyAre) {
  ScriptedStream stream({frame_at(-2), frame_at(0.5)});
  CheckedStream checked(stream);
  EXPECT_EQ(checked.next()->time, -2);
  EXPECT_EQ(checked.next()->time, 0.5);
  EXPECT_FALSE(checked.next());
  EXPECT_FALSE(checked.next()) << "the end is the end";
}

TEST(CheckedStream, RefusesAFrameThatChangesSize) {
  EXPECT_EQ(complaint([](auto& frames) { frames[1].depth = DepthImage(4, 3, 500); }),
            "street: frame 2's depth image is 4 x 3 pixels; expected the camera's 8 x 6");
  EXPECT_EQ(complaint([](auto& frames) { frames[2].color = ColorImage(8, 5); }),
            "street: frame 3's colour image is 8 x 5 pixels; expected the camera's 8 x 6");
  EXPECT_EQ(complaint([](auto& frames) { frames[2].mask = MaskImage(1, 1); }),
            "street: frame 3's mask is 1 x 1 pixels; expected the camera's 8 x 6");
}

TEST(CheckedStream, RefusesTimeThatDoesNotAdvance) {
  EXPECT_EQ(complaint([](auto& frames) { frames[2].time = 0.25; }),
            "street: the time of frame 3 is 0.25 s; expected a later one than 0.5 s, that of frame 2");
  EXPECT_EQ(complaint([](auto& frames) { frames[1].time = 0; }),
            "street: the time of frame 2 is 0 s; expected a later one than 0 s, that of frame 1");
  EXPECT_EQ(complaint([](auto& frames) { frames[0].time = nan; }),
            "street: the time of frame 1 is nan s; expected a finite number");
}

TEST(CheckedStream, RefusesAFrameWithoutDepthAndTakesOneThatSeesNothing) {
  EXPECT_EQ(complaint([](auto& frames) { frames[1].depth = {}; }), "street: frame 2's depth image is empty");
  EXPECT_EQ(complaint([](auto& frames) { frames[1].depth = DepthImage(8, 6, 0); }), "");
  EXPECT_EQ(complaint([](auto& frames) {
              frames[1].color = {};
              frames[2].mask = {};
            }),
            "")
      << "only depth has to be there";
}

TEST(CheckedStream, RefusesAStreamWithoutFrames) {
  EXPECT_EQ(complaint([](auto& frames) { frames.clear(); }), "street: the stream has no frame");
}

TEST(CheckedStream, RefusesAnEndBeforeWhatIsNeeded) {
  ScriptedStream stream({frame_at(0)});
  CheckedStream checked(stream);
  EXPECT_EQ(checked.require("the keyframe").time, 0);
  EXPECT_THAT(
      [&] { checked.require("the target"); },
      ::testing::ThrowsMessage<DataError>("street: the stream ends after frame 1; expected the target too"));
}

TEST(CheckedStream, RefusesARigThatIsNone) {
  ScriptedStream stream({frame_at(0)});
  stream.rig_.depth.fx = nan;
  EXPECT_THAT(
      [&] { CheckedStream{stream}; },
      ::testing::ThrowsMessage<DataError>(::testing::StartsWith("street: the camera's focal lengths")));
}

TEST(ReadPair, TakesTheFirstTwoFrames) {
  ScriptedStream stream({frame_at(0), frame_at(0.5), frame_at(0.25)});
  const FramePair pair = read_pair(stream);
  EXPECT_EQ(pair.name, "street");
  EXPECT_EQ(pair.camera.fx, 100);
  EXPECT_EQ(pair.source.time, 0);
  EXPECT_EQ(pair.target.time, 0.5);
  EXPECT_THAT(pair.warnings, ElementsAre("read 2"));
  EXPECT_NO_THROW(check(pair));
}

TEST(ReadPair, WarnsWhereTheColourCameraSeesNothingOfTheDepth) {
  const auto warnings_of = [](double shift) {
    Frame source = frame_at(0);
    Frame target = frame_at(1);
    for (Frame* frame : {&source, &target}) frame->color = ColorImage(8, 6, Rgb{200, 100, 50});
    ScriptedStream stream({source, target});
    stream.rig_.color = stream.rig_.depth;
    stream.rig_.color_from_depth = Eigen::Translation3d(shift, 0, 0);
    return read_pair(stream).warnings;
  };
  EXPECT_THAT(warnings_of(0), ElementsAre("read 2"));
  EXPECT_THAT(warnings_of(-90000), ElementsAre("read 2", ::testing::HasSubstr("nothing of the source's")));
}

TEST(ReadPair, NeedsTwoFramesThatSeeSomething) {
  const auto pair_of = [](Frame source, Frame target) {
    ScriptedStream stream({std::move(source), std::move(target)});
    read_pair(stream);
  };
  Frame blind = frame_at(1);
  blind.depth = DepthImage(8, 6, 0);
  EXPECT_THAT(
      [&] { pair_of(frame_at(0), blind); },
      ::testing::ThrowsMessage<DataError>("street: the target sees nothing: no valid depth inside its mask"));
  blind = frame_at(0);
  blind.mask = MaskImage(8, 6, 0);
  EXPECT_THAT(
      [&] { pair_of(blind, frame_at(1)); },
      ::testing::ThrowsMessage<DataError>("street: the source sees nothing: no valid depth inside its mask"));
}

TEST(ReadPair, SaysWhenAFrameIsMissing) {
  const auto error_of = [](std::vector<Frame> frames) {
    ScriptedStream stream(std::move(frames));
    try {
      read_pair(stream);
    } catch (const DataError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_of({}), "street: the stream has no frame");
  EXPECT_EQ(error_of({frame_at(0)}), "street: the stream ends after frame 1; expected the target too");
}

}  // namespace
}  // namespace pliant
