#include "framework/io/intrinsics.h"

#include <gmock/gmock.h>

#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class IntrinsicsTest : public test::TestFiles {
 protected:
  std::string error_of(const std::string& text, int width = 640, int height = 480) const {
    const auto path = write("k.txt", text);
    const auto error = data_error_of([&] { read_intrinsics(path, width, height); });
    EXPECT_THAT(error, HasSubstr(path));
    return error;
  }

  std::vector<std::string> warnings_of(const std::string& text, int width = 640, int height = 480) const {
    return read_intrinsics(write("k.txt", text), width, height).warnings;
  }
};

TEST_F(IntrinsicsTest, ReadsThreeByThree) {
  const auto path = write("k.txt", std::string("525 0 319.5\n0 5.26e+02 239.5\r\n0 0 1\n"));
  const Camera camera = read_intrinsics(path, 640, 480).camera;
  EXPECT_EQ(camera.fx, 525);
  EXPECT_EQ(camera.fy, 526);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
}

TEST_F(IntrinsicsTest, ReadsFourByFour) {
  const auto path = write("k.txt", std::string("525 0 319.5 0  0 526 239.5 0  0 0 1 0  0 0 0 1"));
  const Camera camera = read_intrinsics(path, 640, 480).camera;
  EXPECT_EQ(camera.fy, 526);
  EXPECT_EQ(camera.cy, 239.5);
}

TEST_F(IntrinsicsTest, WrongCountIsAnError) {
  EXPECT_THAT(error_of("525 0 319.5 0 525 239.5"), AllOf(HasSubstr("6 numbers"), HasSubstr("9 or 16")));
  EXPECT_THAT(error_of(""), HasSubstr("0 numbers"));
}

TEST_F(IntrinsicsTest, WordsAndNonFiniteNumbersAreErrors) {
  EXPECT_THAT(error_of("fx 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'fx' is not a number"));
  EXPECT_THAT(error_of("525, 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'525,' is not a number"));
  EXPECT_THAT(error_of("nan 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(error_of("1e999 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'1e999' is not a number"));
}

TEST_F(IntrinsicsTest, FocalLengthMustBePositive) {
  EXPECT_THAT(error_of("0 0 319.5 0 525 239.5 0 0 1"), HasSubstr("focal length"));
  EXPECT_THAT(error_of("525 0 319.5 0 -525 239.5 0 0 1"), HasSubstr("focal length"));
}

TEST_F(IntrinsicsTest, WhatIsNotAPinholeCameraIsAnError) {
  EXPECT_THAT(error_of("525 3 319.5 0 525 239.5 0 0 1"), HasSubstr("3 in row 1, column 2"));
  EXPECT_THAT(error_of("525 0 0 0 525 0 319.5 239.5 1"), HasSubstr("row 3, column 1"));
  EXPECT_THAT(error_of("525 0 319.5 9 0 525 239.5 0 0 0 1 0 0 0 0 1"), HasSubstr("9 in row 1, column 4"));
}

TEST_F(IntrinsicsTest, IntrinsicsOfAnotherImageSizeAreAnError) {
  const std::string k = "525 0 319.5 0 525 239.5 0 0 1";
  EXPECT_THAT(error_of(k, 320, 240), AllOf(HasSubstr("(319.5, 239.5)"), HasSubstr("320x240")));
  EXPECT_THAT(error_of(k, 1280, 960), HasSubstr("1280x960"));
  EXPECT_THAT(error_of("1000 0 959.5 0 1000 539.5 0 0 1"), HasSubstr("640x480"));
  EXPECT_THAT(error_of("525 0 319.5 0 525 -200 0 0 1"), HasSubstr("640x480"));
}

TEST_F(IntrinsicsTest, TheLikelySizeIsNamed) {
  EXPECT_THAT(error_of("915.2 0 639.5\n0 915.2 359.5\n0 0 1"),
              AllOf(HasSubstr("k.txt:1: "), HasSubstr("images of 1280x720 pixels")));
  EXPECT_THAT(error_of("900 0 511.5 0 900 383.5 0 0 1", 256, 192), HasSubstr("images of about 1024x768"));
}

TEST_F(IntrinsicsTest, NormalisedOnesAreAnError) {
  EXPECT_THAT(error_of("\n0.82 0 0.5\n0 1.09 0.5\n0 0 1"),
              AllOf(HasSubstr("k.txt:2: "), HasSubstr("look normalised"), HasSubstr("the width, 640")));
}

TEST_F(IntrinsicsTest, AbsurdFocalLengthsAreAnError) {
  EXPECT_THAT(error_of("0.82 0 319.5 0 1.09 239.5 0 0 1"), HasSubstr("too short"));
  EXPECT_THAT(error_of("4.2 0 319.5 0 4.2 239.5 0 0 1"), HasSubstr("not mm"));
  EXPECT_THAT(error_of("525000 0 319.5 0 525000 239.5 0 0 1"), HasSubstr("too long"));
}

TEST_F(IntrinsicsTest, SwappedOnesAreAnErrorOrAWarning) {
  EXPECT_THAT(error_of("319.5 0 525 0 239.5 525 0 0 1"), HasSubstr("look swapped"));
  EXPECT_THAT(warnings_of("525 0 239.5 0 525 319.5 0 0 1"), ElementsAre(HasSubstr("cx and cy swapped?")));
}

TEST_F(IntrinsicsTest, AByteOrderMarkIsSkipped) {
  const auto path = write("k.txt", std::string("\xEF\xBB\xBF"
                                               "525 0 319.5\n0 525 239.5\n0 0 1\n"));
  EXPECT_EQ(read_intrinsics(path, 640, 480).camera.fx, 525);
}

TEST_F(IntrinsicsTest, CutImagesKeepTheirPrincipalPointAndAWarningSaysSo) {
  const auto path = write("k.txt", std::string("525 0 119.5 0 525 239.5 0 0 1"));
  const auto cut = read_intrinsics(path, 640, 480);
  EXPECT_EQ(cut.camera.cx, 119.5);
  EXPECT_THAT(cut.warnings, ElementsAre(AllOf(HasSubstr("k.txt:1: "), HasSubstr("far from the middle"))));
  EXPECT_THAT(warnings_of("525 0 319.5 0 525 239.5 0 0 1", 640, 360),
              ElementsAre(HasSubstr("is that of images of 640x480")));
}

TEST_F(IntrinsicsTest, PixelsThatAreNotSquareAreDoubted) {
  write("k.txt", "525 0 319.5\n0 350 239.5\n0 0 1\n");
  EXPECT_THAT(read_intrinsics(file("k.txt"), 640, 480).warnings,
              ElementsAre(AllOf(HasSubstr("k.txt:1: "), HasSubstr("0.67 times as wide as high"))));
}

TEST_F(IntrinsicsTest, UsualOnesAreNotDoubted) {
  EXPECT_THAT(warnings_of("517.3 0 318.6 0 516.5 255.3 0 0 1"), IsEmpty());
  EXPECT_THAT(warnings_of("365.5 0 254.9 0 365.5 205.4 0 0 1", 512, 424), IsEmpty());
  EXPECT_THAT(warnings_of("610 0 421 0 610 239 0 0 1", 848, 480), IsEmpty());
  EXPECT_THAT(warnings_of("575 0 239.5 0 575 319.5 0 0 1", 480, 640), IsEmpty());
}

TEST_F(IntrinsicsTest, MissingIsAnError) {
  EXPECT_THAT(data_error_of([&] { read_intrinsics(file("none.txt"), 640, 480); }), HasSubstr("none.txt"));
}

}  // namespace
}  // namespace pliant
