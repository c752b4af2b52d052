#include "experiments/datasets/sequence_writer.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "framework/io/images.h"
#include "framework/io/intrinsics.h"
#include "framework/io/scene_flow.h"
#include "tests/datasets/data_of.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using test::data_of;
using test::shared_device;
using ::testing::HasSubstr;

const std::string scene =
    "{type: hand, image_width: 96, image_height: 72, focal_length: 79.5, keys: {open: {at: 0}, "
    "fist: {at: 0.07, pose: [fist=1], camera: {look_from: [100, 0, 0]}}}}";

class SequenceWriterTest : public test::TestFiles {
 protected:
  int write_scene(SequenceLayout layout) const {
    return write_sequence(*data_of(scene)->open(shared_device(), 1), layout, file("out")).frames;
  }
  std::vector<Frame> frames() const {
    const auto stream = data_of(scene)->open(shared_device(), 1);
    std::vector<Frame> frames;
    while (auto frame = stream->next()) frames.push_back(std::move(*frame));
    return frames;
  }
  std::string out(const std::string& name) const { return file("out/" + name); }
  std::string text_of(const std::string& name) const {
    std::ifstream stream(out(name));
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
};

TEST_F(SequenceWriterTest, DeepDeformHasMillimetresAndTruth) {
  EXPECT_EQ(write_scene(SequenceLayout::deepdeform), 3);
  const auto made = frames();
  for (std::size_t i = 0; i < made.size(); ++i) {
    const std::string name = "00000" + std::to_string(i) + ".png";
    const DepthImage depth = read_depth(out("depth/" + name));
    for (std::size_t pixel = 0; pixel < depth.size(); ++pixel)
      EXPECT_EQ(depth.pixels()[pixel], std::round(made[i].depth.pixels()[pixel]));
    EXPECT_EQ(read_color(out("color/" + name)).pixels(), made[i].color.pixels());
  }
  const PairTruth truth = data_of(scene)->open(shared_device(), 1)->truth(3).value();
  const auto flow = read_scene_flow(out("scene_flow/object_000000_000002.sflow"));
  const auto shift = read_optical_flow(out("optical_flow/object_000000_000002.oflow"));
  const MaskImage visible = read_mask(out("visible/object_000000_000002.png"));
  EXPECT_EQ(visible.pixels(), truth.visible.pixels());
  for (std::size_t i = 0; i < flow.size(); ++i) {
    EXPECT_EQ(flow.pixels()[i].allFinite(), truth.scene_flow.pixels()[i].allFinite());
    if (!flow.pixels()[i].allFinite()) continue;
    EXPECT_LT((flow.pixels()[i] - truth.scene_flow.pixels()[i]).norm(), 1e-4);
    EXPECT_EQ(shift.pixels()[i], truth.optical_flow.pixels()[i]);
  }
  const Camera camera = read_intrinsics(out("intrinsics.txt"), 96, 72).camera;
  EXPECT_EQ(camera.fx, 79.5);
  EXPECT_EQ(camera.cy, 35.5);
  EXPECT_FALSE(std::filesystem::exists(out("groundtruth.txt")));
}

TEST_F(SequenceWriterTest, TumHasListsAndTheCamerasWay) {
  EXPECT_EQ(write_scene(SequenceLayout::tum), 3);
  const auto made = frames();
  EXPECT_THAT(text_of("depth.txt"), HasSubstr("\n0.033333 depth/0.033333.png\n"));
  EXPECT_THAT(text_of("rgb.txt"), HasSubstr("\n0.066667 rgb/0.066667.png\n"));
  EXPECT_THAT(text_of("associations.txt"),
              HasSubstr("0.033333 rgb/0.033333.png 0.033333 depth/0.033333.png\n"));
  EXPECT_THAT(text_of("groundtruth.txt"), HasSubstr("\n0.000000 0.000000 0.000000 0.000000 0.000000 0.000000 "
                                                    "0.000000 1.000000\n"));
  EXPECT_THAT(text_of("groundtruth.txt"), HasSubstr("\n0.066667 0.09")) << "nearly 0.1 m to the right";
  const DepthImage depth = read_depth(out("depth/0.000000.png"));
  for (std::size_t pixel = 0; pixel < depth.size(); ++pixel)
    EXPECT_NEAR(depth.pixels()[pixel] / 5, made[0].depth.pixels()[pixel], 0.1001);
}

// What is written is read again by the sources of both layouts.
TEST_F(SequenceWriterTest, IsReadAgainByTheSourcesOfTheLayouts) {
  const auto made = frames();
  write_scene(SequenceLayout::deepdeform);
  const test::LoadedPair pair = test::load(*data_of("{type: deepdeform, folder: " + file("out") + "}"), 1);
  EXPECT_EQ(pair.camera.fx, 79.5);
  ASSERT_TRUE(pair.truth);
  int known = 0;
  for (std::size_t i = 0; i < pair.source.depth.size(); ++i) {
    EXPECT_NEAR(pair.source.depth.pixels()[i], made[0].depth.pixels()[i], 0.5001);
    known += pair.truth->scene_flow.pixels()[i].allFinite() ? 1 : 0;
  }
  EXPECT_GT(known, 500);
  std::filesystem::remove_all(file("out"));
  write_scene(SequenceLayout::tum);
  const test::LoadedPair tum = test::load(
      *data_of("{type: tum, folder: " + file("out") + ", intrinsics: " + file("out/intrinsics.txt") + "}"),
      1);
  for (std::size_t i = 0; i < tum.target.depth.size(); ++i)
    EXPECT_NEAR(tum.target.depth.pixels()[i], made[1].depth.pixels()[i], 0.1001);
  EXPECT_EQ(tum.target.color.pixels(), made[1].color.pixels());
}

TEST_F(SequenceWriterTest, WhatCannotBeWrittenIsNamed) {
  write("out", "a file");
  EXPECT_THAT(data_error_of([&] { write_scene(SequenceLayout::tum); }), HasSubstr(file("out")));
}

}  // namespace
}  // namespace pliant
