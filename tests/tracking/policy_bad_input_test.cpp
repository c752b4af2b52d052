#include "framework/tracking/policy.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "framework/core/error.h"
#include "framework/tracking/tracker.h"
#include "tests/experiments/experiment_files.h"

// A bowl before a still camera, out of whose middle a hill grows.
namespace pliant::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Camera wide{80, 80, 39.5, 29.5, 80, 60};
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Frame with_hill(double height, const Camera& camera = wide) {
  const double scale = 80.0 / camera.width;
  Frame frame;
  frame.depth = DepthImage(camera.width, camera.height, 0);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double x = scale * (u - camera.cx), y = scale * (v - camera.cy);
      frame.depth(u, v) = static_cast<float>(500 + (x * x + 2 * y * y) / 32 -
                                             height * std::exp(-(x * x + y * y) / (2 * 8 * 8)));
    }
  }
  return frame;
}

Frame empty() {
  Frame frame;
  frame.depth = DepthImage(wide.width, wide.height, 0);
  return frame;
}

/// A hill that grows to 8 mm in 10 frames.
std::vector<Frame> growing() {
  std::vector<Frame> frames;
  for (int i = 0; i <= 10; ++i) frames.push_back(with_hill(0.8 * i));
  return frames;
}

Frame noisy(Frame frame, double deviation, std::mt19937& random) {
  for (int v = 0; v < wide.height; ++v)
    for (int u = 0; u < wide.width; ++u)
      frame.depth(u, v) += static_cast<float>(deviation * (std::ldexp(random(), -31) - 1));
  return frame;
}

class PolicyBadInput : public ExperimentFiles {
 protected:
  TrackingMethod method(const std::vector<std::string>& sets) const {
    const std::string text =
        "model: {type: tsdf, volume: fitted, resolution: 48}\nacquisition: {filter: none}\n"
        "graph: {type: uniform, nodes: 24}\nsampler: {type: uniform, points: 400}\n";
    return make_tracking_method(plan(text, sets).runs.at(0).values, registry_);
  }

  std::vector<FrameRecord> track(Tracker& tracker, const std::vector<Frame>& frames) {
    std::vector<FrameRecord> records;
    for (Frame frame : frames) {
      frame.time = time_++;
      records.push_back(tracker.track(frame));
    }
    return records;
  }

  std::vector<FrameRecord> track(const TrackingMethod& method, const std::vector<Frame>& frames) {
    Tracker tracker(method, Rig{wide}, device_);
    return track(tracker, frames);
  }

  bool registers(double threshold, double error) const {
    const auto policy = registry_.make<Policy>(Parameters(
        "adaptive", {{"threshold", threshold}, {"patience", std::int64_t{5}}, {"growth", 0.25}}, ""));
    return policy->registers({7, TrackingError{error, 0, 100}, std::nullopt});
  }

  std::string config_error_of(const std::string& policy) const {
    try {
      method({"policy=" + policy});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  Device device_;
  double time_ = 0;
};

TEST_F(PolicyBadInput, OfThresholdZeroTakesEveryFrameForADeformation) {
  const auto records = track(method({"policy={type: adaptive, threshold: 0, patience: 0}"}), growing());
  for (std::size_t i = 1; i < records.size(); ++i) {
    EXPECT_EQ(records[i].state, FrameState::tracked) << records[i].reason;
    EXPECT_TRUE(records[i].registration.has_value()) << i;
  }
}

TEST_F(PolicyBadInput, OfAGreatThresholdIsRigidOnly) {
  const auto rigid = track(method({"policy=rigid_only"}), growing());
  const auto adaptive = track(method({"policy={type: adaptive, threshold: 1e300}"}), growing());
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    EXPECT_FALSE(adaptive[i].registration.has_value());
    EXPECT_EQ(adaptive[i].camera_from_model.matrix(), rigid[i].camera_from_model.matrix());
  }
}

TEST_F(PolicyBadInput, ThresholdsThatAreNoneAreErrorsOfTheirPlace) {
  for (const char* threshold : {".inf", "inf", "-.inf", ".nan", "nan", "-0.1"})
    EXPECT_THAT(config_error_of(std::string("{type: adaptive, threshold: ") + threshold + "}"),
                AllOf(HasSubstr("threshold"), HasSubstr(threshold), HasSubstr("at least 0")));
  EXPECT_THAT(config_error_of("{type: every_n, n: 0}"), HasSubstr("from 1 to 1000000"));
}

TEST_F(PolicyBadInput, ModelsOfPartsOfVectorsOfVoxelsAreErrorsOfTheirPlace) {
  EXPECT_THAT(
      [&] { method({"model.resolution=100"}); },
      ::testing::ThrowsMessage<ConfigError>(AllOf(
          HasSubstr("--set model.resolution: 'model.resolution' is '100'"), HasSubstr("a multiple of 16"))));
}

TEST_F(PolicyBadInput, MadeFromCppWithoutAFiniteThresholdNeverRegisters) {
  EXPECT_TRUE(registers(0.4, 0.5));
  EXPECT_FALSE(registers(0.4, 0.3));
  for (const double error : {0.0, 0.5, 1e300, nan}) {
    EXPECT_FALSE(registers(infinity, error));
    EXPECT_FALSE(registers(nan, error));
  }
  EXPECT_FALSE(registers(0, nan)) << "an error that is not known is no sign of a deformation";
}

/// Nodes as dense as points that follow nothing but noise.
TEST_F(PolicyBadInput, ARegistrationThatDivergesLeavesTheModelAsItWas) {
  std::mt19937 random(1);
  std::vector<Frame> frames{with_hill(0)};
  for (int i = 0; i < 4; ++i) frames.push_back(noisy(with_hill(0), 8, random));
  const TrackingMethod rigid = method({"policy=rigid_only"});
  Tracker before(rigid, Rig{wide}, device_);
  const auto expected = track(before, frames);
  for (const char* update : {"reintegration", "warp_field"}) {
    SCOPED_TRACE(update);
    const TrackingMethod absurd = method({"policy={type: every_n, n: 1}", std::string("update=") + update,
                                          "energies.constraint.weight=1e12",
                                          "energies.regularization.weight=0", "energies.rotation.weight=0"});
    Tracker tracker(absurd, Rig{wide}, device_);
    const auto records = track(tracker, frames);
    for (std::size_t i = 1; i < records.size(); ++i) {
      EXPECT_TRUE(is_rejected(records[i])) << i;
      EXPECT_FALSE(records[i].registration->reason.empty());
      EXPECT_EQ(records[i].camera_from_model.matrix(), expected[i].camera_from_model.matrix()) << i;
    }
    EXPECT_EQ(tracker.model().mesh().vertices, before.model().mesh().vertices);
  }
}

TEST_F(PolicyBadInput, WhatLeavesAndReturnsDeformedIsRegistered) {
  for (const char* update : {"reintegration", "warp_field"}) {
    SCOPED_TRACE(update);
    std::vector<Frame> frames{with_hill(0), with_hill(0), empty(), empty(), with_hill(4), with_hill(4)};
    const auto records =
        track(method({"policy={type: adaptive, threshold: 0.2}", std::string("update=") + update}), frames);
    EXPECT_EQ(records[1].state, FrameState::tracked);
    EXPECT_FALSE(records[1].registration.has_value()) << "nothing deforms";
    for (const std::size_t away : {2, 3}) {
      EXPECT_EQ(records[away].state, FrameState::lost);
      EXPECT_FALSE(records[away].registration.has_value());
    }
    EXPECT_EQ(records[4].state, FrameState::tracked) << records[4].reason;
    EXPECT_TRUE(is_registered(records[4]));
    EXPECT_LT(records[4].error.mean, records[4].rigid_error.mean);
    EXPECT_EQ(records[5].state, FrameState::tracked) << records[5].reason;
  }
}

TEST_F(PolicyBadInput, WaitsForAFirstFrameThatShowsTheObject) {
  for (const char* update : {"reintegration", "warp_field"}) {
    SCOPED_TRACE(update);
    const auto records = track(method({"policy={type: every_n, n: 1}", std::string("update=") + update}),
                               {empty(), empty(), with_hill(0), with_hill(3)});
    for (const std::size_t waiting : {0, 1}) EXPECT_EQ(records[waiting].state, FrameState::waiting);
    EXPECT_EQ(records[2].state, FrameState::started);
    EXPECT_FALSE(records[2].registration.has_value()) << "there is no model before";
    EXPECT_EQ(records[3].state, FrameState::tracked) << records[3].reason;
    EXPECT_TRUE(is_registered(records[3]));
  }
}

}  // namespace
}  // namespace pliant::test
