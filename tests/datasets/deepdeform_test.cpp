#include <gmock/gmock.h>

#include <fmt/format.h>

#include "framework/io/scene_flow.h"
#include "tests/datasets/sequence_files.h"

namespace pliant {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Frames 0, 40 and 80 of which the first has a mask of a shirt, whose motion to frame 80 is known.
class DeepDeformFolder : public test::SequenceFiles {
 protected:
  DeepDeformFolder() {
    for (const char* name : {"depth", "color", "mask", "scene_flow"}) make_folder(name);
    for (int i = 0; i < 3; ++i) {
      write_depth(file(fmt::format("depth/{:06}.png", 40 * i)), slope(static_cast<float>(801 + 100 * i)));
      write_color(file(fmt::format("color/{:06}.png", 40 * i)),
                  ColorImage(width, height, {static_cast<std::uint8_t>(i), 20, 30}));
    }
    MaskImage mask(width, height, 0);
    for (int v = 5; v < 20; ++v)
      for (int u = 5; u < 20; ++u) mask(u, v) = 1;
    write_mask(file("mask/000000_shirt.png"), mask);
    write_scene_flow(file("scene_flow/shirt_000000_000080.sflow"),
                     Image<Eigen::Vector3f>(width, height, Eigen::Vector3f(0, 0, 200)));
    write("intrinsics.txt", std::string("50 0 19.5 0\n0 50 14.5 0\n0 0 1 0\n0 0 0 1\n"));
  }

  std::string section(const std::string& rest = "") const {
    return fmt::format("{{type: deepdeform, folder: '{}'{}}}", file(""), rest);
  }
};

TEST_F(DeepDeformFolder, IsAStreamWithTheMotionThatIsKnown) {
  const auto stream = open(section());
  const auto frames = frames_of(*stream);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].depth(2, 0), 903);
  EXPECT_EQ(frames[2].color(0, 0).r, 2);
  EXPECT_EQ(frames[0].mask(6, 6), 1);
  EXPECT_TRUE(frames[1].mask.empty());
  EXPECT_NEAR(frames[2].time - frames[0].time, 80 / 30.0, 1e-9);
  EXPECT_EQ(stream->rig().depth.fx, 50);
  EXPECT_FALSE(stream->truth(2));
  EXPECT_EQ(stream->truth(3).value().scene_flow(7, 7), Eigen::Vector3f(0, 0, 200));
  EXPECT_FALSE(stream->truth(4));
  EXPECT_THAT(stream->warnings(), IsEmpty());
}

TEST_F(DeepDeformFolder, OrAPairByTheNumbersOfItsFiles) {
  const auto pair = test::load(*test::data_of(section(", source: 0, target: 80")), 0);
  EXPECT_EQ(pair.source.depth(0, 0), 801);
  EXPECT_EQ(pair.target.depth(0, 0), 1001);
  EXPECT_EQ(pair.motion(7, 7), Eigen::Vector3f(0, 0, 200));
  const auto back = test::load(*test::data_of(section(", source: 80, target: 0")), 0);
  EXPECT_EQ(back.source.depth(0, 0), 1001);
  EXPECT_FALSE(back.truth);
}

TEST_F(DeepDeformFolder, OpticalFlowAndWhatIsSeenAreReadWithTheMotion) {
  make_folder("optical_flow");
  make_folder("visible");
  write_optical_flow(file("optical_flow/shirt_000000_000080.oflow"),
                     Image<Eigen::Vector2f>(width, height, Eigen::Vector2f(3, 4)));
  MaskImage visible(width, height, 0);
  visible(7, 8) = 1;
  write_mask(file("visible/shirt_000000_000080.png"), visible);
  const PairTruth truth = open(section())->truth(3).value();
  EXPECT_EQ(truth.optical_flow(7, 7), Eigen::Vector2f(3, 4));
  EXPECT_EQ(truth.visible.pixels(), visible.pixels());
  write_optical_flow(file("optical_flow/shirt_000000_000080.oflow"),
                     Image<Eigen::Vector2f>(2, 3, Eigen::Vector2f(3, 4)));
  EXPECT_THAT(test::data_error_of([&] { open(section())->truth(3); }),
              AllOf(HasSubstr("shirt_000000_000080.oflow: 2x3"), HasSubstr("40x30")));
}

TEST_F(DeepDeformFolder, MotionIsThatFromTheFirstFrameTaken) {
  write_scene_flow(file("scene_flow/shirt_000040_000080.sflow"),
                   Image<Eigen::Vector3f>(width, height, Eigen::Vector3f(0, 0, 100)));
  EXPECT_EQ(open(section(", first: 2"))->truth(2).value().scene_flow(7, 7), Eigen::Vector3f(0, 0, 100));
}

TEST_F(DeepDeformFolder, OfSeveralObjectsOneIsNamed) {
  write_mask(file("mask/000000_my_bag.png"), MaskImage(width, height, 1));
  EXPECT_THAT(error_of(section()), HasSubstr("frame 000000 has several objects, my_bag, shirt; say which"));
  EXPECT_EQ(frames_of(*open(section(", object: my_bag")))[0].mask(0, 0), 1);
  EXPECT_EQ(frames_of(*open(section(", object: shirt")))[0].mask(0, 0), 0);
  EXPECT_FALSE(open(section(", object: my_bag"))->truth(3));
  EXPECT_THAT(error_of(section(", object: hat")),
              HasSubstr("no mask and no scene flow of 'hat'; it has my_bag, shirt"));
}

TEST_F(DeepDeformFolder, OnlyDepthAndIntrinsicsNeedToBeThere) {
  for (const char* name : {"color", "mask", "scene_flow"}) std::filesystem::remove_all(file(name));
  const auto stream = open(section());
  EXPECT_EQ(frames_of(*stream).size(), 3U);
  EXPECT_FALSE(stream->truth(3));
}

TEST_F(DeepDeformFolder, WhatIsMissingIsNamed) {
  EXPECT_THAT(error_of(section(", source: 0, target: 41")),
              HasSubstr("there is no frame 41; its depth images are 000000 to 000080"));
  EXPECT_THAT(error_of(section(", first: 4")), HasSubstr("no frame"));
  std::filesystem::remove(file("color/000040.png"));
  EXPECT_THAT(error_of(section()), AllOf(HasSubstr("no colour for"), HasSubstr("000040.png")));
  std::filesystem::remove(file("intrinsics.txt"));
  EXPECT_THAT(error_of(section(", source: 0, target: 80")), HasSubstr("intrinsics.txt: no such file"));
  std::filesystem::remove_all(file("depth"));
  EXPECT_THAT(error_of(section()), HasSubstr("no depth images; expected depth/*.png"));
}

TEST_F(DeepDeformFolder, WhatDoesNotFitIsNamed) {
  write_scene_flow(file("scene_flow/shirt_000000_000080.sflow"),
                   Image<Eigen::Vector3f>(2, 2, Eigen::Vector3f::Zero()));
  EXPECT_THAT(test::data_error_of([&] { open(section())->truth(3); }),
              AllOf(HasSubstr("shirt_000000_000080.sflow: 2x2"), HasSubstr("40x30")));
  write_depth(file("depth/x.png"), slope(800));
  EXPECT_THAT(error_of(section()), HasSubstr("x.png: the name of a frame is no number"));
}

TEST_F(DeepDeformFolder, APairIsTwoFrames) {
  EXPECT_THAT(test::config_error_of(section(", source: 0")), HasSubstr("'target' is missing"));
  EXPECT_THAT(test::config_error_of(section(", source: 0, target: 0")), HasSubstr("are both 0"));
}

TEST_F(DeepDeformFolder, DepthInTheUnitOfTumIsDoubted) {
  for (int i = 0; i < 3; ++i) write_depth(file(fmt::format("depth/{:06}.png", 40 * i)), slope(20001));
  EXPECT_THAT(open(section())->warnings(),
              ElementsAre(AllOf(HasSubstr("000000.png"), HasSubstr("0.2 (5000 units a metre"))));
}

/// The files of the real pair, laid out as the data set has them.
TEST_F(DeepDeformFolder, ARealPairIsRead) {
  const std::string data = test::real_data("deepdeform_seq258");
  if (data.empty()) GTEST_SKIP() << "deepdeform_seq258 is not below PLIANT_DATA";
  const auto lay_out = [&](const std::string& from, const std::string& to) {
    std::filesystem::create_directories(std::filesystem::path(file(to)).parent_path());
    std::filesystem::copy_file(data + "/" + from, file(to));
  };
  for (const char* number : {"000000", "000110"}) {
    lay_out(fmt::format("depth_{}.png", number), fmt::format("seq258/depth/{}.png", number));
    lay_out(fmt::format("color_{}.jpg", number), fmt::format("seq258/color/{}.jpg", number));
  }
  lay_out("000000_shirt.png", "seq258/mask/000000_shirt.png");
  lay_out("shirt_000000_000110.sflow", "seq258/scene_flow/shirt_000000_000110.sflow");
  lay_out("intrinsics.txt", "seq258/intrinsics.txt");
  const auto pair = test::load(
      *test::data_of("{type: deepdeform, folder: '" + file("seq258") + "', source: 0, target: 110}"), 0);
  EXPECT_EQ(pair.name, "seq258, 0 to 110");
  EXPECT_EQ(pair.camera.width, 640);
  EXPECT_FALSE(pair.source.mask.empty());
  EXPECT_TRUE(pair.truth);
  EXPECT_THAT(pair.warnings, IsEmpty());
}

}  // namespace
}  // namespace pliant
