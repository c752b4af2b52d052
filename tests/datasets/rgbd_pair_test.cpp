#include "experiments/datasets/rgbd_pair.h"

#include <gmock/gmock.h>

#include <cmath>

#include "framework/io/images.h"
#include "framework/io/scene_flow.h"
#include "tests/datasets/data_of.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kWidth = 40;
constexpr int kHeight = 30;

/// Two good frames of 40x30 pixels in a folder; every test spoils one file.
class RgbdPairFiles : public test::TestFiles {
 protected:
  RgbdPairFiles() {
    write_depth(file("a.png"), DepthImage(kWidth, kHeight, 800));
    write_depth(file("b.png"), DepthImage(kWidth, kHeight, 810));
    write_color(file("a_color.png"), ColorImage(kWidth, kHeight, {10, 20, 30}));
    write_color(file("b_color.png"), ColorImage(kWidth, kHeight, {40, 50, 60}));
    write_mask(file("a_mask.png"), MaskImage(kWidth, kHeight, 1));
    write("k.txt", "50 0 19.5\n0 50 14.5\n0 0 1\n");
    write_scene_flow(file("truth.sflow"), Image<Eigen::Vector3f>(kWidth, kHeight, Eigen::Vector3f(0, 0, 10)));
    settings_.source = {file("a.png"), file("a_color.png"), file("a_mask.png")};
    settings_.target = {file("b.png"), file("b_color.png"), ""};
    settings_.intrinsics = file("k.txt");
    settings_.scene_flow = file("truth.sflow");
  }

  test::LoadedPair load() const { return test::load(RgbdPair(settings_), 0); }
  std::string error() const {
    return data_error_of([&] { load(); });
  }

  RgbdPair::Settings settings_;
};

TEST_F(RgbdPairFiles, AreReadAsTheyAre) {
  const test::LoadedPair pair = load();
  EXPECT_EQ(pair.name, "a to b");
  EXPECT_EQ(pair.source.depth(3, 4), 800);
  EXPECT_EQ(pair.target.depth(3, 4), 810);
  EXPECT_EQ(pair.source.color(0, 0), (Rgb{10, 20, 30}));
  EXPECT_EQ(pair.source.mask(39, 29), 1);
  EXPECT_TRUE(pair.target.mask.empty());
  EXPECT_EQ(pair.camera.fx, 50);
  EXPECT_EQ(pair.camera.width, kWidth);
  EXPECT_TRUE(pair.motion(20, 10).isApprox(Eigen::Vector3f(0, 0, 10), 1e-6f));
}

TEST_F(RgbdPairFiles, DescribeTheSameInAnExperimentFile) {
  DepthImage depth(kWidth, kHeight, 810);
  depth(5, 6) = 816;
  write_depth(file("b.png"), depth);
  const test::LoadedPair pair =
      test::load(*test::data_of("{type: rgbd_pair, source: {depth: " + file("a.png") + "}, target: {depth: " +
                                file("b.png") + "}, intrinsics: " + file("k.txt") + ", max_depth: 815}"),
                 0);
  EXPECT_EQ(pair.source.depth(3, 4), 800);
  EXPECT_EQ(pair.target.depth(3, 4), 810);
  EXPECT_EQ(pair.target.depth(5, 6), 0) << "farther than max_depth";
  EXPECT_TRUE(pair.source.color.empty());
  EXPECT_FALSE(pair.truth);
}

DepthImage ramp(float from, float step) {
  DepthImage depth(kWidth, kHeight);
  for (std::size_t i = 0; i < depth.size(); ++i) depth.data()[i] = from + step * static_cast<float>(i % 50);
  return depth;
}

TEST_F(RgbdPairFiles, GoodOnesCauseNoDoubt) {
  write_depth(file("b.png"), ramp(700, 1));
  EXPECT_THAT(load().warnings, IsEmpty());
}

TEST_F(RgbdPairFiles, DepthMayBeInAnotherUnit) {
  write_depth(file("a.png"), ramp(4000, 1));
  write_depth(file("b.png"), ramp(4000, 1));
  settings_.depth_scale = 0.2;
  const test::LoadedPair pair = load();
  EXPECT_EQ(pair.source.depth(0, 0), 800);
  EXPECT_FLOAT_EQ(pair.target.depth(1, 0), 800.2F);
  EXPECT_THAT(pair.warnings, IsEmpty());
}

TEST_F(RgbdPairFiles, DepthThatIsPlausiblyInAnotherUnitIsDoubted) {
  const auto warning_for = [&](const DepthImage& depth, double scale = 1) {
    write_depth(file("b.png"), depth);
    write_depth(file("a.png"), depth);
    settings_.depth_scale = scale;
    const auto warnings = load().warnings;
    EXPECT_EQ(warnings.size(), 2U);
    EXPECT_THAT(warnings.front(), HasSubstr(file("a.png")));
    return warnings.back();
  };
  EXPECT_THAT(warning_for(ramp(1, 0)),
              AllOf(HasSubstr("b.png: the median depth is 1 mm"), HasSubstr("1000 (metres)")));
  EXPECT_THAT(warning_for(ramp(60, 0.1F)), HasSubstr("10 (centimetres)"));
  EXPECT_THAT(warning_for(ramp(12000, 7)), HasSubstr("0.2 (5000 units a metre"));
  EXPECT_THAT(warning_for(ramp(60000, 1)), HasSubstr("0.1 (tenths of a millimetre)"));
  EXPECT_THAT(warning_for(ramp(800, 1), 1000), AllOf(HasSubstr("now 1000"), HasSubstr("1 (millimetres)")));
  EXPECT_THAT(warning_for(ramp(4000, 5)), HasSubstr("multiples of 5"));
}

TEST_F(RgbdPairFiles, SparseDepthIsDoubted) {
  const auto warnings_for = [&](int step) {
    DepthImage depth(kWidth, kHeight, 0);
    for (int v = 0; v < kHeight; v += step)
      for (int u = 0; u < kWidth; u += step) depth(u, v) = 800;
    write_depth(file("b.png"), depth);
    return load().warnings;
  };
  EXPECT_THAT(warnings_for(2), IsEmpty());
  EXPECT_THAT(warnings_for(3),
              ElementsAre(AllOf(HasSubstr("b.png: the depth is sparse"), HasSubstr("100%"))));
  EXPECT_THAT(warnings_for(9), ElementsAre(HasSubstr("no normals")));
}

TEST_F(RgbdPairFiles, IntrinsicsOfCutImagesAreDoubted) {
  write("k.txt", "50 0 4.5\n0 50 14.5\n0 0 1\n");
  EXPECT_THAT(load().warnings, ElementsAre(HasSubstr("k.txt:1: the principal point")));
}

TEST_F(RgbdPairFiles, AMissingFileIsNamed) {
  for (std::string* path :
       {&settings_.source.depth, &settings_.source.color, &settings_.source.mask, &settings_.target.depth,
        &settings_.target.color, &settings_.intrinsics, &settings_.scene_flow}) {
    const std::string good = *path;
    *path = file("none");
    EXPECT_THAT(error(), AllOf(HasSubstr(file("none")), HasSubstr("no such file")));
    *path = good;
  }
}

TEST_F(RgbdPairFiles, ATruncatedFileIsNamed) {
  for (std::string* path : {&settings_.source.depth, &settings_.source.color, &settings_.source.mask,
                            &settings_.target.depth, &settings_.target.color, &settings_.scene_flow}) {
    const std::string good = *path;
    *path = cut(good, read_file(good).size() / 2);
    EXPECT_THAT(error(), HasSubstr(*path));
    *path = good;
  }
}

TEST_F(RgbdPairFiles, DepthOfEightBitsIsAnError) {
  settings_.target.depth = settings_.source.mask;
  EXPECT_THAT(error(), AllOf(HasSubstr("a_mask.png"), HasSubstr("expected a 16-bit")));
}

TEST_F(RgbdPairFiles, DifferentSizesAreErrors) {
  const DepthImage larger(kWidth + 1, kHeight, 800);
  write_depth(file("b.png"), larger);
  settings_.target.color = "";
  EXPECT_THAT(error(), AllOf(HasSubstr("b.png"), HasSubstr("41x30"), HasSubstr("40x30")));
  write_depth(file("b.png"), DepthImage(kWidth, kHeight, 810));
  write_color(file("a_color.png"), ColorImage(kWidth, kHeight - 1, {1, 2, 3}));
  EXPECT_THAT(error(), AllOf(HasSubstr("a_color.png"), HasSubstr("40x29")));
  write_color(file("a_color.png"), ColorImage(kWidth, kHeight, {1, 2, 3}));
  write_mask(file("a_mask.png"), MaskImage(kWidth - 3, kHeight, 1));
  EXPECT_THAT(error(), AllOf(HasSubstr("a_mask.png"), HasSubstr("37x30")));
  write_mask(file("a_mask.png"), MaskImage(kWidth, kHeight, 1));
  write_scene_flow(file("truth.sflow"), Image<Eigen::Vector3f>(2, 2, Eigen::Vector3f::Zero()));
  EXPECT_THAT(error(), AllOf(HasSubstr("truth.sflow"), HasSubstr("2x2")));
}

TEST_F(RgbdPairFiles, IntrinsicsOfAnotherSizeAreAnError) {
  write("k.txt", "525 0 319.5\n0 525 239.5\n0 0 1\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("k.txt"), HasSubstr("40x30")));
}

TEST_F(RgbdPairFiles, AnEmptyMaskIsAnError) {
  write_mask(file("a_mask.png"), MaskImage(kWidth, kHeight, 0));
  EXPECT_THAT(error(), AllOf(HasSubstr("a_mask.png"), HasSubstr("the mask is empty")));
}

TEST_F(RgbdPairFiles, NoValidDepthIsAnError) {
  write_depth(file("b.png"), DepthImage(kWidth, kHeight, 0));
  EXPECT_THAT(error(), AllOf(HasSubstr("b.png"), HasSubstr("no valid depth")));
  write_depth(file("b.png"), DepthImage(kWidth, kHeight, 810));
  settings_.max_depth = 700;
  EXPECT_THAT(error(), AllOf(HasSubstr("a.png"), HasSubstr("no valid depth up to 700 mm")));
}

TEST_F(RgbdPairFiles, NoValidDepthInsideTheMaskIsAnError) {
  DepthImage depth(kWidth, kHeight, 800);
  depth(7, 8) = 0;
  write_depth(file("a.png"), depth);
  MaskImage mask(kWidth, kHeight, 0);
  mask(7, 8) = 1;
  write_mask(file("a_mask.png"), mask);
  EXPECT_THAT(error(), AllOf(HasSubstr("a.png"), HasSubstr("inside the mask")));
}

TEST_F(RgbdPairFiles, NaNInTheTruthIsAnError) {
  auto bytes = read_file(file("truth.sflow"));
  for (std::size_t i = bytes.size() - 4; i < bytes.size(); ++i) bytes[i] = 0xff;
  write("truth.sflow", bytes);
  EXPECT_THAT(error(), AllOf(HasSubstr("truth.sflow"), HasSubstr("NaN in ground truth at pixel (39, 29)")));
}

TEST_F(RgbdPairFiles, ATruthThatKnowsNothingOfTheSourceIsAnError) {
  write_scene_flow(file("truth.sflow"),
                   Image<Eigen::Vector3f>(kWidth, kHeight, Eigen::Vector3f::Constant(std::nanf(""))));
  EXPECT_THAT(error(), AllOf(HasSubstr("truth.sflow"), HasSubstr("no ground truth on any point")));
}

/// The same two frames, their colour by a camera of twice the size that is 50 mm to the right: what is at the
/// column u of the depth, 800 mm away, is at 2 u - 6.25 of the colour, as its columns tell.
class RgbdPairWithColorCamera : public RgbdPairFiles {
 protected:
  RgbdPairWithColorCamera() {
    ColorImage color(2 * kWidth, 2 * kHeight);
    for (int v = 0; v < color.height(); ++v)
      for (int u = 0; u < color.width(); ++u)
        color(u, v) = {static_cast<std::uint8_t>(u + 100), static_cast<std::uint8_t>(v + 100), 0};
    write_color(file("a_color.png"), color);
    write_color(file("b_color.png"), color);
    write("color_k.txt", "100 0 39\n0 100 29\n0 0 1\n");
    settings_.color_intrinsics = file("color_k.txt");
    settings_.color_from_depth.translation().x() = -50;
  }

  std::string section(const std::string& rest) const {
    return "{type: rgbd_pair, source: {depth: " + file("a.png") + ", color: " + file("a_color.png") +
           "}, target: {depth: " + file("b.png") + "}, intrinsics: " + file("k.txt") + rest + "}";
  }
  std::string color_intrinsics() const { return ", color_intrinsics: " + file("color_k.txt"); }
};

TEST_F(RgbdPairWithColorCamera, CarriesColourToTheDepth) {
  const test::LoadedPair pair = load();
  EXPECT_EQ(pair.source.color.width(), kWidth);
  EXPECT_EQ(pair.target.color.height(), kHeight);
  for (const int u : {4, 20, 39})
    EXPECT_EQ(pair.source.color(u, 7), (Rgb{static_cast<std::uint8_t>(2 * u - 6 + 100), 114, 0})) << u;
  EXPECT_EQ(pair.source.color(2, 7), Rgb{}) << "left of what the colour camera sees";
  EXPECT_THAT(pair.warnings, IsEmpty());
}

TEST_F(RgbdPairWithColorCamera, GivesTheStreamAsItWasSeen) {
  const auto stream = RgbdPair(settings_).open(test::shared_device(), 0);
  EXPECT_EQ(stream->rig().depth.width, kWidth);
  EXPECT_EQ(stream->rig().color.value().width, 2 * kWidth);
  EXPECT_EQ(stream->rig().color_from_depth.translation(), Eigen::Vector3d(-50, 0, 0));
  CheckedStream frames(*stream);
  EXPECT_EQ(frames.next().value().color.width(), 2 * kWidth);
}

TEST_F(RgbdPairWithColorCamera, IsReadFromAnExperimentFile) {
  const auto pair = test::load(
      *test::data_of(section(color_intrinsics() +
                             ", color_from_depth: [1, 0, 0, -50, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]")),
      0);
  EXPECT_EQ(pair.source.color.pixels(), load().source.color.pixels());
  EXPECT_TRUE(pair.target.color.empty());
}

TEST_F(RgbdPairWithColorCamera, ItsDescriptionIsWholeAndRigid) {
  const std::string unmoved = ", color_from_depth: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]";
  EXPECT_THAT(test::config_error_of(section(color_intrinsics())), HasSubstr("'color_from_depth' is missing"));
  EXPECT_THAT(test::config_error_of(section(unmoved)), HasSubstr("'color_intrinsics' is missing"));
  // Column by column, scaled, mirrored.
  for (const std::string numbers :
       {"1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -50, 0, 0, 1", "2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1",
        "-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1"})
    EXPECT_THAT(test::config_error_of(section(color_intrinsics() + ", color_from_depth: [" + numbers + "]")),
                AllOf(HasSubstr(".yaml:1:"), HasSubstr("'color_from_depth' is no rigid motion")));
  EXPECT_THAT(test::config_error_of(section(color_intrinsics() + ", color_from_depth: [1, 0, 0]")),
              HasSubstr("has 3 items"));
  std::string colorless = section(color_intrinsics() + unmoved);
  const std::string color = ", color: " + file("a_color.png");
  colorless.erase(colorless.find(color), color.size());
  EXPECT_THAT(test::config_error_of(colorless), HasSubstr("without a 'color'"));
}

TEST_F(RgbdPairWithColorCamera, ADistanceInMetresIsDoubted) {
  settings_.color_from_depth.translation().x() = -0.05;
  EXPECT_THAT(load().warnings, ElementsAre(HasSubstr("0.05 mm apart; if it counts in metres, write 50 mm")));
}

TEST_F(RgbdPairWithColorCamera, ColourOfDifferentSizesIsAnError) {
  write_color(file("b_color.png"), ColorImage(2 * kWidth, kHeight));
  EXPECT_THAT(error(), AllOf(HasSubstr("b_color.png: 80x30 pixels"), HasSubstr("a_color.png has 80x60")));
}

TEST_F(RgbdPairWithColorCamera, IntrinsicsOfAnotherSizeAreAnErrorThere) {
  write("color_k.txt", "525 0 319.5\n0 525 239.5\n0 0 1\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("color_k.txt"), HasSubstr("80x60")));
}

}  // namespace
}  // namespace pliant
