#include "experiments/report/heat_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgcodecs.hpp>

namespace pliant {
namespace {

constexpr ColorScale scale{ColorScale::Map::error, 0, 10};

cv::Mat decode(const std::vector<std::uint8_t>& png) { return cv::imdecode(png, cv::IMREAD_COLOR); }

/// The colour in the middle of a picture all of one value; small ones are enlarged around (300, 300).
cv::Vec3b color_of(float value) {
  return decode(draw_heat_map(Image<float>(640, 480, value), scale, "", "")).at<cv::Vec3b>(300, 300);
}

int brightness(const cv::Vec3b& color) { return color[0] + color[1] + color[2]; }

TEST(HeatMap, IsThePictureAndAMargin) {
  const cv::Mat picture = decode(draw_heat_map(Image<float>(640, 480, 1), scale, "title", "subtitle"));
  EXPECT_GT(picture.cols, 640);
  EXPECT_LT(picture.cols, 800);
  EXPECT_GT(picture.rows, 480);
  EXPECT_LT(picture.rows, 600);
}

TEST(HeatMap, EnlargesSmallImagesSoThatTextFits) {
  EXPECT_GE(decode(draw_heat_map(Image<float>(40, 30, 1), scale, "", "")).cols, 480);
}

TEST(HeatMap, BrighterMeansMore) {
  EXPECT_LT(brightness(color_of(0)), brightness(color_of(3)));
  EXPECT_LT(brightness(color_of(3)), brightness(color_of(7)));
  EXPECT_LT(brightness(color_of(7)), brightness(color_of(10)));
}

TEST(HeatMap, ShowsWhatLiesBeyondInTheColorOfTheEnd) {
  EXPECT_EQ(color_of(10), color_of(1e9f));
  EXPECT_EQ(color_of(0), color_of(-5));
}

TEST(HeatMap, NothingHasAColorOfItsOwn) {
  const cv::Vec3b nothing = color_of(std::numeric_limits<float>::quiet_NaN());
  for (float value = 0; value <= 10; value += 0.1f) EXPECT_NE(color_of(value), nothing);
}

TEST(HeatMap, WritesTheTitle) {
  const Image<float> values(640, 480, 1);
  EXPECT_NE(draw_heat_map(values, scale, "one", ""), draw_heat_map(values, scale, "two", ""));
  EXPECT_NE(draw_heat_map(values, scale, "", "mean 1"), draw_heat_map(values, scale, "", "mean 2"));
}

TEST(RoundUp, GivesRoundNumbers) {
  EXPECT_DOUBLE_EQ(round_up(0.1), 0.1);
  EXPECT_DOUBLE_EQ(round_up(0.11), 0.15);
  EXPECT_DOUBLE_EQ(round_up(17), 20);
  EXPECT_DOUBLE_EQ(round_up(810), 1000);
  EXPECT_DOUBLE_EQ(round_up(1000), 1000);
}

}  // namespace
}  // namespace pliant
