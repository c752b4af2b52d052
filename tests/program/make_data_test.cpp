#include <gmock/gmock.h>

#include <filesystem>

#include "framework/io/images.h"
#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const std::string small =
    "--set data.image_width=64 --set data.image_height=48 --set data.focal_length=52.5 ";

class MakeData : public ProgramTest {
 protected:
  bool has(const std::string& name) const { return fs::exists(file(name)); }
};

TEST_F(MakeData, WritesASourceOfThatName) {
  const ProgramRun run = call("data make synthetic_sheet --out sheet --set data.frames=3 " + small);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 frames of synthetic sheet are in sheet"));
  EXPECT_EQ(read_depth(file("sheet/depth/000002.png")).width(), 64);
  EXPECT_TRUE(has("sheet/color/000000.png"));
  EXPECT_TRUE(has("sheet/scene_flow/object_000000_000002.sflow"));
  EXPECT_FALSE(has("sheet/unfinished"));
}

TEST_F(MakeData, WritesTheDataOfAnExperimentInEitherLayout) {
  write("my.yaml",
        "data: {type: hand, target: [fist=1], image_width: 64, image_height: 48, focal_length: 52.5}\n"
        "solver: gauss_newton\nenergies: {constraint: {weight: 1}}\n");
  const ProgramRun run = call("data make my.yaml --layout tum --out hand");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(has("hand/depth/0.033333.png"));
  EXPECT_TRUE(has("hand/associations.txt"));
  EXPECT_TRUE(has("hand/groundtruth.txt"));
  EXPECT_TRUE(has("hand/optical_flow/object_000000_000001.oflow"));
}

TEST_F(MakeData, ASecondTimeReplacesOnlyWhatIsItsOwn) {
  ASSERT_EQ(call("data make synthetic_sheet --out sheet --set data.frames=3 " + small).exit_code, 0);
  write("sheet/notes.txt", "mine");
  ASSERT_EQ(call("data make synthetic_sheet --out sheet " + small).exit_code, 0);
  EXPECT_TRUE(has("sheet/depth/000001.png"));
  EXPECT_FALSE(has("sheet/depth/000002.png")) << "of the longer one before";
  EXPECT_EQ(text_of("sheet/notes.txt"), "mine");
  fs::create_directories(file("other"));
  write("other/intrinsics.txt", "mine");
  const ProgramRun run = call("data make synthetic_sheet --out other " + small);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("other/intrinsics.txt is not of an earlier result"));
  EXPECT_EQ(text_of("other/intrinsics.txt"), "mine");
  EXPECT_FALSE(has("other/depth"));
}

// Files may become no larger than 2 MB, and a scene flow is: the disk is as good as full.
TEST_F(MakeData, WithoutRoomNothingIsLeft) {
  const ProgramRun run = call("data make synthetic_sheet --out sheet", "ulimit -f 4000;");
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_THAT(run.err, HasSubstr("sheet/unfinished/"));
  EXPECT_FALSE(has("sheet"));
}

TEST_F(MakeData, WhatIsNoDataIsAnError) {
  const ProgramRun name = call("data make sheeet --out x");
  EXPECT_EQ(name.exit_code, 2);
  EXPECT_THAT(name.err, HasSubstr("sheeet"));
  EXPECT_EQ(call("data make synthetic_sheet --layout zip").exit_code, 2);
  const ProgramRun key = call("data make synthetic_sheet --set data.nose=1");
  EXPECT_EQ(key.exit_code, 2);
  EXPECT_THAT(key.err, HasSubstr("did you mean 'noise'?"));
  const ProgramRun unseen = call("data make hand --set data.motion.shift_x=9000 --out x");
  EXPECT_EQ(unseen.exit_code, 3);
  EXPECT_THAT(unseen.err, HasSubstr("hand: no pixel of the camera sees the mesh in frame 2"));
  EXPECT_FALSE(has("x"));
}

}  // namespace
}  // namespace pliant::test
