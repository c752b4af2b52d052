#include <gtest/gtest.h>

#include "framework/evaluation/metrics.h"
#include "framework/tracking/method.h"
#include "framework/tracking/register_pair.h"
#include "tests/experiments/experiment_files.h"

// Weights and scales of losses that go from initial values to final ones.
namespace pliant::test {
namespace {

TEST(Schedule, RunsOutOverItsIterations) {
  const Schedule schedule{.iterations = 4};
  EXPECT_EQ(schedule.remaining(0), 1);
  EXPECT_EQ(schedule.remaining(1), 0.75);
  EXPECT_EQ(schedule.remaining(4), 0);
  EXPECT_EQ(schedule.remaining(9), 0);
  EXPECT_EQ(Schedule().remaining(0), 0) << "without iterations the final values hold from the first on";
}

TEST(Schedule, WeightAndLossScaleFallGeometrically) {
  Energy energy;
  energy.stencil = Stencil::per_constraint;
  energy.weight = 5;
  energy.initial_weight = 500;
  energy.loss = {"welsch", 10};
  energy.initial_loss_scale = 40;
  EXPECT_NEAR(energy.at(1).weight, 500, 1e-9);
  EXPECT_NEAR(energy.at(0.5).weight, 50, 1e-9);
  EXPECT_EQ(energy.at(0).weight, 5);
  EXPECT_NEAR(energy.at(1).loss.scale, 40, 1e-9);
  EXPECT_NEAR(energy.at(0.5).loss.scale, 20, 1e-9);
  EXPECT_EQ(energy.at(0).loss.scale, 10);
}

TEST(Schedule, WhatHasNoInitialValueStays) {
  Energy energy;
  energy.weight = 5;
  energy.loss = {"welsch", 10};
  EXPECT_EQ(energy.at(0.7).weight, 5);
  EXPECT_EQ(energy.at(0.7).loss.scale, 10);
}

TEST(Schedule, AnEnergyThatIsSwitchedOffStaysOff) {
  Energy energy;
  energy.weight = 0;
  energy.initial_weight = 500;
  EXPECT_EQ(energy.at(1).weight, 0);
}

class ScheduledRegistration : public ExperimentFiles {
 protected:
  /// Registers the small sheet, which is as good as rigid at first.
  RegistrationResult register_sheet(int max_iterations) {
    const Parameters values =
        plan("", {"schedule.iterations=8", "energies.rotation={weight: 1000, initial_weight: 1e9}",
                  "energies.regularization.initial_weight=1e7",
                  "stopping={min_progress: 0, max_iterations: " + std::to_string(max_iterations) + "}"})
            .runs[0]
            .values;
    pair_ = workbench_.pair(values);
    return register_pair(pair_, make_method(values, registry_), device_, 1);
  }

  double residual(const RegistrationResult& result, const std::vector<Eigen::Vector3f>& points) const {
    return Evaluation(pair_, std::nullopt, result.source, make_surface_image(pair_.target, pair_.camera))
        .measure(points)
        .residual_mean;
  }

  Device device_;
  FramePair pair_;
};

/// Greatest change of the distance between two points, of all pairs with the first and the last one.
double greatest_stretch(const RegistrationResult& result) {
  double greatest = 0;
  for (const std::size_t anchor : {std::size_t{0}, result.points.size() - 1})
    for (std::size_t i = 0; i < result.points.size(); ++i) {
      const float before = (result.aligned_points[i] - result.aligned_points[anchor]).norm();
      const float after = (result.points[i] - result.points[anchor]).norm();
      greatest = std::max(greatest, static_cast<double>(std::abs(after - before)));
    }
  return greatest;
}

TEST_F(ScheduledRegistration, MovesAsAWholeFirstAndBendsInTheEnd) {
  const RegistrationResult stiff = register_sheet(2);
  EXPECT_EQ(stiff.counts.outer_iterations, 2);
  EXPECT_LT(greatest_stretch(stiff), 0.5);

  const RegistrationResult relaxed = register_sheet(12);
  EXPECT_EQ(relaxed.counts.outer_iterations, 12);
  EXPECT_GT(greatest_stretch(relaxed), 2);
  EXPECT_LT(residual(relaxed, relaxed.points), 0.3 * residual(stiff, stiff.points));
}

TEST_F(ScheduledRegistration, NoProgressEndsNothingBeforeTheScheduleDoes) {
  const Parameters values =
      plan("", {"schedule.iterations=5", "stopping={min_progress: 1, max_iterations: 100}"}).runs[0].values;
  const RegistrationResult result =
      register_pair(workbench_.pair(values), make_method(values, registry_), device_, 1);
  EXPECT_EQ(result.termination, "no_progress");
  EXPECT_EQ(result.counts.outer_iterations, 6);
}

// The weights are others in each iteration, so that one whose energy is too large for a float may be followed
// by good ones.
TEST_F(ScheduledRegistration, ASolveThatFailsEndsTheLoopAtOnce) {
  const Parameters values = plan("", {"schedule.iterations=4", "energies.constraint.initial_weight=1e39",
                                      "stopping={min_progress: 0, max_iterations: 8}"})
                                .runs[0]
                                .values;
  const RegistrationResult result =
      register_pair(workbench_.pair(values), make_method(values, registry_), device_, 1);
  EXPECT_EQ(result.termination, "failed");
  EXPECT_NE(result.reason, "");
  EXPECT_EQ(result.counts.outer_iterations, 0);
  EXPECT_EQ(result.history.size(), 1U);
  EXPECT_EQ(result.returned_iteration, 0);
  EXPECT_EQ(result.points, result.aligned_points);
}

}  // namespace
}  // namespace pliant::test
