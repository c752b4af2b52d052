#include "experiments/api/register_depth.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "experiments/datasets/synthetic_sheet.h"
#include "experiments/runner/components.h"
#include "experiments/runner/experiment.h"
#include "framework/core/error.h"
#include "framework/tracking/register_pair.h"

namespace pliant {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Camera kCamera{.fx = 131.25, .fy = 131.25, .cx = 79.5, .cy = 59.5, .width = 160, .height = 120};

template <class T>
std::span<const std::uint8_t> bytes_of(const Image<T>& image) {
  return {reinterpret_cast<const std::uint8_t*>(image.data()), image.size() * sizeof(T)};
}

class RegisterDepth : public testing::Test {
 protected:
  RegisterDepth() {
    Device device;
    const auto stream = SyntheticSheet(BendingSheet({}), {kCamera}).open(device, 1);
    pair_ = read_pair(*stream);
    truth_ = stream->truth(2).value().scene_flow;
  }

  static DepthView view_of(const Frame& frame) {
    return {.depth = frame.depth.pixels(), .rgb = bytes_of(frame.color)};
  }
  DepthView source() const { return view_of(pair_.source); }
  DepthView target() const { return view_of(pair_.target); }

  /// What the built-in recipe says of these.
  template <class Call>
  static std::string error(Call call) {
    try {
      call();
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  }
  std::string error_of_source(const DepthView& view, const Camera& camera = kCamera) {
    return error([&] { registration_.run(view, target(), camera); });
  }

  FramePair pair_;
  Image<Eigen::Vector3f> truth_;
  DepthRegistration registration_;
};

TEST_F(RegisterDepth, IsWhatTheSameExperimentDoes) {
  Registry registry;
  register_everything(registry);
  const ConfigText text{"extends: methods/best.yaml\ndata: synthetic_sheet\n", "experiment",
                        PLIANT_EXPERIMENTS};
  const Parameters values = plan_experiment({text, {}, {}}, registry).runs.front().values;
  Device device;
  const auto expected = register_pair(pair_, make_method(values, registry), device, 1);

  const auto result = registration_.run(source(), target(), kCamera);
  EXPECT_EQ(result.pixels, expected.source.pixels);
  EXPECT_EQ(result.before, expected.source.points);
  EXPECT_EQ(result.after, expected.points);
  EXPECT_EQ(result.normals, expected.normals);
  EXPECT_EQ(result.matched, expected.matched);
  EXPECT_EQ(result.rigid_motion.matrix(), expected.alignment.motion.matrix());
  EXPECT_EQ(result.nodes, expected.counts.nodes);
  EXPECT_EQ(result.termination, expected.termination);
}

TEST_F(RegisterDepth, BringsPointsWhereTheyWent) {
  const auto result = registration_.run(source(), target(), kCamera);
  ASSERT_GT(result.pixels.size(), 1000U);
  ASSERT_EQ(result.before.size(), result.pixels.size());
  ASSERT_EQ(result.after.size(), result.pixels.size());
  double still = 0;
  double wrong = 0;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const Eigen::Vector2i& pixel = result.pixels[i];
    const float depth = pair_.source.depth(pixel.x(), pixel.y());
    EXPECT_LT((result.before[i] - kCamera.unproject(pixel.x(), pixel.y(), depth).cast<float>()).norm(),
              1e-2F);
    const Eigen::Vector3f& motion = truth_(pixel.x(), pixel.y());
    still += motion.norm();
    wrong += (result.before[i] + motion - result.after[i]).norm();
  }
  EXPECT_LT(wrong, 0.1 * still);
  EXPECT_LT(result.residual_after, result.residual_before);
  EXPECT_GT(std::count(result.matched.begin(), result.matched.end(), 1), 0.8 * result.matched.size());
}

TEST_F(RegisterDepth, ManyPairsAreRegisteredByOneObjectAsEachAlone) {
  const DepthRegistrationOptions options{.recipe = "extends: methods/ed.yaml", .sets = {"alignment=none"}};
  DepthRegistration registration(options);
  const std::vector<float> plane(40 * 30, 800);
  const std::vector<float> nearer(40 * 30, 790);
  const Camera small{.fx = 40, .fy = 40, .cx = 19.5, .cy = 14.5, .width = 40, .height = 30};
  const auto first = registration.run(source(), target(), kCamera);
  const auto other = registration.run({.depth = plane}, {.depth = nearer}, small);
  const auto again = registration.run(source(), target(), kCamera);
  EXPECT_EQ(again.after, first.after);
  EXPECT_EQ(other.after, register_depth({.depth = plane}, {.depth = nearer}, small, options).after);
}

TEST_F(RegisterDepth, DepthInOtherUnitsIsTheSame) {
  std::vector<std::uint16_t> counted(pair_.source.depth.size());
  std::vector<float> millimetres(counted.size());
  for (std::size_t i = 0; i < counted.size(); ++i) {
    counted[i] = static_cast<std::uint16_t>(std::lround(pair_.source.depth.data()[i] * 5));
    millimetres[i] = static_cast<float>(counted[i] * 0.2);
  }
  DepthRegistration registration({.recipe = "extends: methods/best_depth.yaml"});
  const auto expected = registration.run({.depth = millimetres}, target(), kCamera);
  EXPECT_EQ(registration.run({.depth = counted, .depth_scale = 0.2}, target(), kCamera).after,
            expected.after);
}

TEST_F(RegisterDepth, PointsAreThoseOfTheMask) {
  MaskImage mask(kCamera.width, kCamera.height);
  for (int v = 40; v < 80; ++v)
    for (int u = 60; u < 100; ++u) mask(u, v) = 255;
  DepthView masked = source();
  masked.mask = bytes_of(mask);
  const auto result = registration_.run(masked, target(), kCamera);
  EXPECT_EQ(result.pixels.size(), 1600U);
  EXPECT_EQ(result.pixels.front(), Eigen::Vector2i(60, 40));
}

TEST_F(RegisterDepth, ArraysThatDoNotFitAreRefused) {
  const std::vector<float> depth(100, 800);
  EXPECT_EQ(error_of_source({.depth = depth}),
            "the source's depth has 100 values; expected 160 x 120 = 19200");
  EXPECT_EQ(error_of_source({.depth = std::span<const float>()}),
            "the source's depth is null; expected an array of 160 x 120 values");
  EXPECT_EQ(error_of_source({}), "the source's depth is null; expected an array of 160 x 120 values");
  DepthView view = source();
  view.rgb = view.rgb.first(19200);
  EXPECT_EQ(error_of_source(view), "the source's rgb has 19200 values; expected 160 x 120 x 3 = 57600");
  view = source();
  view.mask = view.rgb;
  EXPECT_EQ(error_of_source(view), "the source's mask has 57600 values; expected 160 x 120 = 19200");
  EXPECT_EQ(error([&] { registration_.run(source(), {}, kCamera); }),
            "the target's depth is null; expected an array of 160 x 120 values");
}

TEST_F(RegisterDepth, NumbersThatMeanNothingAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DepthView view = source();
  for (const double scale : {0.0, -1.0, nan}) {
    view.depth_scale = scale;
    EXPECT_THAT(error_of_source(view), HasSubstr("the source's depth_scale is ")) << scale;
  }
  for (const double focal_length : {0.0, -525.0, nan}) {
    Camera camera = kCamera;
    camera.fx = focal_length;
    EXPECT_THAT(error_of_source(source(), camera), HasSubstr("focal lengths are ")) << focal_length;
  }
  Camera camera = kCamera;
  camera.cy = nan;
  EXPECT_THAT(error_of_source(source(), camera), HasSubstr("principal point"));
  EXPECT_EQ(error_of_source(source(), {}), "the camera has 0 x 0 pixels; expected at least 1 x 1");
}

TEST_F(RegisterDepth, ImagesOfHolesAreRefused) {
  const std::vector<float> nothing(pair_.source.depth.size(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(error_of_source({.depth = nothing}), HasSubstr("source"));
  EXPECT_THAT(error([&] { registration_.run(source(), {.depth = nothing}, kCamera); }), HasSubstr("target"));
}

TEST_F(RegisterDepth, DepthInMetresComesWithAWarning) {
  std::vector<float> metres = pair_.source.depth.pixels();
  for (float& depth : metres) depth /= 1000;
  DepthRegistration registration({.recipe = "extends: methods/ed.yaml", .sets = {"alignment=none"}});
  EXPECT_THAT(registration.run({.depth = metres}, {.depth = metres}, kCamera).warnings,
              testing::Contains(HasSubstr("the source: the median depth is ")));
}

TEST_F(RegisterDepth, OptionsAreCheckedStrictly) {
  const auto error_of = [](const DepthRegistrationOptions& options) -> std::string {
    try {
      const DepthRegistration registration(options);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of({.sets = {"graph.nodse=3"}}), HasSubstr("did you mean 'nodes'?"));
  EXPECT_THAT(error_of({.recipe = "extends: methods/best.yaml\ndata: synthetic_sheet\n"}),
              HasSubstr("recipe:2:1: unknown key 'data'"));
  EXPECT_THAT(error_of({.recipe = "extends: methods/bset.yaml"}), HasSubstr("recipe:1:10: cannot extend"));
  EXPECT_THROW(DepthRegistration({.sets = {"device=no such device"}}), DeviceError);
}

TEST_F(RegisterDepth, EveryMethodThatComesWithPliantIsThere) {
  for (const auto& file : std::filesystem::directory_iterator(PLIANT_EXPERIMENTS "/methods"))
    EXPECT_NO_THROW(DepthRegistration({.recipe = "extends: methods/" + file.path().filename().string()}));
}

TEST_F(RegisterDepth, ProgressIsTold) {
  int calls = 0;
  register_depth(source(), target(), kCamera,
                 {.recipe = "extends: methods/ed.yaml",
                  .sets = {"alignment=none", "stopping.max_iterations=3", "stopping.min_progress=0"},
                  .progress = [&](const Progress& progress) { calls += progress.done > 0 ? 1 : 0; }});
  EXPECT_GE(calls, 3);
}

}  // namespace
}  // namespace pliant
