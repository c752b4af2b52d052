#include "framework/tracking/policy.h"

#include <gmock/gmock.h>

#include <optional>

#include "framework/core/error.h"
#include "framework/tracking/tracking_method.h"
#include "tests/experiments/experiment_files.h"

// When a model is registered, and what an experiment may ask for.
namespace pliant::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class PolicyTest : public ExperimentFiles {
 protected:
  TrackingMethod method_with(const std::string& setting) const {
    const std::vector<std::string> sets{"data={type: head}", "model={type: tsdf}", setting};
    return make_tracking_method(plan("", sets).runs.at(0).values, registry_);
  }

  std::string config_error_of(const std::string& setting) const {
    try {
      method_with(setting);
    } catch (const ConfigError& error) {
      return error.what();
    }
    ADD_FAILURE() << "no ConfigError for " << setting;
    return "";
  }
};

/// The first frames that a policy registers at some error.
std::vector<int> registered(const Policy& policy, double mean,
                            const std::optional<PolicyInput::Rejection>& rejection = std::nullopt) {
  const TrackingError rigid{.mean = mean, .deviation = 1, .matched = 100};
  std::vector<int> frames;
  for (int frame = 1; frame <= 12; ++frame)
    if (policy.registers({frame, rigid, rejection})) frames.push_back(frame);
  return frames;
}

TEST_F(PolicyTest, IsNoneUnlessAsked) { EXPECT_EQ(method_with("seed=1").policy, nullptr); }

TEST_F(PolicyTest, RigidOnlyNeverRegisters) {
  const auto method = method_with("policy=rigid_only");
  EXPECT_THAT(registered(*method.policy, 100), ElementsAre());
  EXPECT_TRUE(method.policy->is_rigid());
  EXPECT_FALSE(method_with("policy=adaptive").policy->is_rigid());
}

TEST_F(PolicyTest, EveryNRegistersEveryNthFrameWhateverTheError) {
  EXPECT_THAT(registered(*method_with("policy=every_n").policy, 0), ElementsAre(5, 10));
  EXPECT_THAT(registered(*method_with("policy={type: every_n, n: 4}").policy, 50), ElementsAre(4, 8, 12));
  EXPECT_EQ(registered(*method_with("policy={type: every_n, n: 1}").policy, 0).size(), 12U);
}

TEST_F(PolicyTest, AdaptiveRegistersWhereTheErrorIsAboveTheThreshold) {
  const auto adaptive = method_with("policy={type: adaptive, threshold: 1.5}");
  EXPECT_TRUE(registered(*adaptive.policy, 1.5).empty());
  EXPECT_EQ(registered(*adaptive.policy, 1.51).size(), 12U);
  EXPECT_TRUE(registered(*method_with("policy=adaptive").policy, 0.39).empty());
  EXPECT_EQ(registered(*method_with("policy=adaptive").policy, 0.41).size(), 12U);
  EXPECT_EQ(registered(*method_with("policy={type: adaptive, threshold: 0}").policy, 1e-6).size(), 12U);
}

TEST_F(PolicyTest, AdaptiveWaitsAfterARejectionUnlessTheErrorGrows) {
  const auto method = method_with("policy={type: adaptive, threshold: 1, patience: 3, growth: 0.5}");
  const PolicyInput::Rejection rejection{6, 2};
  EXPECT_THAT(registered(*method.policy, 2.9, rejection), ElementsAre(10, 11, 12));
  EXPECT_EQ(registered(*method.policy, 3.1, rejection).size(), 12U);
  EXPECT_TRUE(registered(*method.policy, 0.9, PolicyInput::Rejection{6, 0.1}).empty());
}

TEST_F(PolicyTest, BadNumbersAreRefused) {
  EXPECT_THAT(config_error_of("policy={type: every_n, n: 0}"), AllOf(HasSubstr("policy.n"), HasSubstr("1")));
  for (const std::string threshold : {"-1", ".inf", ".nan", "often"})
    EXPECT_THAT(config_error_of("policy={type: adaptive, threshold: " + threshold + "}"),
                HasSubstr("policy.threshold"));
  EXPECT_THAT(config_error_of("policy={type: adaptive, patience: -1}"), HasSubstr("policy.patience"));
  EXPECT_THAT(config_error_of("policy={type: adaptive, growth: -0.1}"), HasSubstr("policy.growth"));
  for (const std::string weight : {"0", "256", "-3", "1.5"})
    EXPECT_THAT(config_error_of("update={type: reintegration, weight: " + weight + "}"),
                HasSubstr("update.weight"));
  EXPECT_THAT(config_error_of("tracking_error={radius: 65}"), HasSubstr("tracking_error.radius"));
  EXPECT_THAT(config_error_of("tracking_error={min_gain: 1.1}"), HasSubstr("tracking_error.min_gain"));
  EXPECT_THAT(config_error_of("followed={step: 0}"), HasSubstr("followed.step"));
}

}  // namespace
}  // namespace pliant::test
