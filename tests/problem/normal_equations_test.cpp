#include "framework/problem/normal_equations.h"

#include <gmock/gmock.h>

#include <limits>

#include "energies/energies.h"
#include "framework/deformation/warp.h"
#include "tests/problem/components.h"
#include "tests/problem/dense_normals.h"
#include "tests/problem/sheet_problem.h"

namespace pliant::test {
namespace {

class NormalEquationsTest : public testing::Test {
 protected:
  NormalEquationsTest() {
    register_energies(registry_);
    energies_ = all_energies(registry_);
  }

  void expect_same_as_reference(Problem& problem) {
    NormalEquations equations(device_, problem);
    const auto expected = dense_normals(problem);
    const auto found = device_normals(equations);
    // Single precision, relative to what each unknown and pair of unknowns can amount to.
    const Eigen::VectorXd size = expected.matrix.diagonal().cwiseSqrt();
    const double energy = problem.energy();
    for (Eigen::Index row = 0; row < size.size(); ++row) {
      EXPECT_NEAR(found.gradient[row], expected.gradient[row], 1e-5 * size[row] * std::sqrt(energy) + 1e-30)
          << "gradient, unknown " << row;
      for (Eigen::Index column = 0; column < size.size(); ++column)
        ASSERT_NEAR(found.matrix(row, column), expected.matrix(row, column),
                    1e-5 * size[row] * size[column] + 1e-30)
            << "matrix, unknowns " << row << " and " << column;
    }
    EXPECT_NEAR(device_energy(equations, problem), energy, 1e-5 * energy);
  }

  Registry registry_;
  std::vector<Energy> energies_;
  Device device_;
};

TEST_F(NormalEquationsTest, AreThoseOfTheReferenceOnRandomProblems) {
  for (const Sheet& sheet : {Sheet{.nodes = 1, .constraints = 3}, Sheet{.nodes = 2, .constraints = 70},
                             Sheet{.nodes = 5, .constraints = 1, .per_point = 2},
                             Sheet{.nodes = 17, .constraints = 130, .per_point = 8},
                             Sheet{.nodes = 33, .constraints = 257, .seed = 3},
                             Sheet{.nodes = 20, .constraints = 200, .length_unit = 1000, .seed = 4}}) {
    SCOPED_TRACE(testing::Message() << sheet.nodes << " nodes, " << sheet.constraints << " constraints");
    auto problem = make_sheet_problem(sheet, energies_);
    expect_same_as_reference(problem);
    randomise_unknowns(problem, 0.3, 20, sheet.seed);
    expect_same_as_reference(problem);
  }
}

TEST_F(NormalEquationsTest, FollowTheStepsOfRigidNodes) {
  const auto quaternion = quaternion_transform();
  auto problem =
      make_sheet_problem({.nodes = 23, .constraints = 180, .seed = 5, .transform = quaternion}, energies_);
  turn_nodes(problem, 1.5, 20, 5);
  NormalEquations equations(device_, problem);
  ASSERT_EQ(equations.stride(), 8);
  const auto expected = dense_normals(problem);
  const auto found = device_normals(equations);
  const Eigen::VectorXd size = expected.matrix.diagonal().cwiseSqrt();
  const double root = std::sqrt(problem.energy());
  for (int row = 0; row < 8 * 23; ++row) {
    const bool is_padding = row % 8 >= 6;
    const int i = row / 8 * 6 + row % 8;
    if (is_padding)
      EXPECT_EQ(found.gradient[row], 0);
    else
      EXPECT_NEAR(found.gradient[row], expected.gradient[i], 1e-5 * size[i] * root) << row;
    for (int column = 0; column < 8 * 23; ++column) {
      const int j = column / 8 * 6 + column % 8;
      if (is_padding || column % 8 >= 6)
        ASSERT_EQ(found.matrix(row, column), 0) << row << " " << column;
      else
        ASSERT_NEAR(found.matrix(row, column), expected.matrix(i, j), 1e-5 * size[i] * size[j])
            << row << " " << column;
    }
  }
}

TEST_F(NormalEquationsTest, SeveralTermsOfAStencilAddUp) {
  const Sheet sheet{.nodes = 12, .constraints = 90};
  auto graph = make_sheet_graph(sheet);
  auto terms = make_terms(energies_, make_sheet_constraints(sheet, graph));
  for (auto& term : make_terms(energies_, make_handles(sheet, graph))) {
    term.energy.weight *= 0.37;
    terms.push_back(term);
  }
  Problem problem(std::move(graph), std::move(terms));
  randomise_unknowns(problem, 0.2, 10, 1);
  expect_same_as_reference(problem);
}

TEST_F(NormalEquationsTest, ConstraintsOutOfForceCountForNothingWhateverTheirData) {
  const Sheet sheet{.nodes = 10, .constraints = 200};
  auto problem = make_sheet_problem(sheet, energies_);
  randomise_unknowns(problem, 0.1, 5, 2);
  for (const auto& term : problem.terms()) {
    if (!term.constraints) continue;
    auto& confidence = term.constraints->confidence.write_host();
    auto& data = term.constraints->data.write_host();
    for (std::size_t i = 0; i < confidence.size(); ++i) {
      confidence[i] = static_cast<float>(i % 3) * 0.4F;
      if (i % 3 == 0)
        data[6 * i + i % 6] =
            i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
    }
  }
  expect_same_as_reference(problem);
}

TEST_F(NormalEquationsTest, TakeNewTargetsBetweenAssemblies) {
  const Sheet sheet{.nodes = 8, .constraints = 50};
  auto graph = make_sheet_graph(sheet);
  const auto constraints = make_sheet_constraints(sheet, graph);
  Problem problem(graph, make_terms(energies_, constraints));
  NormalEquations equations(device_, problem);
  const auto before = device_normals(equations);
  auto& data = constraints->data.write_host();
  for (std::size_t i = 0; i < data.size(); ++i)
    data[i] *= i % 6 < 3 ? 2 : 1;  // the targets, not their normals
  const auto after = device_normals(equations);
  EXPECT_TRUE(after.matrix.isApprox(before.matrix, 1e-6)) << "the matrix does not know the targets";
  EXPECT_TRUE(after.gradient.isApprox(dense_normals(problem).gradient, 1e-5));
}

TEST_F(NormalEquationsTest, AreClearedWhereNothingReaches) {
  const auto graph = make_sheet_graph({.nodes = 4});
  Problem problem(graph, {});
  NormalEquations equations(device_, problem);
  const auto normals = device_normals(equations);
  EXPECT_TRUE(normals.matrix.isZero(0));
  EXPECT_TRUE(normals.gradient.isZero(0));
  EXPECT_EQ(device_energy(equations, problem), 0);
}

TEST_F(NormalEquationsTest, BlocksAreTheLowerTriangleSortedWithEveryDiagonal) {
  auto problem = make_sheet_problem({.nodes = 30, .constraints = 10}, energies_);
  NormalEquations equations(device_, problem);
  const auto& rows = equations.block_rows().host();
  const auto& columns = equations.block_columns().host();
  int diagonals = 0;
  for (std::size_t pair = 0; pair < rows.size(); ++pair) {
    EXPECT_GE(rows[pair], columns[pair]);
    if (pair > 0) {
      EXPECT_LT(std::pair(rows[pair - 1], columns[pair - 1]), std::pair(rows[pair], columns[pair]));
    }
    if (rows[pair] == columns[pair]) ++diagonals;
  }
  EXPECT_EQ(diagonals, 30);
}

TEST_F(NormalEquationsTest, DoNothingOnceTheSolveHasEnded) {
  auto problem = make_sheet_problem({.nodes = 5, .constraints = 20}, energies_);
  NormalEquations equations(device_, problem);
  const auto before = device_normals(equations);
  randomise_unknowns(problem, 0.3, 20, 1);
  const auto status = make_status(device_);
  const cl_int ended = 1;
  device_.write(status, &ended, sizeof(ended));
  equations.assemble(status);
  std::vector<float> gradient(static_cast<std::size_t>(problem.unknown_count()));
  device_.read(equations.gradient(), gradient.data(), sizeof(float) * gradient.size());
  for (std::size_t i = 0; i < gradient.size(); ++i)
    EXPECT_EQ(gradient[i], before.gradient[static_cast<Eigen::Index>(i)]);
}

TEST_F(NormalEquationsTest, TheSameBitsEveryTime) {
  auto problem = make_sheet_problem({.nodes = 40, .constraints = 500}, energies_);
  randomise_unknowns(problem, 0.3, 20, 1);
  NormalEquations first(device_, problem), second(device_, problem);
  const auto a = device_normals(first), b = device_normals(second);
  EXPECT_EQ(a.matrix, b.matrix);
  EXPECT_EQ(a.gradient, b.gradient);
}

}  // namespace
}  // namespace pliant::test
