#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "tests/datasets/data_of.h"
#include "tests/openni/scripted_files.h"

namespace pliant {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class OpenNiCamera : public test::ScriptedFiles {
 protected:
  ~OpenNiCamera() override { ::unsetenv("PLIANT_SCRIPTED_CAMERA"); }

  static double focal_length(int pixels, double view) { return pixels / (2 * std::tan(view / 2)); }
};

TEST_F(OpenNiCamera, GivesWhatItSeesInMillimetresAndSeconds) {
  plug_in(both_sensors() + "registers\n" + images(3));
  const auto stream = open("frames: 3");
  EXPECT_EQ(stream->name(), "Scripted camera (scripted)");
  const auto frames = frames_of(*stream);
  ASSERT_EQ(frames.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(frames[i].depth.pixels(), depth(i + 1).pixels());
    EXPECT_EQ(frames[i].color.pixels(), color(i + 1).pixels());
    EXPECT_NEAR(frames[i].time, i * 0.033333, 1e-9);
  }
  EXPECT_THAT(stream->warnings(), IsEmpty());
  EXPECT_FALSE(stream->truth(2));
  EXPECT_FALSE(stream->camera_pose(1));
}

TEST_F(OpenNiCamera, RegisteredDepthIsSeenThroughTheColourCamera) {
  plug_in(both_sensors() + "registers\n");
  const Rig rig = open()->rig();
  EXPECT_FALSE(rig.color);
  EXPECT_NEAR(rig.depth.fx, focal_length(width, 1.1), 1e-4);
  EXPECT_NEAR(rig.depth.fy, focal_length(height, 0.9), 1e-4);
  EXPECT_EQ(rig.depth.cx, 19.5);
  EXPECT_EQ(rig.depth.cy, 14.5);
}

TEST_F(OpenNiCamera, WithoutRegistrationThereAreTwoCameras) {
  plug_in(both_sensors());
  const auto stream = open();
  EXPECT_NEAR(stream->rig().depth.fx, focal_length(width, 1.0), 1e-4);
  ASSERT_TRUE(stream->rig().color);
  EXPECT_NEAR(stream->rig().color->fy, focal_length(height, 0.9), 1e-4);
  EXPECT_THAT(stream->warnings(), ElementsAre(HasSubstr("say by 'color_from_depth' where it is")));
  EXPECT_THAT(error_of("registered: true"), HasSubstr("the camera cannot register depth to colour"));
}

TEST_F(OpenNiCamera, AColourCameraOfItsOwnIsDescribed) {
  plug_in(both_sensors() + "registers\n" + images(1));
  const std::string place = "color_from_depth: [1, 0, 0, -25, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
  const std::string matrix = write("k.txt", std::string("45 0 20\n0 45 15\n0 0 1\n"));
  const auto stream = open("color_intrinsics: '" + matrix + "', " + place);
  ASSERT_TRUE(stream->rig().color);
  EXPECT_EQ(stream->rig().color->fx, 45);
  EXPECT_EQ(stream->rig().color_from_depth.translation().x(), -25);
  EXPECT_THAT(stream->warnings(), IsEmpty());
  EXPECT_THAT(test::config_error_of("{type: openni, color: false, " + place + "}"),
              HasSubstr("colour is not wanted"));
  EXPECT_THAT(test::config_error_of("{type: openni, registered: true, " + place + "}"),
              HasSubstr("colour is 'registered'"));
}

TEST_F(OpenNiCamera, ColourMayBeAbsentOrUnwanted) {
  plug_in(both_sensors() + images(2));
  auto frames = frames_of(*open("color: false, frames: 2"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].color.empty());
  EXPECT_EQ(frames[1].depth.pixels(), depth(2).pixels());
  plug_in(depth_sensor() + images(2));
  const auto stream = open("frames: 2");
  EXPECT_EQ(frames_of(*stream)[1].depth.pixels(), depth(2).pixels());
  EXPECT_FALSE(stream->rig().color);
  EXPECT_THAT(stream->warnings(), IsEmpty());
}

TEST_F(OpenNiCamera, MirroredImagesAreTurnedRound) {
  plug_in(both_sensors() + "registers\nmirrored\n" + images(1));
  const auto frames = frames_of(*open("frames: 1"));
  EXPECT_EQ(frames[0].depth(0, 3), depth(1)(width - 1, 3));
  EXPECT_EQ(frames[0].color(5, 7), color(1)(width - 1 - 5, 7));
}

TEST_F(OpenNiCamera, IsSetToTheModeWithMostPixelsThatIsSmooth) {
  plug_in(
      "view depth 1 0.8\nmode depth 20 15 60\nmode depth 40 30 60\nmode depth 40 30 30\nmode depth 80 60 "
      "7\n" +
      depth_line(1, 0) + depth_line(2, 33'333));
  const auto stream = open("frames: 2");
  EXPECT_EQ(stream->rig().depth.width, 40);
  EXPECT_EQ(frames_of(*stream)[0].depth.pixels(), depth(1).pixels());
  EXPECT_THAT(stream->warnings(), IsEmpty()) << "of 30 images a second, none is missing";
}

TEST_F(OpenNiCamera, ColourOfAnotherSizeIsNotRegistered) {
  plug_in(depth_sensor() + "registers\nview color 1.1 0.9\nmode color 80 60 30\n");
  EXPECT_EQ(open()->rig().color.value().width, 80);
}

TEST_F(OpenNiCamera, TheColourOfTheDepthsSizeIsTaken) {
  plug_in(depth_sensor() + "registers\nview color 1.1 0.9\nmode color 80 60 30\nmode color 40 30 30\n" +
          images(1));
  const auto stream = open("frames: 1");
  EXPECT_FALSE(stream->rig().color);
  EXPECT_EQ(frames_of(*stream)[0].color.pixels(), color(1).pixels());
}

TEST_F(OpenNiCamera, IntrinsicsThatAreGivenCount) {
  plug_in("mode depth 40 30 30\n" + images(1));
  EXPECT_THAT(error_of(""), HasSubstr("does not tell its field of view; give 'intrinsics'"));
  EXPECT_EQ(open("fx: 50, fy: 50, cx: 20, cy: 15")->rig().depth.cx, 20);
}

TEST_F(OpenNiCamera, FramesAreSelected) {
  plug_in(both_sensors() + "registers\n" + images(7));
  const auto frames = frames_of(*open("first: 2, step: 2, frames: 3"));
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].depth.pixels(), depth(2).pixels());
  EXPECT_EQ(frames[2].color.pixels(), color(6).pixels());
}

TEST_F(OpenNiCamera, DroppedFramesAreCounted) {
  plug_in(depth_sensor() + depth_line(1, 0) + depth_line(2, 34'000) + depth_line(3, 133'000) +
          depth_line(4, 201'000));
  const auto stream = open("frames: 4");
  EXPECT_EQ(frames_of(*stream).size(), 4U);
  EXPECT_THAT(
      stream->warnings(),
      ElementsAre(HasSubstr("3 frames were dropped, by the times of 4 that came; the first after frame 2")));
}

TEST_F(OpenNiCamera, AFrameThatGoesBackInTimeIsLeftOut) {
  plug_in(depth_sensor() + depth_line(1, 50'000) + depth_line(2, 20'000) + depth_line(3, 50'000) +
          depth_line(4, 83'000));
  const auto stream = open("frames: 2");
  const auto frames = frames_of(*stream);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].depth.pixels(), depth(4).pixels());
  EXPECT_THAT(stream->warnings(), ElementsAre(HasSubstr("2 frames are left out whose time is not later")));
}

TEST_F(OpenNiCamera, AFrameWithoutColourGoesAlone) {
  plug_in(both_sensors() + "registers\n" + depth_line(1, 0) + color_line(1, 5'000) + depth_line(2, 33'000) +
          depth_line(3, 66'000) + color_line(3, 71'000));
  const auto stream = open("frames: 3");
  const auto frames = frames_of(*stream);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(frames[1].color.empty());
  EXPECT_EQ(frames[2].color.pixels(), color(3).pixels());
  EXPECT_THAT(stream->warnings(), ElementsAre(HasSubstr("1 of 3 frames have no colour within 20 ms")));
}

TEST_F(OpenNiCamera, AFrameOfAnotherSizeIsRefused) {
  plug_in(depth_sensor() + depth_line(1, 0) + depth_line(2, 33'000, "20"));
  EXPECT_THAT(error_of(""),
              HasSubstr("frame 2's depth image is 40 x 20 pixels; expected the camera's 40 x 30"));
}

TEST_F(OpenNiCamera, UnpluggedInARunIsAnErrorOfItsOwnAfterWhatCame) {
  plug_in(both_sensors() + "registers\n" + images(3) + "unplug\n");
  const auto stream = open();
  CheckedStream frames(*stream);
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(frames.next()->depth.pixels(), depth(i).pixels());
  try {
    frames.next();
    FAIL() << "the camera is unplugged";
  } catch (const SourceLost& lost) {
    EXPECT_STREQ(lost.what(), "Scripted camera (scripted): the camera was unplugged");
    EXPECT_EQ(lost.exit_code(), 3);
  }
}

TEST_F(OpenNiCamera, ThatFallsSilentIsLost) {
  plug_in(depth_sensor() + images(1));
  const auto stream = open();
  CheckedStream frames(*stream);
  frames.next();
  EXPECT_THAT([&] { frames.next(); }, ::testing::ThrowsMessage<SourceLost>(HasSubstr("no image for 5 s")));
}

TEST_F(OpenNiCamera, ThatIsNotThereIsAnErrorThatSaysWhatToDo) {
  EXPECT_THAT(error_of(""), AllOf(HasSubstr("the camera cannot be opened"), HasSubstr("plug one in"),
                                  HasSubstr("lib*.so.0")));
  plug_in(depth_sensor());
  EXPECT_THAT(error_of("device: 'usb 3'"), AllOf(HasSubstr("the camera 'usb 3' cannot be opened"),
                                                 HasSubstr("'scripted' (Scripted camera)")));
  EXPECT_EQ(open("device: scripted")->rig().depth.width, width);
  plug_in(both_sensors().substr(both_sensors().find("view color")));
  EXPECT_THAT(error_of(""), HasSubstr("it has no depth sensor"));
  EXPECT_THAT(
      test::config_error_of("{type: openni, device: a, recording: '" + write("b.oni", std::string()) + "'}"),
      HasSubstr("both a 'recording' and a 'device'"));
}

TEST_F(OpenNiCamera, WithoutADriverTheProgramSaysWhatToInstall) {
  write("e.yaml", std::string("extends: methods/best.yaml\ndata: {type: openni}\n"));
  const auto run = call("check e.yaml", "LD_LIBRARY_PATH='" WITHOUT_DRIVERS "'");
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("OpenNI2 has no driver"), HasSubstr("install Debian's libopenni2-0")));
}

// What OpenNI2's drivers lose is nobody's once they are unloaded: no suppression knows it.
constexpr const char* with_driver = "ASAN_OPTIONS=detect_leaks=0 LD_LIBRARY_PATH='" WITH_DRIVER "'";

TEST_F(OpenNiCamera, UnpluggedWhileItIsRecordedKeepsWhatCame) {
  plug_in(both_sensors() + "registers\n" + images(3) + "unplug\n");
  const auto run = call("data make openni --layout tum --out mine", with_driver);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the camera was unplugged"));
  EXPECT_THAT(run.out, HasSubstr("3 frames of Scripted camera"));
  const auto frames = frames_of(*test::data_of("{type: tum, folder: '" + file("mine") + "', intrinsics: '" +
                                               file("mine/intrinsics.txt") + "'}")
                                     ->open(test::shared_device(), 0));
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[2].depth.pixels(), depth(3).pixels());
  EXPECT_EQ(frames[2].color.pixels(), color(3).pixels());
}

TEST_F(OpenNiCamera, UnpluggedWhileItIsTrackedLeavesWhatWasTracked) {
  plug_in(both_sensors() + "registers\n" + images(3) + "unplug\n");
  write("e.yaml", std::string("data: {type: openni}\nmodel: {type: tsdf, volume: fitted, resolution: 32}\n"
                              "acquisition: {filter: none}\nreports: {}\n"));
  const auto run = call("track e.yaml --out mine", with_driver);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the camera was unplugged"));
  EXPECT_THAT(text_of("mine/result.json"), HasSubstr("\"frames\": 3"));
  EXPECT_THAT(text_of("mine/frames.jsonl"), HasSubstr("\"frame\":3"));
  EXPECT_THAT(text_of("mine/model.ply"), HasSubstr("end_header"));
}

}  // namespace
}  // namespace pliant
