#include "framework/io/intrinsics.h"

#include <gmock/gmock.h>

#include "tests/io/test_files.h"

namespace pliant {
namespace {

using ::testing::AllOf;
using testing::data_error_of;
using ::testing::HasSubstr;

class Intrinsics : public testing::TestFiles {
 protected:
  std::string error_of(const std::string& text, int width = 640, int height = 480) const {
    const auto path = write("k.txt", text);
    const auto error = data_error_of([&] { read_intrinsics(path, width, height); });
    EXPECT_THAT(error, HasSubstr(path));
    return error;
  }
};

TEST_F(Intrinsics, ReadsThreeByThree) {
  const auto path = write("k.txt", std::string("525 0 319.5\n0 5.26e+02 239.5\r\n0 0 1\n"));
  const Camera camera = read_intrinsics(path, 640, 480);
  EXPECT_EQ(camera.fx, 525);
  EXPECT_EQ(camera.fy, 526);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);
}

TEST_F(Intrinsics, ReadsFourByFour) {
  const auto path = write("k.txt", std::string("525 0 319.5 0  0 526 239.5 0  0 0 1 0  0 0 0 1"));
  const Camera camera = read_intrinsics(path, 640, 480);
  EXPECT_EQ(camera.fy, 526);
  EXPECT_EQ(camera.cy, 239.5);
}

TEST_F(Intrinsics, WrongCountIsAnError) {
  EXPECT_THAT(error_of("525 0 319.5 0 525 239.5"), AllOf(HasSubstr("6 numbers"), HasSubstr("9 or 16")));
  EXPECT_THAT(error_of(""), HasSubstr("0 numbers"));
}

TEST_F(Intrinsics, WordsAndNonFiniteNumbersAreErrors) {
  EXPECT_THAT(error_of("fx 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'fx' is not a number"));
  EXPECT_THAT(error_of("525, 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'525,' is not a number"));
  EXPECT_THAT(error_of("nan 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(error_of("1e999 0 319.5 0 525 239.5 0 0 1"), HasSubstr("'1e999' is not a number"));
}

TEST_F(Intrinsics, FocalLengthMustBePositive) {
  EXPECT_THAT(error_of("0 0 319.5 0 525 239.5 0 0 1"), HasSubstr("focal length"));
  EXPECT_THAT(error_of("525 0 319.5 0 -525 239.5 0 0 1"), HasSubstr("focal length"));
}

TEST_F(Intrinsics, WhatIsNotAPinholeCameraIsAnError) {
  EXPECT_THAT(error_of("525 3 319.5 0 525 239.5 0 0 1"), HasSubstr("3 in row 1, column 2"));
  EXPECT_THAT(error_of("525 0 0 0 525 0 319.5 239.5 1"), HasSubstr("row 3, column 1"));
  EXPECT_THAT(error_of("525 0 319.5 9 0 525 239.5 0 0 0 1 0 0 0 0 1"), HasSubstr("9 in row 1, column 4"));
}

TEST_F(Intrinsics, IntrinsicsOfAnotherImageSizeAreAnError) {
  const std::string k = "525 0 319.5 0 525 239.5 0 0 1";
  EXPECT_THAT(error_of(k, 320, 240), AllOf(HasSubstr("(319.5, 239.5)"), HasSubstr("320x240")));
  EXPECT_THAT(error_of(k, 1280, 960), HasSubstr("1280x960"));
  EXPECT_THAT(error_of("1000 0 959.5 0 1000 539.5 0 0 1"), HasSubstr("640x480"));
  EXPECT_THAT(error_of("525 0 319.5 0 525 -200 0 0 1"), HasSubstr("640x480"));
}

TEST_F(Intrinsics, CroppedImagesKeepTheirPrincipalPoint) {
  const auto path = write("k.txt", std::string("525 0 119.5 0 525 239.5 0 0 1"));
  EXPECT_EQ(read_intrinsics(path, 640, 480).cx, 119.5);
}

TEST_F(Intrinsics, MissingIsAnError) {
  EXPECT_THAT(data_error_of([&] { read_intrinsics(file("none.txt"), 640, 480); }), HasSubstr("none.txt"));
}

}  // namespace
}  // namespace pliant
