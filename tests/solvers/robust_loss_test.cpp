#include <gmock/gmock.h>

#include <random>

#include "framework/deformation/warp.h"
#include "tests/problem/components.h"
#include "tests/solvers/solve.h"

// Sheets a tenth of whose matches are wrong: every solver ends at the same minimum of a robust energy, and
// that lies nearer to the truth than the one of the squares.
namespace pliant::test {
namespace {

struct Outliers {
  std::shared_ptr<Constraints> constraints;
  std::vector<float> truth;  ///< q - p as it was before matches were spoilt
};

/// Every tenth match is carried off by 60 to 200 mm in any direction; it may name any normal.
Outliers spoil(const Constraints& clean) {
  Outliers outliers{std::make_shared<Constraints>(copy_of(clean)), {}};
  for (std::size_t i = 0; i < clean.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) outliers.truth.push_back(clean.data.host()[6 * i + axis]);
  std::mt19937 random(9);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> length(60, 200);
  auto& data = outliers.constraints->data.write_host();
  for (std::size_t i = 0; i < clean.size(); i += 10) {
    const auto direction = [&] {
      return Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized();
    };
    Eigen::Map<Eigen::Vector3f>(data.data() + 6 * i) += length(random) * direction();
    Eigen::Map<Eigen::Vector3f>(data.data() + 6 * i + 3) = direction();
  }
  return outliers;
}

class RobustLoss : public SolverTest, public testing::WithParamInterface<std::string> {
 protected:
  RobustLoss() : outliers_(spoil(*make_sheet_constraints(sheet_, graph_))) {}

  std::vector<Energy> energies(const std::string& loss) const {
    const std::string robust = ", loss: " + loss + ", loss_scale: 10}";
    std::vector<Energy> made;
    for (const auto& yaml :
         {std::string("{type: rotation}"), std::string("{type: regularization}"),
          "{type: constraint, weight: 30" + robust, "{type: point_to_plane, weight: 100" + robust})
      made.push_back(*make<Energy>(registry_, yaml));
    return made;
  }

  Problem problem(const std::string& loss) const {
    return {graph_, make_terms(energies(loss), outliers_.constraints)};
  }

  /// Unknowns near the truth: those of the clean sheet bent by nine tenths.
  Array<float> near_start() {
    auto clean = std::make_shared<Constraints>(copy_of(*outliers_.constraints));
    auto& data = clean->data.write_host();
    for (std::size_t i = 0; i < clean->size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) data[6 * i + axis] = 0.9F * outliers_.truth[3 * i + axis];
    auto energies = this->energies("none");
    energies.pop_back();
    Problem problem(graph_, make_terms(energies, clean));
    solve(problem, "{type: ceres_lm}");
    return problem.unknowns().clone();
  }

  /// Mean distance, mm, between where points go and where they should.
  double error(const Problem& problem) const {
    const auto& points = outliers_.constraints->points;
    const PointSet rest{points.clone(), Array<float>(std::vector<float>(points.size(), 0))};
    const auto moved =
        warp_reference(rest, outliers_.constraints->influences, problem.node_points(), problem.unknowns());
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); i += 3) {
      Eigen::Vector3d miss;
      for (std::size_t axis = 0; axis < 3; ++axis)
        miss[static_cast<int>(axis)] =
            moved.points.host()[i + axis] - points.host()[i + axis] - outliers_.truth[i + axis];
      sum += miss.norm();
    }
    return sum / (static_cast<double>(points.size()) / 3);
  }

  Sheet sheet_{.nodes = 36, .constraints = 600};
  DeformationGraph graph_ = make_sheet_graph(sheet_);
  Outliers outliers_;
};

std::vector<std::string> device_solvers(const Registry& registry) {
  std::vector<std::string> all;
  for (const auto* info : registry.components("linear_solver"))
    all.push_back("{type: gauss_newton, max_iterations: 200, tolerance: 1e-8, linear_solver: " + info->name +
                  "}");
  return all;
}

TEST_P(RobustLoss, EverySolverEndsAtTheMinimumOfCeres) {
  const auto start = near_start();
  auto reference = problem(GetParam());
  reference.unknowns() = start.clone();
  const double before = reference.energy();
  EXPECT_EQ(solve(reference, "{type: ceres_lm, tolerance: 1e-12, max_iterations: 500}").termination,
            "converged");
  const double minimum = reference.energy();
  EXPECT_LT(minimum, before);
  const auto solvers = device_solvers(registry_);
  EXPECT_THAT(solvers, testing::SizeIs(testing::Ge(3)));
  for (const auto& yaml : solvers) {
    SCOPED_TRACE(yaml);
    auto own = problem(GetParam());
    own.unknowns() = start.clone();
    const auto summary = solve(own, yaml);
    EXPECT_EQ(summary.termination, "converged");
    EXPECT_NEAR(own.energy(), minimum, 1e-4 * minimum);
    EXPECT_NEAR(summary.final_energy, own.energy(), 1e-4 * own.energy());
    EXPECT_NEAR(error(own), error(reference), 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(Losses, RobustLoss, testing::ValuesIn(loss_names()));

using OutlierTest = RobustLoss;

TEST_P(OutlierTest, PullsLessThanTheSquare) {
  const auto start = near_start();
  const auto solver = device_solvers(registry_).front();
  auto square = problem("none");
  auto robust = problem(GetParam());
  square.unknowns() = start.clone();
  robust.unknowns() = start.clone();
  solve(square, solver);
  solve(robust, solver);
  EXPECT_GT(error(square), 5);
  EXPECT_LT(error(robust), (GetParam() == "huber" ? 0.5 : 0.2) * error(square));
}

INSTANTIATE_TEST_SUITE_P(Robust, OutlierTest, testing::Values("huber", "tukey", "welsch"));

}  // namespace
}  // namespace pliant::test
