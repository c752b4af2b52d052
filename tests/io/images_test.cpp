#include "framework/io/images.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class Images : public test::TestFiles {
 protected:
  /// A PNG that OpenCV wrote, so that our reader is not tested against our writer alone.
  std::string write_png(const std::string& name, const cv::Mat& image) const {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", image, bytes);
    return write(name, bytes);
  }
};

DepthImage depth_ramp(int width, int height) {
  DepthImage depth(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) depth(u, v) = static_cast<float>((u * 131 + v * 977) % 65536);
  }
  return depth;
}

ColorImage colors(int width, int height) {
  ColorImage image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      image(u, v) = {static_cast<std::uint8_t>(u * 7), static_cast<std::uint8_t>(v * 5),
                     static_cast<std::uint8_t>(u * v)};
    }
  }
  return image;
}

TEST_F(Images, DepthIsTheMillimetresOfThePng) {
  cv::Mat image = cv::Mat::zeros(2, 3, CV_16U);
  image.at<std::uint16_t>(0, 2) = 65535;
  image.at<std::uint16_t>(1, 0) = 258;  // not the same with its bytes swapped
  const DepthImage depth = read_depth(write_png("depth.png", image));
  ASSERT_EQ(depth.width(), 3);
  ASSERT_EQ(depth.height(), 2);
  EXPECT_EQ(depth.pixels(), (std::vector<float>{0, 0, 65535, 258, 0, 0}));
}

TEST_F(Images, DepthSurvivesARoundTrip) {
  const DepthImage depth = depth_ramp(67, 41);
  write_depth(file("depth.png"), depth);
  EXPECT_EQ(read_depth(file("depth.png")).pixels(), depth.pixels());
}

TEST_F(Images, DepthIsWrittenRoundedAndZeroWhereThereIsNone) {
  DepthImage depth(6, 1);
  depth(0, 0) = 799.5f;
  depth(1, 0) = 800.4f;
  depth(2, 0) = -3;
  depth(3, 0) = std::nanf("");
  depth(4, 0) = std::numeric_limits<float>::infinity();
  write_depth(file("depth.png"), depth);
  EXPECT_EQ(read_depth(file("depth.png")).pixels(), (std::vector<float>{800, 800, 0, 0, 0, 0}));
}

TEST_F(Images, DepthBeyondSixteenBitsIsNotWritten) {
  EXPECT_THAT(data_error_of([&] { write_depth(file("far.png"), DepthImage(1, 1, 65536)); }),
              AllOf(HasSubstr("far.png"), HasSubstr("16 bits")));
}

TEST_F(Images, EightBitDepthIsAnError) {
  const auto path = write_png("eight.png", cv::Mat::ones(4, 4, CV_8U));
  EXPECT_THAT(data_error_of([&] { read_depth(path); }),
              AllOf(HasSubstr("eight.png: 8-bit single-channel PNG"), HasSubstr("expected a 16-bit")));
}

TEST_F(Images, ColouredDepthIsAnError) {
  const auto path = write_png("rgb.png", cv::Mat::ones(4, 4, CV_16UC3));
  EXPECT_THAT(data_error_of([&] { read_depth(path); }), HasSubstr("rgb.png: 16-bit RGB PNG"));
}

TEST_F(Images, MissingIsAnError) {
  EXPECT_THAT(data_error_of([&] { read_depth(file("no.png")); }), HasSubstr("no.png: no such file"));
  EXPECT_THAT(data_error_of([&] { read_color(file("no.jpg")); }), HasSubstr("no.jpg: no such file"));
  EXPECT_THAT(data_error_of([&] { read_mask(file("no.png")); }), HasSubstr("no.png: no such file"));
}

TEST_F(Images, AnotherFormatIsAnError) {
  const auto path = write("text.png", std::string("P5 2 2 255 abcd"));
  EXPECT_THAT(data_error_of([&] { read_depth(path); }), HasSubstr("text.png: not a PNG file"));
  EXPECT_THAT(data_error_of([&] { read_mask(path); }), HasSubstr("text.png: not a PNG file"));
  EXPECT_THAT(data_error_of([&] { read_color(path); }), HasSubstr("text.png: neither a PNG nor a JPEG"));
  const auto empty = write("empty.png", std::string());
  EXPECT_THAT(data_error_of([&] { read_depth(empty); }), HasSubstr("empty.png: not a PNG file"));
}

// Decoders accept some of these silently and complain about others on stderr, where no one is told to look.
TEST_F(Images, PngCutAnywhereIsAnErrorAndNothingIsPrinted) {
  write_depth(file("depth.png"), depth_ramp(64, 48));
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(file("depth.png")));
  ::testing::internal::CaptureStderr();
  for (std::size_t length = 8; length < size; length += length + 40 < size ? 37 : 1) {
    const auto path = cut(file("depth.png"), length);
    EXPECT_THAT(data_error_of([&] { read_depth(path); }), ContainsRegex("cut[0-9]+.png: truncated PNG"));
    std::filesystem::remove(path);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Images, ChangedPngIsAnErrorAndNothingIsPrinted) {
  write_depth(file("depth.png"), depth_ramp(64, 48));
  const auto good = read_file(file("depth.png"));
  ::testing::internal::CaptureStderr();
  for (std::size_t at = 8; at < good.size(); at += 11) {
    auto bytes = good;
    bytes[at] ^= 0x10;
    const auto path = write("changed.png", bytes);
    EXPECT_THAT(data_error_of([&] { read_depth(path); }), HasSubstr("changed.png: "));
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Images, ColorSurvivesARoundTrip) {
  const ColorImage color = colors(33, 20);
  write_color(file("color.png"), color);
  const ColorImage read = read_color(file("color.png"));
  EXPECT_EQ(read.width(), 33);
  EXPECT_EQ(read.pixels(), color.pixels());
}

TEST_F(Images, ColorOrderIsRedGreenBlue) {
  const auto path = write_png("red.png", cv::Mat(1, 1, CV_8UC3, cv::Scalar(1, 2, 250)));
  EXPECT_EQ(read_color(path)(0, 0), (Rgb{250, 2, 1}));
}

TEST_F(Images, JpegIsRead) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", cv::Mat(40, 56, CV_8UC3, cv::Scalar(20, 40, 200)), bytes);
  const ColorImage color = read_color(write("color.jpg", bytes));
  EXPECT_EQ(color.width(), 56);
  EXPECT_EQ(color.height(), 40);
  EXPECT_NEAR(color(30, 20).r, 200, 4);
  EXPECT_NEAR(color(30, 20).b, 20, 4);
}

TEST_F(Images, JpegCutAnywhereIsAnErrorAndNothingIsPrinted) {
  cv::Mat noise(48, 64, CV_8UC3);
  cv::theRNG().state = 7;
  cv::randu(noise, 0, 255);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", noise, bytes);
  const auto whole = write("whole.jpg", bytes);
  ::testing::internal::CaptureStderr();
  for (std::size_t length = 3; length < bytes.size(); length += length + 40 < bytes.size() ? 41 : 1) {
    const auto path = cut(whole, length);
    EXPECT_THAT(data_error_of([&] { read_color(path); }), ContainsRegex("cut[0-9]+.jpg: "));
    std::filesystem::remove(path);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(Images, MaskIsNonZeroInEightAndSixteenBits) {
  cv::Mat eight = cv::Mat::zeros(1, 3, CV_8U);
  eight.at<std::uint8_t>(0, 1) = 1;
  cv::Mat sixteen = cv::Mat::zeros(1, 3, CV_16U);
  sixteen.at<std::uint16_t>(0, 1) = 256;  // its low byte alone is zero
  const std::vector<std::uint8_t> expected = {0, 1, 0};
  EXPECT_EQ(read_mask(write_png("eight.png", eight)).pixels(), expected);
  EXPECT_EQ(read_mask(write_png("sixteen.png", sixteen)).pixels(), expected);
}

TEST_F(Images, MaskMayBeColoured) {
  const std::vector<std::uint8_t> expected = {0, 1, 1};
  cv::Mat bgr = cv::Mat::zeros(1, 3, CV_8UC3);
  bgr.at<cv::Vec3b>(0, 1) = {0, 0, 1};
  bgr.at<cv::Vec3b>(0, 2) = {255, 255, 255};
  EXPECT_EQ(read_mask(write_png("rgb.png", bgr)).pixels(), expected);
  cv::Mat deep;
  bgr.convertTo(deep, CV_16U, 256);  // the low bytes alone are zero
  EXPECT_EQ(read_mask(write_png("rgb16.png", deep)).pixels(), expected);
}

TEST_F(Images, MaskIsNothingWhereItIsTransparent) {
  cv::Mat bgra(1, 4, CV_8UC4, cv::Scalar(0, 0, 0, 0));
  bgra.at<cv::Vec4b>(0, 1) = {0, 0, 0, 255};
  bgra.at<cv::Vec4b>(0, 2) = {255, 255, 255, 0};
  bgra.at<cv::Vec4b>(0, 3) = {255, 255, 255, 1};
  EXPECT_EQ(read_mask(write_png("rgba.png", bgra)).pixels(), (std::vector<std::uint8_t>{0, 0, 0, 1}));
}

TEST_F(Images, MaskMayHaveAPalette) {
  // 2x1 pixels of colours 1 and 0 of the palette black, red.
  const std::vector<std::uint8_t> bytes = {
      0x89, 'P',  'N',  'G',  '\r', '\n', 0x1a, '\n',  //
      0,    0,    0,    13,   'I',  'H',  'D',  'R',  0,    0,    0,    2,    0,
      0,    0,    1,    8,    3,    0,    0,    0,    0xc3, 0xfc, 0x8f, 0xb8,  //
      0,    0,    0,    6,    'P',  'L',  'T',  'E',  0,    0,    0,    255,  0,
      0,    0x1b, 0xff, 0x8d, 0x22,  //
      0,    0,    0,    11,   73,   68,   65,   84,   120,  156,  99,   96,   100,
      0,    0,    0,    5,    0,    2,    0xd1, 0x66, 0x33, 0x78,  //
      0,    0,    0,    0,    'I',  'E',  'N',  'D',  0xae, 0x42, 0x60, 0x82};
  EXPECT_EQ(read_mask(write("palette.png", bytes)).pixels(), (std::vector<std::uint8_t>{1, 0}));
}

TEST_F(Images, MaskSurvivesARoundTrip) {
  MaskImage mask(5, 2);
  mask(3, 1) = 1;
  mask(0, 0) = 200;
  write_mask(file("mask.png"), mask);
  EXPECT_EQ(read_mask(file("mask.png")).pixels(), (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0, 1, 0}));
}

TEST_F(Images, WritingFailsWithAReason) {
  EXPECT_THAT(data_error_of([&] { write_depth(file("no/a.png"), DepthImage(2, 2, 1)); }),
              HasSubstr("no/a.png"));
  EXPECT_THAT(data_error_of([&] { write_color(file("no/a.png"), ColorImage(2, 2)); }), HasSubstr("no/a.png"));
  EXPECT_THAT(data_error_of([&] { write_mask(file("no/a.png"), MaskImage(2, 2)); }), HasSubstr("no/a.png"));
  EXPECT_THAT(data_error_of([&] { write_mask(file("a.png"), MaskImage()); }), HasSubstr("empty image"));
}

}  // namespace
}  // namespace pliant
