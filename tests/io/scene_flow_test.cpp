#include "framework/io/scene_flow.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A file made by hand: three words of header, then values channel by channel.
std::vector<std::uint8_t> flow_file(std::uint32_t width, std::uint32_t height, std::uint32_t channels,
                                    const std::vector<float>& values) {
  const std::uint32_t header[] = {width, height, channels};
  std::vector<std::uint8_t> bytes(sizeof(header) + values.size() * sizeof(float));
  std::memcpy(bytes.data(), header, sizeof(header));
  if (!values.empty())
    std::memcpy(bytes.data() + sizeof(header), values.data(), values.size() * sizeof(float));
  return bytes;
}

class SceneFlow : public test::TestFiles {
 protected:
  std::string error_of(const std::vector<std::uint8_t>& bytes) const {
    const auto path = write("truth.sflow", bytes);
    const auto error = data_error_of([&] { read_scene_flow(path); });
    EXPECT_THAT(error, HasSubstr(path));
    return error;
  }
};

TEST_F(SceneFlow, MetresBecomeMillimetresChannelByChannel) {
  const auto path = write("truth.sflow", flow_file(2, 1, 3, {0.25f, 1, -0.5f, 2, 0.125f, 3}));
  const auto flow = read_scene_flow(path);
  ASSERT_EQ(flow.width(), 2);
  ASSERT_EQ(flow.height(), 1);
  EXPECT_EQ(flow(0, 0), Eigen::Vector3f(250, -500, 125));
  EXPECT_EQ(flow(1, 0), Eigen::Vector3f(1000, 2000, 3000));
}

TEST_F(SceneFlow, UnknownMotionIsNaN) {
  const auto path = write("truth.sflow", flow_file(2, 1, 3, {-kInfinity, 1, 0, 1, 0, 1}));
  const auto flow = read_scene_flow(path);
  EXPECT_TRUE(flow(0, 0).array().isNaN().all());
  EXPECT_TRUE(flow(1, 0).allFinite());
}

TEST_F(SceneFlow, NaNIsAnErrorThatNamesThePixel) {
  std::vector<float> values(3 * 6, 0);
  values[6 + 4] = std::nanf("");  // channel 1, pixel (1, 1) of 3x2
  EXPECT_THAT(error_of(flow_file(3, 2, 3, values)), HasSubstr("NaN in ground truth at pixel (1, 1)"));
  values[4] = -kInfinity;
  EXPECT_THAT(error_of(flow_file(3, 2, 3, values)), HasSubstr("NaN in ground truth"));
}

TEST_F(SceneFlow, InfiniteMotionIsAnError) {
  EXPECT_THAT(error_of(flow_file(1, 1, 3, {0, kInfinity, 0})), HasSubstr("infinite motion"));
  EXPECT_THAT(error_of(flow_file(1, 1, 3, {0, 3e38f, 0})), HasSubstr("infinite motion"));
}

TEST_F(SceneFlow, WrongSizesAreErrors) {
  EXPECT_THAT(error_of({1, 2, 3}), HasSubstr("truncated"));
  EXPECT_THAT(error_of(flow_file(2, 1, 3, {1, 2, 3, 4, 5})),
              AllOf(HasSubstr("truncated"), HasSubstr("32 bytes")));
  EXPECT_THAT(error_of(flow_file(2, 1, 3, {1, 2, 3, 4, 5, 6, 7})), HasSubstr("too long"));
  EXPECT_THAT(error_of(flow_file(2, 1, 2, {1, 2, 3, 4})), HasSubstr("2 channels, expected 3"));
  EXPECT_THAT(error_of(flow_file(0, 1, 3, {})), HasSubstr("0x1"));
  EXPECT_THAT(error_of(flow_file(4000000000u, 4000000000u, 3, {})), HasSubstr("4000000000x4000000000"));
}

TEST_F(SceneFlow, SurvivesARoundTrip) {
  Image<Eigen::Vector3f> flow(2, 2, Eigen::Vector3f(1, -2, 300));
  flow(1, 0).setConstant(std::nanf(""));
  write_scene_flow(file("truth.sflow"), flow);
  const auto read = read_scene_flow(file("truth.sflow"));
  EXPECT_TRUE(read(0, 1).isApprox(flow(0, 1), 1e-6f));
  EXPECT_TRUE(read(1, 0).hasNaN());
}

TEST_F(SceneFlow, MissingAndUnwritableAreErrors) {
  EXPECT_THAT(data_error_of([&] { read_scene_flow(file("none.sflow")); }), HasSubstr("none.sflow"));
  EXPECT_THAT(data_error_of([&] {
                write_scene_flow(file("no/a.sflow"), {1, 1, Eigen::Vector3f::Zero()});
              }),
              HasSubstr("no/a.sflow"));
}

TEST_F(SceneFlow, OpticalFlowIsInPixels) {
  const auto path = write("truth.oflow", flow_file(2, 1, 2, {0.5f, -kInfinity, 3, 1}));
  const auto flow = read_optical_flow(path);
  EXPECT_EQ(flow(0, 0), Eigen::Vector2f(0.5, 3));
  EXPECT_TRUE(flow(1, 0).array().isNaN().all());
  write_optical_flow(file("again.oflow"), flow);
  EXPECT_EQ(read_optical_flow(file("again.oflow"))(0, 0), flow(0, 0));
  EXPECT_THAT(data_error_of([&] { read_scene_flow(path); }),
              HasSubstr("2 channels, expected 3 of scene flow"));
  write("flow.sflow", flow_file(1, 1, 3, {1, 2, 3}));
  EXPECT_THAT(data_error_of([&] { read_optical_flow(file("flow.sflow")); }),
              HasSubstr("3 channels, expected 2 of optical flow"));
}

}  // namespace
}  // namespace pliant
