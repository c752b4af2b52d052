// Everything that can be wrong with what the program is given: a line that names the file and the reason,
// and an exit code that scripts can tell apart.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "framework/io/images.h"
#include "framework/io/scene_flow.h"
#include "tests/program/program_run.h"

namespace pliant::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int width = 160;
constexpr int height = 120;

/// A pair of slightly waved surfaces that registers without trouble; each test spoils one thing.
class BadInputTest : public ProgramTest {
 protected:
  BadInputTest() {
    write_depth(file("a.png"), waved(800));
    write_depth(file("b.png"), waved(805));
    write_mask(file("mask.png"), MaskImage(width, height, 1));
    write("k.txt", "131.25 0 79.5\n0 131.25 59.5\n0 0 1\n");
    write_scene_flow(file("truth.sflow"), Image<Eigen::Vector3f>(width, height, Eigen::Vector3f(0, 0, 5)));
    write("pair.yaml",
          "extends: methods/ed.yaml\n"
          "data:\n"
          "  type: rgbd_pair\n"
          "  source: {depth: a.png, mask: mask.png}\n"
          "  target: {depth: b.png}\n"
          "  intrinsics: k.txt\n"
          "  scene_flow: truth.sflow\n"
          "graph: {spacing: 12}\n"
          "stopping: {max_iterations: 2}\n");
  }

  static DepthImage waved(float distance) {
    DepthImage depth(width, height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u)
        depth(u, v) = std::round(distance + 10 * std::sin(0.05F * static_cast<float>(u + v)));
    }
    return depth;
  }

  /// The pair is refused with this exit code and one line that says both.
  void expect_refusal(int exit_code, const std::string& who, const std::string& why,
                      const std::string& more = "") const {
    const ProgramRun run = call("run pair.yaml --out out" + more);
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_THAT(run.errors(), ElementsAre(AllOf(HasSubstr(who), HasSubstr(why))));
    EXPECT_FALSE(std::filesystem::exists(file("out/result.json")));
  }
};

TEST_F(BadInputTest, NothingIsWrongWithThePairItself) {
  const ProgramRun run = call("run pair.yaml --out out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(BadInputTest, MissingPng) {
  std::filesystem::remove(file("a.png"));
  expect_refusal(2, "pair.yaml:4:19", "'a.png', which does not exist");
}

TEST_F(BadInputTest, TruncatedPng) {
  auto bytes = read_file(file("b.png"));
  bytes.resize(bytes.size() / 2);
  write_file(file("b.png"), bytes);
  expect_refusal(3, file("b.png"), "truncated");
}

TEST_F(BadInputTest, EightBitDepth) {
  write_mask(file("a.png"), MaskImage(width, height, 1));
  expect_refusal(3, file("a.png"), "8-bit");
}

TEST_F(BadInputTest, IntrinsicsOfAnotherSize) {
  write("k.txt", "525 0 319.5\n0 525 239.5\n0 0 1\n");
  expect_refusal(3, file("k.txt"), "160x120");
}

TEST_F(BadInputTest, NormalisedIntrinsics) {
  write("k.txt", "0.82 0 0.5\n0 1.09 0.5\n0 0 1\n");
  expect_refusal(3, file("k.txt") + ":1", "look normalised");
}

TEST_F(BadInputTest, WhatIsOddAboutTheDataIsToldByEveryCommand) {
  const char* warning = "b.png: the median depth is 32";
  const ProgramRun run = call("run pair.yaml --out out --set data.depth_scale=0.04");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(warning));
  EXPECT_THAT(text_of("out/result.json"), HasSubstr(warning));
  EXPECT_THAT(call("check pair.yaml --set data.depth_scale=0.04").out, HasSubstr(warning));
}

TEST_F(BadInputTest, AnErrorComesWithWhatIsOddAboutTheData) {
  DepthImage depth(width, height, 0);
  for (int v = 0; v < height; v += 9)
    for (int u = 0; u < width; u += 9) depth(u, v) = 800;
  write_depth(file("a.png"), depth);
  expect_refusal(3, "choose a finer one; warning: " + file("a.png"), "no normals",
                 " --set graph.spacing=1000");
}

TEST_F(BadInputTest, NamesWithSpacesParenthesesAndUmlautsAreGood) {
  std::filesystem::copy(file("pair.yaml"), file("mein Gesicht (2) \xC3\xBC#1.yaml"));
  const ProgramRun run = call("run 'mein Gesicht (2) \xC3\xBC#1.yaml'");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(file("out/mein Gesicht (2) \xC3\xBC_1/result.json")));
}

TEST_F(BadInputTest, ImagesOfDifferentSize) {
  write_depth(file("b.png"), DepthImage(80, 60, 800));
  expect_refusal(3, file("b.png"), "80x60 pixels, but the depth image " + file("a.png") + " has 160x120");
}

TEST_F(BadInputTest, EmptyMask) {
  write_mask(file("mask.png"), MaskImage(width, height, 0));
  expect_refusal(3, file("mask.png"), "the mask is empty");
}

TEST_F(BadInputTest, NoValidDepth) {
  write_depth(file("a.png"), DepthImage(width, height, 0));
  expect_refusal(3, file("a.png"), "no valid depth");
}

TEST_F(BadInputTest, FewerPointsThanNeighboursAreRegistered) {
  DepthImage depth(width, height, 0);
  depth(80, 60) = 800;
  depth(81, 60) = 800;
  write_depth(file("a.png"), depth);
  const ProgramRun run = call("run pair.yaml --out out --set graph.spacing=1 --set sampler.step=1");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const char* warning = "the graph has 2 node(s): all of them move every point";
  EXPECT_THAT(run.out, HasSubstr(std::string("warning: ") + warning));
  EXPECT_THAT(text_of("out/result.json"), HasSubstr(warning));
}

TEST_F(BadInputTest, NanInGroundTruth) {
  Image<Eigen::Vector3f> truth(width, height, Eigen::Vector3f(0, 0, 5));
  write_scene_flow(file("truth.sflow"), truth);
  auto bytes = read_file(file("truth.sflow"));
  for (std::size_t i = 0; i < 4; ++i) bytes[12 + 4 * 5 + i] = 0xFF;  // a NaN at pixel (5, 0)
  write_file(file("truth.sflow"), bytes);
  expect_refusal(3, file("truth.sflow"), "(5, 0)");
}

TEST_F(BadInputTest, GroundTruthThatIsUnknownInPlacesIsNoError) {
  Image<Eigen::Vector3f> truth(width, height, Eigen::Vector3f(0, 0, 5));
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  for (int u = 0; u < width; ++u) truth(u, 60) = Eigen::Vector3f(unknown, unknown, unknown);
  write_scene_flow(file("truth.sflow"), truth);  // written as -inf
  EXPECT_EQ(call("run pair.yaml --out out").exit_code, 0);
  EXPECT_EQ(text_of("out/result.json").find("null"), std::string::npos);
}

TEST_F(BadInputTest, OutputFolderThatCannotBeWritten) {
  write("taken", "a file");
  const ProgramRun run = call("run pair.yaml --out taken/below");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.errors(), ElementsAre(AllOf(HasSubstr("taken/below"), HasSubstr("cannot be made"))));
}

TEST_F(BadInputTest, HandleOutsideOfTheSurface) {
  expect_refusal(2, "--set handles: the handle is outside of the surface", "no point at pixel (500, 3)",
                 " --set 'handles={a: {type: pixel, at: [500, 3], radius: 5}}'");
  write("bent.yaml", "extends: pair.yaml\nhandles:\n  a: {type: point, at: [0, 0, 300], radius: 5}\n");
  for (const char* command : {"run bent.yaml --out out", "check bent.yaml"}) {
    const ProgramRun run = call(command);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.errors(), ElementsAre(HasSubstr("bent.yaml:3:3: the handle holds nothing")));
  }
}

TEST_F(BadInputTest, NoOpenClDevice) {
  const ProgramRun run = call("run pair.yaml --out out", "OCL_ICD_VENDORS=/nonexistent");
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_THAT(run.errors(), ElementsAre(HasSubstr("no OpenCL device")));
  EXPECT_EQ(call("devices", "OCL_ICD_VENDORS=/nonexistent").exit_code, 4);
}

TEST_F(BadInputTest, NoFolderForKernels) {
  write("file", "no folder");
  const std::string homeless = "env -u POCL_CACHE_DIR -u XDG_CACHE_HOME HOME=file TMPDIR=";
  EXPECT_EQ(call("devices", homeless + "'" + file("") + "'").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(file("pliant-" + std::to_string(geteuid()))));
  for (const char* command : {"devices", "run pair.yaml --out out"}) {
    const ProgramRun run = call(command, homeless + "file");
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_THAT(run.errors(), ElementsAre(AllOf(HasSubstr("file/.cache/pocl/kcache"),
                                                HasSubstr("set POCL_CACHE_DIR"), Not(HasSubstr("install")))));
  }
}

TEST_F(BadInputTest, NoSuchDevice) {
  expect_refusal(4, "no OpenCL device", "'abacus'", " --set device=abacus");
}

TEST_F(BadInputTest, MoreThanTheDeviceHas) {
  expect_refusal(4, "dense_cholesky", "bytes",
                 " --set graph.spacing=1 --set solver.linear_solver=dense_cholesky");
}

// The result before the failure is written, and the exit code tells of the failure.
TEST_F(BadInputTest, NoFiniteAnswer) {
  const ProgramRun run = call("run pair.yaml --out out --set energies.constraint.weight=1.0e+300");
  EXPECT_EQ(run.exit_code, 5);
  ASSERT_FALSE(run.errors().empty());
  EXPECT_THAT(run.errors().back(), AllOf(HasSubstr("error: pair.yaml: "), HasSubstr("not finite"),
                                         HasSubstr("the result is that of iteration 0")));
  EXPECT_THAT(run.out, HasSubstr("failed (the energy is not finite"));
  const std::string json = text_of("out/result.json");
  EXPECT_THAT(json, AllOf(HasSubstr("\"termination\": \"failed\""), HasSubstr("\"reason\": \"the energy")));
  EXPECT_EQ(json.find("null"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(file("out/registered.ply")));
}

}  // namespace
}  // namespace pliant::test
