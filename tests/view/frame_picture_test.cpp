#include "experiments/view/frame_picture.h"

#include <gmock/gmock.h>

#include <cmath>

#include "experiments/view/model_distance.h"
#include "tests/view/sample_tracked.h"

namespace pliant::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int panel_width = 320;

/// The middles of the panels of a picture: colour, depth, model, error.
class FramePictureTest : public ::testing::Test {
 protected:
  const ColorImage& draw(const TrackedFrame& tracked) { return picture_.draw(tracked, 30); }

  /// What the panel shows of a pixel of the depth camera's image; panels are four times as large.
  static Rgb at(const ColorImage& picture, int panel, int u, int v) {
    const int left = 6 + panel % 2 * (panel_width + 6);
    const int top = 24 + panel / 2 * (240 + 24);
    return picture(left + 4 * u + 1, top + 4 * v + 1);
  }

  static bool is_blank(const ColorImage& picture, int panel) {
    for (int v = 0; v < 60; ++v)
      for (int u = 0; u < 80; ++u)
        if (!(at(picture, panel, u, v) == no_color)) return false;
    return true;
  }

  SampleTracked sample_;
  FramePicture picture_{{sample_.camera}, panel_width};
};

TEST_F(FramePictureTest, ShowsDepthAndErrorInTheirColours) {
  const ColorImage& picture = draw(sample_.tracked());
  EXPECT_EQ(picture.width(), picture_.size().width);
  const auto depth = colors_of(ColorScale::Map::depth);
  EXPECT_TRUE(std::find(depth.begin(), depth.end(), at(picture, 1, 5, 5)) != depth.end());
  const auto error = colors_of(ColorScale::Map::error);
  EXPECT_EQ(at(picture, 3, 50, 20), error[0]) << "on the model";
  EXPECT_EQ(at(picture, 3, 30, 20), error[255]) << "as far from it as most";
  EXPECT_EQ(at(picture, 3, 20, 20), no_color) << "no point";
  EXPECT_EQ(at(picture, 3, 5, 5), no_color) << "outside of the window";
}

TEST_F(FramePictureTest, ShadesTheModelAsSeenFromTheCamera) {
  const ColorImage& picture = draw(sample_.tracked());
  EXPECT_EQ(at(picture, 2, 5, 5), no_color);
  const Rgb middle = at(picture, 2, 40, 30);
  EXPECT_GT(middle.r, 215) << "seen face on";
  EXPECT_LT(at(picture, 2, 58, 12).r, middle.r - 5) << "seen from the side";
}

TEST_F(FramePictureTest, ShowsColourOfACameraOfItsOwnSize) {
  sample_.frame.color = ColorImage(160, 120, {10, 20, 30});
  for (int v = 0; v < 120; ++v)
    for (int u = 80; u < 160; ++u) sample_.frame.color(u, v) = {200, 100, 50};
  FramePicture picture({sample_.camera, Camera{140, 140, 79.5, 59.5, 160, 120}}, panel_width);
  const ColorImage& drawn = picture.draw(sample_.tracked(), 30);
  EXPECT_EQ(at(drawn, 0, 39, 30), (Rgb{10, 20, 30}));
  EXPECT_EQ(at(drawn, 0, 41, 30), (Rgb{200, 100, 50}));
}

TEST_F(FramePictureTest, WithoutColourShowsTheSurface) {
  EXPECT_GT(at(draw(sample_.tracked()), 0, 40, 30).r, 215);
}

TEST_F(FramePictureTest, BeforeThereIsAModelItsPanelsAreBlank) {
  const ColorImage& picture = draw(sample_.waiting());
  EXPECT_FALSE(is_blank(picture, 1));
  for (const int panel : {0, 2, 3}) EXPECT_TRUE(is_blank(picture, panel)) << panel;
}

TEST_F(FramePictureTest, ScalesStayAsTheyWereFitted) {
  draw(sample_.tracked());
  sample_.frame.depth = DepthImage(80, 60, 5000);
  const auto depth = colors_of(ColorScale::Map::depth);
  EXPECT_EQ(at(draw(sample_.tracked()), 1, 5, 5), depth[255]);
}

TEST_F(FramePictureTest, WithoutAnyDepthIsStillAPicture) {
  sample_.frame.depth = DepthImage(80, 60, 0);
  EXPECT_TRUE(is_blank(draw(sample_.waiting()), 1));
}

TEST_F(FramePictureTest, TheLineBelowTellsOfTheFrame) {
  const ColorImage before = draw(sample_.tracked());
  const PixelWindow line{0, before.height() - 28, before.width(), 28};
  EXPECT_GT(colors_in(before, line), 20U) << "letters";
  sample_.record.number = 8;
  EXPECT_FALSE(before.pixels() == draw(sample_.tracked()).pixels());
}

TEST(DescribeFrame, TellsOfErrorAndReason) {
  const SampleTracked sample;
  FrameRecord record = sample.record;
  EXPECT_THAT(describe(record), AllOf(HasSubstr("frame 7"), HasSubstr("tracked"), HasSubstr("1.25 mm"),
                                      HasSubstr("1234 of 1600")));
  record.state = FrameState::lost;
  record.reason = "too few matches";
  EXPECT_THAT(describe(record), AllOf(HasSubstr("lost: too few matches"), Not(HasSubstr("mm"))));
}

TEST(ErrorScale, HoldsMostOfTheErrors) {
  std::vector<float> errors(100, 2);
  errors[3] = 90;
  errors[4] = std::nanf("");
  EXPECT_FLOAT_EQ(error_scale(errors).highest, 2);
  EXPECT_FLOAT_EQ(error_scale({}).highest, 1) << "of nothing";
}

TEST(ModelDistances, AreThoseToThePlanesOfTheModel) {
  const SampleTracked sample;
  const TrackedFrame tracked = sample.tracked();
  const Image<float> distances = model_distances(*tracked.seen, *tracked.model);
  EXPECT_TRUE(std::isnan(distances(0, 5)));
  EXPECT_NEAR(distances(5, 5), 4, 1e-3) << "along the normal, not along the ray";
  EXPECT_NEAR(distances(30, 5), 0, 1e-3);
}

}  // namespace
}  // namespace pliant::test
