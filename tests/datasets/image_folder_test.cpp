#include <gmock/gmock.h>

#include <fmt/format.h>

#include "experiments/datasets/numbered_files.h"
#include "tests/datasets/sequence_files.h"

namespace pliant {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(NaturalOrder, CountsNumbersAsSuch) {
  const NaturalOrder before;
  EXPECT_TRUE(before("a2", "a10"));
  EXPECT_FALSE(before("a10", "a2"));
  EXPECT_TRUE(before("a", "b1"));
  EXPECT_TRUE(before("a", "a0"));
  EXPECT_TRUE(before("2_9", "10_1"));
  EXPECT_TRUE(before("99999999999999999999998", "99999999999999999999999"));
  EXPECT_FALSE(before("007", "7") || before("7", "007"));
  EXPECT_FALSE(before("", ""));
}

/// Frames 9, 10 and 11 with colour, and a mask for the first.
class ImageFolderFiles : public test::SequenceFiles {
 protected:
  ImageFolderFiles() {
    make_folder("depth");
    make_folder("color");
    for (int i = 9; i < 12; ++i) {
      write_depth(file(fmt::format("depth/d{}.png", i)), slope(static_cast<float>(700 + i)));
      write_color(file(fmt::format("color/{:05}.png", i)),
                  ColorImage(width, height, {static_cast<std::uint8_t>(i), 20, 30}));
    }
    write_mask(file("9_mask.png"), MaskImage(width, height, 1));
  }

  std::string section(const std::string& rest) const {
    return fmt::format(
        "{{type: folder, folder: '{}', depth: depth/d*.png, fx: 50, fy: 50, cx: 19.5, cy: 14.5{}}}", file(""),
        rest);
  }
};

TEST_F(ImageFolderFiles, AreSortedByNumberAndBelongTogether) {
  const auto stream = open(section(", color: color/*.png, mask: '*_mask.png', rate: 10"));
  const auto frames = frames_of(*stream);
  EXPECT_EQ(stream->name(), std::filesystem::path(file("a")).parent_path().filename());
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].depth(0, 0), 709);
  EXPECT_EQ(frames[2].depth(0, 0), 711);
  EXPECT_EQ(frames[1].color(0, 0).r, 10);
  EXPECT_FALSE(frames[0].mask.empty());
  EXPECT_TRUE(frames[1].mask.empty());
  EXPECT_DOUBLE_EQ(frames[2].time, 0.2);
  EXPECT_THAT(stream->warnings(), ElementsAre(HasSubstr("2 of 3 frames have no mask")));
}

TEST_F(ImageFolderFiles, DepthAloneWillDoInAnyUnit) {
  const auto frames = frames_of(*open(section(", depth_scale: 10, max_depth: 7200, first: 2")));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].depth(0, 0), 7100);
  EXPECT_EQ(frames[0].depth(20, 0), 0);
}

TEST_F(ImageFolderFiles, AWrongScaleIsDoubted) {
  for (int i = 9; i < 12; ++i) write_depth(file(fmt::format("depth/d{}.png", i)), slope(20000));
  EXPECT_THAT(open(section(""))->warnings(), ElementsAre(HasSubstr("0.2 (5000 units a metre")));
}

TEST_F(ImageFolderFiles, WhatIsMissingIsNamed) {
  EXPECT_THAT(error_of(section(", color: colour/*.png")), HasSubstr("no colour like colour/*.png for"));
  std::filesystem::remove(file("color/00010.png"));
  EXPECT_THAT(error_of(section(", color: color/*.png")),
              AllOf(HasSubstr("no colour like color/*.png"), HasSubstr("d10.png")));
  std::string empty = section("");
  empty.replace(empty.find("depth/d*"), 8, "depth/e*");
  EXPECT_THAT(error_of(empty), HasSubstr("depth/e*.png: no frame"));
}

TEST_F(ImageFolderFiles, NamesThatDifferInZerosOnlyAreAnError) {
  write_depth(file("depth/d010.png"), slope(700));
  EXPECT_THAT(error_of(section("")), AllOf(HasSubstr("d10.png"), HasSubstr("in zeros only")));
}

TEST_F(ImageFolderFiles, OtherSizesAreErrors) {
  write_depth(file("depth/d11.png"), DepthImage(width, height + 2, 800));
  EXPECT_THAT(error_of(section("")), AllOf(HasSubstr("d11.png: 40x32"), HasSubstr("d9.png has 40x30")));
}

TEST_F(ImageFolderFiles, AFrameThatSeesNothingIsOneAndAWarningTells) {
  write_depth(file("depth/d10.png"), DepthImage(width, height, 0));
  write_mask(file("9_mask.png"), MaskImage(width, height, 0));
  const auto stream = open(section(", mask: '*_mask.png', max_depth: 745"));
  EXPECT_EQ(frames_of(*stream).size(), 3U);
  EXPECT_THAT(stream->warnings(),
              ElementsAre(HasSubstr("2 of 3 frames have no mask"),
                          AllOf(HasSubstr("2 of 3 frames see nothing"), HasSubstr("d9.png"))));
  EXPECT_THAT(test::data_error_of([&] { test::load(*test::data_of(section(", first: 2")), 0); }),
              HasSubstr("the source sees nothing"))
      << "a pair of it is an error";
}

TEST_F(ImageFolderFiles, PatternsAndCameraAreChecked) {
  for (const char* pattern : {"depth.png", "*/d.png", "d*_*.png"})
    EXPECT_THAT(test::config_error_of(section(fmt::format(", mask: '{}'", pattern))),
                AllOf(HasSubstr("'mask'"), HasSubstr("expected one *")));
  EXPECT_THAT(test::config_error_of("{type: folder, folder: '" + file("") + "'}"),
              HasSubstr("the camera is missing"));
}

TEST_F(ImageFolderFiles, RealOnesAreRead) {
  const std::string pipe = test::real_data("bent_pipe");
  if (pipe.empty()) GTEST_SKIP() << "bent_pipe is not below PLIANT_DATA";
  const auto stream = open(fmt::format(
      "{{type: folder, folder: '{}', color: color/*.jpg, fx: 525, fy: 525, cx: 320, cy: 240, step: 40}}",
      pipe));
  EXPECT_EQ(frames_of(*stream).size(), 2U);
  EXPECT_THAT(stream->warnings(), IsEmpty());
  const std::string room = test::real_data("icl_livingroom60");
  if (room.empty()) GTEST_SKIP() << "icl_livingroom60 is not below PLIANT_DATA";
  EXPECT_EQ(frames_of(*open(fmt::format("{{type: folder, folder: '{0}', color: color/*.jpg, intrinsics: "
                                        "'{0}/intrinsics.txt', first: 2, step: 20}}",
                                        room)))
                .size(),
            3U);
}

}  // namespace
}  // namespace pliant
