#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <functional>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "tests/problem/components.h"
#include "tests/solvers/solve.h"
#include "tests/solvers_pcg/test_energies/test_energies.h"

// Problems whose nodes are rigid (transform `quaternion`): every solver that takes them ends at the same
// minimum, among rotations.
namespace pliant::test {
namespace {

using MakeProblem = std::function<Problem()>;

constexpr const char* ceres = "{type: ceres_lm, tolerance: 1e-12, max_iterations: 300}";

class RigidNodes : public SolverTest {
 protected:
  /// Those that serve: all but `structured`.
  std::vector<std::string> linear_solvers() const {
    std::vector<std::string> names;
    for (const auto* info : registry_.components("linear_solver"))
      if (info->name != "structured") names.push_back(info->name);
    return names;
  }
  static std::string with(const std::string& linear_solver, const std::string& tolerance = "1e-7") {
    return "{type: gauss_newton, max_iterations: 100, tolerance: " + tolerance +
           ", linear_solver: " + linear_solver + "}";
  }

  Problem rigid(Sheet sheet, std::vector<Energy> more = {}) const {
    sheet.transform = quaternion_transform();
    auto energies = energies_;
    energies.insert(energies.end(), more.begin(), more.end());
    return make_sheet_problem(sheet, energies);
  }

  static void expect_rotations(const Problem& problem) {
    EXPECT_LT(distance_from_rotations(problem.unknowns().host()), 2e-6);
  }

  void expect_same_minimum(const MakeProblem& make) {
    auto reference = make();
    solve(reference, ceres);
    expect_rotations(reference);
    const double minimum = reference.energy();
    for (const auto& name : linear_solvers()) {
      SCOPED_TRACE(name);
      auto own = make();
      const auto summary = solve(own, with(name));
      EXPECT_EQ(summary.termination, "converged");
      EXPECT_NEAR(own.energy(), minimum, 1e-5 * minimum);
      EXPECT_NEAR(summary.final_energy, own.energy(), 1e-5 * own.energy());
      expect_rotations(own);
    }
  }
};

TEST_F(RigidNodes, HaveSixUnknownsEach) {
  EXPECT_EQ(rigid({.nodes = 7}).unknown_count(), 42);
  EXPECT_EQ(rigid({.nodes = 7}).unknowns().size(), 84U) << "affine forms all the same";
}

TEST_F(RigidNodes, BendSheets) {
  expect_same_minimum([&] { return rigid({.nodes = 60, .constraints = 900}); });
  expect_same_minimum([&] { return rigid({.nodes = 17, .constraints = 150, .bend = 60, .seed = 2}); });
  expect_same_minimum([&] {
    return rigid({.nodes = 40, .constraints = 300, .per_point = 6, .length_unit = 1000, .seed = 3});
  });
}

TEST_F(RigidNodes, BendBetweenHandles) {
  for (const auto& sheet :
       {Sheet{.nodes = 49, .bend = 60, .seed = 6}, Sheet{.nodes = 120, .bend = 10, .seed = 6}})
    expect_same_minimum([&] {
      auto graph = make_sheet_graph(sheet);
      auto terms = make_terms(energies_, make_handles(sheet, graph));
      return Problem(std::move(graph), std::move(terms), 1, quaternion_transform());
    });
}

TEST_F(RigidNodes, TakeTermsThatCoupleTheAxes) {
  expect_same_minimum([&] {
    return rigid({.nodes = 30, .constraints = 400, .seed = 5}, {to_plane(), moves_as_far()});
  });
  expect_same_minimum([&] { return rigid({.nodes = 25, .constraints = 300}, {keeps_length()}); });
}

TEST_F(RigidNodes, TakeRobustLosses) {
  for (const auto& loss : loss_names()) {
    SCOPED_TRACE(loss);
    expect_same_minimum([&] {
      auto energies = energies_;
      for (auto& energy : energies)
        if (energy.stencil == Stencil::per_constraint) energy.loss = {loss, 40};
      return make_sheet_problem(
          {.nodes = 30, .constraints = 400, .bend = 10, .transform = quaternion_transform()}, energies);
    });
  }
}

// The minimum among rotations lies above the one among all forms, where E_rot only asks for them.
TEST_F(RigidNodes, LeaveNothingToTheRotationEnergy) {
  const Sheet sheet{.nodes = 30, .constraints = 400};
  auto energies = energies_;
  for (auto& energy : energies)
    if (energy.equation.name == "rotation") energy.weight = 1e6;
  auto heavy =
      make_sheet_problem({.nodes = 30, .constraints = 400, .transform = quaternion_transform()}, energies);
  auto plain = rigid(sheet);
  auto affine = sheet_problem(sheet);
  solve(heavy, with("block_pcg"));
  solve(plain, with("block_pcg"));
  solve(affine, with("block_pcg"));
  EXPECT_NEAR(heavy.energy(), plain.energy(), 1e-4 * plain.energy());
  EXPECT_GT(plain.energy(), affine.energy());
}

TEST_F(RigidNodes, StartFromWhereTheProblemStands) {
  expect_same_minimum([&] {
    auto problem = rigid({.nodes = 20, .constraints = 300, .seed = 4});
    turn_nodes(problem, 0.2, 10, 3);
    return problem;
  });
}

// Blends of rotations, as a graph's change leaves them, are none.
TEST_F(RigidNodes, StartFromTheNearestRotations) {
  const auto quaternion = quaternion_transform();
  const auto make = [&] {
    auto problem = rigid({.nodes = 20, .constraints = 300, .seed = 4});
    randomise_unknowns(problem, 0.1, 10, 3);
    return problem;
  };
  auto projected = make();
  const std::vector<float> given = projected.unknowns().host();
  ASSERT_GT(distance_from_rotations(given), 0.1);
  std::vector<double> nearest(given.size());
  const std::vector<double> forms(given.begin(), given.end());
  for (std::size_t at = 0; at < forms.size(); at += affine_size)
    quaternion.nearest(forms.data() + at, nearest.data() + at);
  const double start = projected.energy(nearest);
  for (const auto& solver : {std::string(ceres), with("dense_cholesky"), with("block_pcg")}) {
    auto problem = make();
    EXPECT_NEAR(solve(problem, solver).initial_energy, start, 1e-5 * start) << solver;
  }
  expect_same_minimum(make);
}

TEST_F(RigidNodes, NeverRaiseTheEnergyNorReturnNaN) {
  for (const auto& name : linear_solvers())
    for (const unsigned seed : {1U, 2U, 3U}) {
      SCOPED_TRACE(testing::Message() << name << ", seed " << seed);
      auto problem = rigid({.nodes = 15, .constraints = 60, .seed = seed}, {to_plane()});
      randomise_unknowns(problem, 1.5, 100, seed);
      const auto summary = solve(problem, with(name));
      double last = summary.initial_energy * (1 + 1e-5);
      for (const double energy : summary.energies) {
        EXPECT_LE(energy, last);
        last = energy;
      }
      EXPECT_LT(problem.energy(), 0.1 * summary.initial_energy);
      expect_rotations(problem);
    }
}

TEST_F(RigidNodes, StayWhereNothingTouchesThem) {
  const Sheet sheet{.nodes = 20, .constraints = 120};
  for (const auto& name : linear_solvers()) {
    SCOPED_TRACE(name);
    auto graph = make_sheet_graph(sheet);
    const auto constraints = make_sheet_constraints(sheet, graph);
    graph.nodes.emplace_back(700, 700, 800);
    Problem problem(graph, make_terms(energies_, constraints), 1, quaternion_transform());
    const auto summary = solve(problem, with(name));
    EXPECT_LT(problem.energy(), 0.5 * summary.initial_energy);
    const auto& unknowns = problem.unknowns().host();
    EXPECT_THAT(std::vector<float>(unknowns.end() - affine_size, unknowns.end()), testing::Each(0));
  }
}

// Points on a line through the only node leave the turn about it free.
TEST_F(RigidNodes, AreSolvedForWhereATurnIsFree) {
  for (const auto& name : linear_solvers())
    for (const Eigen::Vector3f& along :
         {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0.6F, 0.8F, 0), Eigen::Vector3f(0.48F, 0.6F, 0.64F)}) {
      SCOPED_TRACE(testing::Message() << name << ", along " << along.transpose());
      const Sheet sheet{.nodes = 1, .constraints = 9};
      auto graph = make_sheet_graph(sheet);
      const auto constraints = make_sheet_constraints(sheet, graph);
      const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.7F, Eigen::Vector3f(2, 1, 2) / 3).toRotationMatrix();
      for (int i = 0; i < 9; ++i) {
        const Eigen::Vector3f arm = static_cast<float>(10 * i - 35) * along;
        Eigen::Map<Eigen::Vector3f>(constraints->points.write_host().data() + 3 * i) = graph.nodes[0] + arm;
        Eigen::Map<Eigen::Vector3f>(constraints->data.write_host().data() + 6 * i) = turn * arm - arm;
      }
      Problem problem(graph, make_terms(energies_, constraints), 1, quaternion_transform());
      const auto summary = solve(problem, with(name));
      EXPECT_LT(problem.energy(), 1e-6 * summary.initial_energy);
      expect_rotations(problem);
    }
}

TEST_F(RigidNodes, GiveTheSameBitsEveryTime) {
  for (const auto& name : linear_solvers()) {
    const auto solution = [&] {
      auto problem = rigid({.nodes = 40, .constraints = 500}, {to_plane()});
      const auto summary = solve(problem, with(name));
      return std::pair(problem.unknowns().host(), summary.energies);
    };
    EXPECT_EQ(solution(), solution()) << name;
  }
}

TEST_F(RigidNodes, AreRefusedByTheStructuredSolverAndTheAutomaticOneSaysWhy) {
  auto problem = rigid({.nodes = 9, .constraints = 50});
  try {
    solve(problem, with("structured"));
    ADD_FAILURE() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(), "linear solver structured: transform quaternion couples the axes of a node");
  }
  EXPECT_EQ(solve(problem, "{type: gauss_newton}").linear_solver,
            "block_pcg: transform quaternion couples the axes of a node");
}

TEST_F(RigidNodes, ThatStandNowhereFail) {
  for (const auto& name : linear_solvers()) {
    auto problem = rigid({.nodes = 9, .constraints = 50});
    problem.unknowns().write_host()[5] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(solve(problem, with(name)).termination, "failed") << name;
  }
}

}  // namespace
}  // namespace pliant::test
