#include <gmock/gmock.h>

#include "framework/registration/method.h"
#include "framework/registration/metrics.h"
#include "framework/registration/registration.h"
#include "tests/experiments/experiment_files.h"

// A stiff and tolerant start that is relaxed stage by stage.
namespace pliant::testing {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

std::vector<Energy> over_stages(const Relaxation& relaxation, const Energy& energy) {
  std::vector<Energy> stages;
  for (int stage = 0; stage < relaxation.stages; ++stage) stages.push_back(relaxation.relaxed(energy, stage));
  return stages;
}

template <class Value>
std::vector<double> each(const std::vector<Energy>& energies, Value value) {
  std::vector<double> values;
  for (const Energy& energy : energies) values.push_back(value(energy));
  return values;
}

Energy made_of(Stencil stencil) {
  Energy energy;
  energy.stencil = stencil;
  energy.weight = 5;
  energy.loss = {"welsch", 10};
  return energy;
}

double weight(const Energy& energy) { return energy.weight; }
double loss_scale(const Energy& energy) { return energy.loss.scale; }

const Relaxation three_stages{.stages = 3, .stiffness = 100, .loss_scale = 4};

TEST(Relaxation, StiffnessFallsGeometricallyToTheWeightItself) {
  for (const Stencil stencil : {Stencil::per_node, Stencil::per_edge}) {
    const auto stages = over_stages(three_stages, made_of(stencil));
    EXPECT_THAT(each(stages, weight), ElementsAre(DoubleNear(500, 1e-9), DoubleNear(50, 1e-9), 5));
  }
}

TEST(Relaxation, ConstraintsKeepTheirWeightAndBecomeLessTolerant) {
  const auto stages = over_stages(three_stages, made_of(Stencil::per_constraint));
  EXPECT_THAT(each(stages, weight), ElementsAre(5, 5, 5));
  EXPECT_THAT(each(stages, loss_scale), ElementsAre(DoubleNear(40, 1e-9), DoubleNear(20, 1e-9), 10));
}

TEST(Relaxation, OneStageChangesNothing) {
  const Relaxation none{.stages = 1, .stiffness = 100, .loss_scale = 4};
  EXPECT_EQ(none.relaxed(made_of(Stencil::per_edge), 0).weight, 5);
}

class RelaxedRegistration : public ExperimentFiles {
 protected:
  /// Registers the small sheet with two stages, the first of which is as good as rigid.
  RegistrationResult register_sheet(int max_iterations) {
    const Parameters values =
        plan("", {"relaxation={stages: 2, stiffness: 1e6, iterations: 4}", "energies.rotation.weight=1000",
                  "stopping={min_progress: 0, max_iterations: " + std::to_string(max_iterations) + "}"})
            .runs[0]
            .values;
    pair_ = workbench_.pair(values);
    return register_pair(pair_, make_method(values, registry_), device_, 1);
  }

  double residual(const RegistrationResult& result, const std::vector<Eigen::Vector3f>& points) const {
    return Evaluation(pair_, result.source, make_surface_map(pair_.target, pair_.camera))
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

TEST_F(RelaxedRegistration, MovesAsAWholeFirstAndBendsOnceRelaxed) {
  const RegistrationResult stiff = register_sheet(4);
  EXPECT_EQ(stiff.counts.outer_iterations, 4);
  EXPECT_LT(greatest_stretch(stiff), 0.5);

  const RegistrationResult relaxed = register_sheet(12);
  EXPECT_EQ(relaxed.counts.outer_iterations, 12);
  EXPECT_GT(greatest_stretch(relaxed), 2);
  EXPECT_LT(residual(relaxed, relaxed.points), 0.3 * residual(stiff, stiff.points));
}

TEST_F(RelaxedRegistration, NoProgressEndsAStageAndNotTheRegistration) {
  const Parameters values =
      plan("", {"relaxation={stages: 3, iterations: 50}", "stopping={min_progress: 1, max_iterations: 100}"})
          .runs[0]
          .values;
  const RegistrationResult result =
      register_pair(workbench_.pair(values), make_method(values, registry_), device_, 1);
  EXPECT_EQ(result.termination, "no_progress");
  EXPECT_EQ(result.counts.outer_iterations, 3);
}

}  // namespace
}  // namespace pliant::testing
