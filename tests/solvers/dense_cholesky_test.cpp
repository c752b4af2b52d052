#include <gmock/gmock.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <random>

#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "solvers/gauss_newton/dense_cholesky.h"
#include "solvers/gauss_newton/stepwise.h"
#include "tests/problem/components.h"
#include "tests/problem/dense_normals.h"
#include "tests/solvers/solve.h"

namespace pliant::test {
namespace {

/// Systems of random numbers in the blocks of a problem's normal equations.
class DenseCholesky : public SolverTest {
 protected:
  /// `neighbours`: how many nodes on either side a node is coupled with.
  Problem banded_problem(int nodes, int neighbours) const {
    DeformationGraph graph{std::vector<Eigen::Vector3f>(static_cast<std::size_t>(nodes)), {}};
    for (int from = 0; from < nodes; ++from)
      for (int to = std::max(0, from - neighbours); to < std::min(nodes, from + neighbours + 1); ++to)
        if (from != to) graph.edges.push_back({from, to});
    return Problem(std::move(graph),
                   make_terms({*make<Energy>(registry_, "{type: regularization}")}, nullptr));
  }

  /// Replaces the assembled system; what lies outside the blocks of `equations` is dropped from `normals`.
  void put(NormalEquations& equations, DenseNormals& normals) const {
    std::vector<float> blocks;
    const Eigen::MatrixXd whole = normals.matrix;
    normals.matrix.setZero();
    for (std::size_t pair = 0; pair < equations.block_rows().size(); ++pair) {
      const int row = affine_size * equations.block_rows().host()[pair];
      const int column = affine_size * equations.block_columns().host()[pair];
      const Eigen::Matrix<float, affine_size, affine_size, Eigen::RowMajor> block =
          whole.block(row, column, affine_size, affine_size).cast<float>();
      normals.matrix.block(row, column, affine_size, affine_size) = block.cast<double>();
      normals.matrix.block(column, row, affine_size, affine_size) = block.cast<double>().transpose();
      blocks.insert(blocks.end(), block.data(), block.data() + block.size());
    }
    const Eigen::VectorXf gradient = normals.gradient.cast<float>();
    equations.device().write(equations.blocks(), blocks.data(), sizeof(float) * blocks.size());
    equations.device().write(equations.gradient(), gradient.data(),
                             sizeof(float) * static_cast<std::size_t>(gradient.size()));
  }

  struct Solution {
    Eigen::VectorXd step;
    bool bad_pivot;
  };
  Solution solve_system(NormalEquations& equations, float damping = 0) {
    const auto bound = make_dense_cholesky_steps(equations);
    const auto status = make_status(device_);
    std::vector<cl_int> words(16);
    words[status_damping] = std::bit_cast<cl_int>(damping);
    device_.write(status, words.data(), sizeof(cl_int) * words.size());
    bound->solve(status);
    device_.read(status, words.data(), sizeof(cl_int) * words.size());
    Eigen::VectorXf step(affine_size * equations.node_count());
    device_.read(bound->step(), step.data(), sizeof(float) * static_cast<std::size_t>(step.size()));
    return {step.cast<double>(), words[status_bad_pivot] != 0};
  }

  static DenseNormals random_system(int size, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const auto random = [&] { return normal(generator); };
    const Eigen::MatrixXd half = Eigen::MatrixXd::NullaryExpr(size, size, random);
    const Eigen::VectorXd gradient = Eigen::VectorXd::NullaryExpr(size, random);
    return {half * half.transpose() / size + 0.5 * Eigen::MatrixXd::Identity(size, size), gradient};
  }
};

TEST_F(DenseCholesky, SolvesWhatEigenSolves) {
  for (const int nodes : {1, 2, 5, 6, 10, 11, 16, 17, 64, 100}) {
    SCOPED_TRACE(testing::Message() << nodes << " nodes");
    auto problem = banded_problem(nodes, nodes);
    NormalEquations equations(device_, problem);
    for (const float damping : {0.0F, 0.5F}) {
      auto system = random_system(affine_size * nodes, static_cast<unsigned>(nodes));
      put(equations, system);
      system.matrix.diagonal() *= 1 + damping;
      const Eigen::VectorXd expected = system.matrix.llt().solve(-system.gradient);
      const auto found = solve_system(equations, damping);
      EXPECT_FALSE(found.bad_pivot);
      EXPECT_LT((found.step - expected).norm(), 2e-5 * expected.norm());
    }
  }
}

TEST_F(DenseCholesky, FillsInBlocksThatAreNotThere) {
  for (const int nodes : {7, 23, 60}) {
    auto problem = banded_problem(nodes, 2);
    NormalEquations equations(device_, problem);
    auto system = random_system(affine_size * nodes, 5);
    system.matrix += 4 * Eigen::MatrixXd::Identity(affine_size * nodes, affine_size * nodes);
    put(equations, system);
    const Eigen::VectorXd expected = system.matrix.llt().solve(-system.gradient);
    EXPECT_LT((solve_system(equations).step - expected).norm(), 2e-5 * expected.norm()) << nodes << " nodes";
  }
}

TEST_F(DenseCholesky, SolvesIllConditionedSystemsToTheirResidual) {
  const int nodes = 20, size = affine_size * nodes;
  auto problem = banded_problem(nodes, nodes);
  NormalEquations equations(device_, problem);
  auto system = random_system(size, 9);
  const Eigen::VectorXd scale =
      Eigen::VectorXd::LinSpaced(size, -3, 3).unaryExpr([](double x) { return std::pow(10, x); });
  system.matrix = scale.asDiagonal() * system.matrix * scale.asDiagonal();
  system.gradient = scale.asDiagonal() * system.gradient;
  put(equations, system);
  const auto found = solve_system(equations);
  ASSERT_FALSE(found.bad_pivot);
  const Eigen::VectorXd residual =
      scale.asDiagonal().inverse() * (system.matrix * found.step + system.gradient);
  EXPECT_LT(residual.norm(), 1e-4 * (scale.asDiagonal().inverse() * system.gradient).norm());
}

TEST_F(DenseCholesky, SaysWhenThereIsNoFactor) {
  for (const int bad : {0, 63, 64, 119}) {
    auto problem = banded_problem(10, 10);
    NormalEquations equations(device_, problem);
    auto system = random_system(120, 3);
    system.matrix(bad, bad) = -1;
    put(equations, system);
    EXPECT_TRUE(solve_system(equations).bad_pivot) << "negative pivot at " << bad;
    system.matrix(bad, bad) = std::numeric_limits<double>::quiet_NaN();
    put(equations, system);
    EXPECT_TRUE(solve_system(equations).bad_pivot) << "NaN at " << bad;
  }
}

TEST_F(DenseCholesky, AnUnknownThatNothingTouchesStays) {
  auto problem = banded_problem(10, 10);
  NormalEquations equations(device_, problem);
  auto system = random_system(120, 3);
  for (const int untouched : {5, 70}) {
    system.matrix.row(untouched).setZero();
    system.matrix.col(untouched).setZero();
    system.gradient[untouched] = 0;
  }
  put(equations, system);
  const auto found = solve_system(equations);
  EXPECT_FALSE(found.bad_pivot);
  EXPECT_EQ(found.step[5], 0);
  EXPECT_EQ(found.step[70], 0);
  EXPECT_LT((system.matrix * found.step + system.gradient).norm(), 1e-4 * system.gradient.norm());
}

TEST_F(DenseCholesky, TheSameBitsEveryTime) {
  auto problem = banded_problem(30, 30);
  NormalEquations equations(device_, problem);
  auto system = random_system(360, 3);
  put(equations, system);
  EXPECT_EQ(solve_system(equations).step, solve_system(equations).step);
}

/// Counts the systems that another one is asked for.
class Counted : public StepSolver {
 public:
  Counted(std::unique_ptr<StepSolver> steps, int& count) : steps_(std::move(steps)), count_(count) {}
  void solve(const Buffer& status) override {
    ++count_;
    steps_->solve(status);
  }
  const Buffer& step() const override { return steps_->step(); }

 private:
  std::unique_ptr<StepSolver> steps_;
  int& count_;
};

TEST_F(SolverTest, AStepwiseMinimiserLaunchesNothingOnceItHasEnded) {
  auto problem = sheet_problem({.nodes = 9, .constraints = 60});
  int systems = 0;
  const auto minimiser = make_stepwise_minimiser(
      problem, device_, {.max_iterations = most_iterations, .tolerance = 1e-6F, .damping = 1e-6F}, "counted",
      [&](NormalEquations& equations) {
        return std::make_unique<Counted>(make_dense_cholesky_steps(equations), systems);
      });
  std::vector<cl_int> words(status_words);
  const auto status = device_.upload(words);
  minimiser->enqueue(status);
  device_.read(status, words.data(), sizeof(cl_int) * words.size());
  EXPECT_EQ(words[status_termination], termination_converged);
  EXPECT_EQ(systems, words[status_iterations]);
}

// Before anything is allocated for it: the matrix has more bytes than a buffer, or an int of the kernels,
// takes.
TEST_F(SolverTest, DenseCholeskyRefusesAMatrixThatTheDeviceDoesNotTake) {
  const double most = std::sqrt(static_cast<double>(device_.info().most_bytes) / sizeof(float));
  const int nodes = static_cast<int>(std::min(most, 46336.0)) / affine_size + 6;
  DeformationGraph graph;
  for (int node = 0; node < nodes; ++node) graph.nodes.emplace_back(node, 0, 800);
  Problem problem(graph, {});
  const std::size_t unknowns = (affine_size * static_cast<std::size_t>(nodes) + 63) / 64 * 64;
  try {
    solve(problem, "{type: gauss_newton, linear_solver: dense_cholesky}");
    FAIL() << nodes << " nodes were solved for";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr(std::to_string(sizeof(float) * unknowns * unknowns) + " bytes"));
  }
}

}  // namespace
}  // namespace pliant::test
