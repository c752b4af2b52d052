#include <gmock/gmock.h>

#include <fmt/format.h>

#include "tests/datasets/sequence_files.h"

namespace pliant {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Five frames at 30 a second; colour comes 10 ms after its depth.
class TumFolder : public test::SequenceFiles {
 protected:
  TumFolder() {
    make_folder("depth");
    make_folder("rgb");
    for (int i = 0; i < 5; ++i) {
      write_depth(file(fmt::format("depth/{}.png", i)), slope(static_cast<float>(4001 + 100 * i)));
      write_color(file(fmt::format("rgb/{}.png", i)),
                  ColorImage(width, height, {static_cast<std::uint8_t>(i), 20, 30}));
    }
    write("depth.txt", list("depth", 0));
    write("rgb.txt", list("rgb", 0.01));
  }

  static std::string list(const std::string& kind, double later) {
    std::string text = "# a list\n# timestamp filename\n";
    for (int i = 0; i < 5; ++i)
      text += fmt::format("{:.6f} {}/{}.png\n", 1305031102.175304 + i / 30.0 + later, kind, i);
    return text;
  }

  std::string section(const std::string& rest = "") const {
    return fmt::format("{{type: tum, folder: '{}', fx: 50, fy: 50, cx: 19.5, cy: 14.5{}}}", file(""), rest);
  }
};

TEST_F(TumFolder, IsAStreamInMillimetresAndSeconds) {
  const auto stream = open(section());
  EXPECT_EQ(stream->name(), std::filesystem::path(file("a")).parent_path().filename());
  EXPECT_EQ(stream->rig().depth.fx, 50);
  EXPECT_EQ(stream->rig().depth.width, width);
  const auto frames = frames_of(*stream);
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_FLOAT_EQ(frames[0].depth(0, 0), 800.2F);
  EXPECT_FLOAT_EQ(frames[4].depth(3, 0), 880.8F);
  EXPECT_EQ(frames[4].color(0, 0), (Rgb{4, 20, 30}));
  EXPECT_EQ(frames[0].time, 0);
  EXPECT_NEAR(frames[3].time, 0.1, 1e-5);
  EXPECT_THAT(stream->warnings(), IsEmpty());
  EXPECT_FALSE(stream->truth(2));
}

TEST_F(TumFolder, GivesTheFramesThatAreSelected) {
  const auto frames = frames_of(*open(section(", first: 2, step: 2, frames: 2")));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].color(0, 0).r, 1);
  EXPECT_EQ(frames[1].color(0, 0).r, 3);
  EXPECT_EQ(frames_of(*open(section(", first: 5"))).size(), 1U);
  EXPECT_THAT(error_of(section(", first: 6")), HasSubstr("frame 6 is to be the first, but it has 5"));
}

TEST_F(TumFolder, TakesTheAssociationsWhicheverComesFirst) {
  write("associations.txt",
        std::string("1.0 rgb/2.png 1.01 depth/0.png\r\n2.0 rgb/1.png 2.01 depth/3.png\r\n"));
  auto frames = frames_of(*open(section()));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].color(0, 0).r, 2);
  EXPECT_NEAR(frames[1].time, 1, 1e-9);
  write("associations.txt", std::string("1.01 depth/0.png 1.0 rgb/2.png\n2.01 depth/3.png 2.0 rgb/1.png\n"));
  EXPECT_EQ(frames_of(*open(section()))[1].color.pixels(), frames[1].color.pixels());
}

TEST_F(TumFolder, EachColourGoesWithTheNearestDepthOnce) {
  write("depth.txt", std::string("1.000 depth/0.png\n1.015 depth/1.png\n2 depth/2.png\n"));
  write("rgb.txt", std::string("1.012 rgb/4.png\n2.019 rgb/3.png\n"));
  const auto stream = open(section());
  const auto frames = frames_of(*stream);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].color(0, 0).r, 4);
  EXPECT_FLOAT_EQ(frames[0].depth(0, 0), 820.2F) << "the nearer of both";
  EXPECT_THAT(stream->warnings(), ElementsAre(HasSubstr("1 of 3 depth images have no colour within 20 ms")));
}

TEST_F(TumFolder, WithoutListOfColourThereIsNone) {
  std::filesystem::remove(file("rgb.txt"));
  const auto frames = frames_of(*open(section()));
  ASSERT_EQ(frames.size(), 5U);
  EXPECT_TRUE(frames[0].color.empty());
}

TEST_F(TumFolder, HasTheBenchmarksCameras) {
  write_depth(file("depth/0.png"), DepthImage(640, 480, 4001));
  write("depth.txt", std::string("1 depth/0.png\n"));
  std::filesystem::remove(file("rgb.txt"));
  const auto camera_of = [&](const std::string& camera) {
    return open("{type: tum, folder: '" + file("") + "'" + camera + "}")->rig().depth;
  };
  EXPECT_EQ(camera_of("").fx, 525);
  EXPECT_EQ(camera_of(", camera: freiburg1").cy, 255.3);
  EXPECT_EQ(camera_of(", camera: freiburg3").fy, 539.2);
}

TEST_F(TumFolder, TheCameraIsGivenOnceAndWhole) {
  write("k.txt", std::string("50 0 19.5\n0 50 14.5\n0 0 1\n"));
  const std::string folder = "{type: tum, folder: '" + file("") + "', ";
  EXPECT_EQ(open(folder + "intrinsics: '" + file("k.txt") + "'}")->rig().depth.cx, 19.5);
  EXPECT_THAT(test::config_error_of(folder + "fx: 50, fy: 50, cx: 1}"), HasSubstr("'cy' is missing"));
  EXPECT_THAT(test::config_error_of(folder + "fx: 50, intrinsics: '" + file("k.txt") + "'}"),
              HasSubstr("both 'intrinsics' and numbers"));
  EXPECT_THAT(error_of(folder + "camera: freiburg2}"),
              AllOf(HasSubstr("camera: freiburg2"), HasSubstr("40x30")));
}

TEST_F(TumFolder, AWrongScaleIsDoubted) {
  for (int i = 0; i < 5; ++i) write_depth(file(fmt::format("depth/{}.png", i)), slope(801));
  EXPECT_THAT(open(section())->warnings(),
              ElementsAre(AllOf(HasSubstr("0.png: the median depth is 164"), HasSubstr("depth_scale is 1"))));
  EXPECT_THAT(open(section(", depth_scale: 1"))->warnings(), IsEmpty());
}

TEST_F(TumFolder, AGapInTimeIsDoubtedWithBothFrames) {
  write("depth.txt", std::string("1.0 depth/0.png\n1.03 depth/1.png\n1.06 depth/2.png\n3.0 depth/3.png\n"));
  std::filesystem::remove(file("rgb.txt"));
  EXPECT_THAT(open(section())->warnings(),
              ElementsAre(AllOf(HasSubstr("1.94 s pass between frame 3"), HasSubstr("depth/2.png"),
                                HasSubstr("frame 4"), HasSubstr("65 times"))));
}

TEST_F(TumFolder, ListsThatAreNoneAreErrorsWithTheirLine) {
  const auto error_with = [&](const std::string& depth) {
    write("depth.txt", depth);
    return error_of(section());
  };
  EXPECT_THAT(error_with("# nothing\n\n"), HasSubstr("depth.txt: no frame"));
  EXPECT_THAT(error_with("#\n1 depth/0.png\n1 depth/1.png\n"),
              HasSubstr("depth.txt:3: the time 1.000000 is not later than 1.000000 in line 2"));
  EXPECT_THAT(error_with("1\n"), HasSubstr("depth.txt:1: 1 words, expected a time and a file"));
  EXPECT_THAT(error_with("x depth/0.png\n"), HasSubstr("depth.txt:1: 'x' is not a number"));
  EXPECT_THAT(error_with("9 depth/0.png\n"), HasSubstr("within 20 ms of any colour"));
  write("associations.txt", std::string("1 a.png 2 b.png\n"));
  EXPECT_THAT(error_of(section()), HasSubstr("associations.txt:1: which file is the depth"));
  write("associations.txt", std::string("1 rgb/0.png 2\n"));
  EXPECT_THAT(error_of(section()), HasSubstr("associations.txt:1: 3 words, expected TIME FILE TIME FILE"));
  write("associations.txt", std::string());
  EXPECT_THAT(error_of(section()), HasSubstr("associations.txt: no frame"));
}

TEST_F(TumFolder, MissingFilesAndOtherSizesAreErrors) {
  std::filesystem::remove(file("rgb/3.png"));
  EXPECT_THAT(error_of(section()), HasSubstr(file("rgb/3.png") + ": no such file"));
  write_color(file("rgb/3.png"), ColorImage(width, height - 1));
  EXPECT_THAT(error_of(section()),
              AllOf(HasSubstr("rgb/3.png: 40x29 pixels"), HasSubstr("depth/3.png has 40x30")));
  std::filesystem::remove(file("rgb.txt"));
  write_depth(file("depth/2.png"), DepthImage(width + 1, height, 4000));
  EXPECT_THAT(error_of(section()),
              AllOf(HasSubstr("depth/2.png: 41x30 pixels"), HasSubstr("depth/0.png has 40x30")));
  std::filesystem::remove(file("depth.txt"));
  EXPECT_THAT(error_of(section()), HasSubstr(file("depth.txt") + ": no such file"));
}

}  // namespace
}  // namespace pliant
