#include "framework/problem/problem.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "energies/energies.h"
#include "framework/core/error.h"
#include "framework/deformation/warp.h"
#include "tests/problem/components.h"
#include "tests/problem/sheet_problem.h"

namespace pliant::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Two nodes 10 mm apart along x and one point in the middle that both move, asked to go (3, 0, 4) away.
class ProblemTest : public testing::Test {
 protected:
  ProblemTest() { register_energies(registry_); }

  Energy energy(const std::string& name, double weight) const {
    return *make<Energy>(registry_, "{type: " + name + ", weight: " + std::to_string(weight) + "}");
  }
  Problem make_problem(std::vector<Term> terms, double length_unit = 1) const {
    return Problem(graph_, std::move(terms), length_unit);
  }
  Term constraint(double weight = 1) const { return {energy("constraint", weight), constraints_}; }

  std::string error_of(const std::function<void()>& action) const {
    try {
      action();
    } catch (const DataError& error) {
      EXPECT_EQ(error.exit_code(), 3);
      return error.what();
    }
    return "";
  }
  std::string error_of_constraints() const {
    return error_of([&] { make_problem({constraint()}); });
  }

  Registry registry_;
  DeformationGraph graph_{{{0, 0, 800}, {10, 0, 800}}, {{0, 1}, {1, 0}}};
  std::shared_ptr<Constraints> constraints_ = std::make_shared<Constraints>(
      Constraints{Array<float>(std::vector<float>{5, 0, 800}),
                  {2, Array<int>(std::vector<int>{0, 1}), Array<float>(std::vector<float>{0.5F, 0.5F})},
                  Array<float>(std::vector<float>{3, 0, 4, 0, 0, -1}),
                  Array<float>(std::vector<float>{1})});
};

TEST_F(ProblemTest, StartsAtTheIdentity) {
  auto problem = make_problem({constraint()});
  EXPECT_EQ(problem.node_count(), 2);
  EXPECT_EQ(problem.unknown_count(), 2 * affine_size);
  EXPECT_THAT(problem.unknowns().host(), testing::Each(0));
  EXPECT_THAT(problem.node_points().host(), testing::ElementsAre(0, 0, 800, 10, 0, 800));
  problem.unknowns().write_host()[3] = 1;
  problem.reset_to_identity();
  EXPECT_THAT(problem.unknowns().host(), testing::Each(0));
}

TEST_F(ProblemTest, TheConstraintEnergyIsTheSquaredDistance) {
  auto problem = make_problem({constraint(100)});
  EXPECT_DOUBLE_EQ(problem.energy(), 100 * 25);
  problem.unknowns().write_host()[9] = 6;  // t of node 0: half of it reaches the point
  EXPECT_DOUBLE_EQ(problem.energy(), 100 * 16);
  problem.unknowns().write_host()[12 + 2] = -1.6F;  // D of node 1, x to z; the arm is (-5, 0, 0): z + 4
  EXPECT_NEAR(problem.energy(), 0, 1e-10);
}

TEST_F(ProblemTest, ConfidenceIsAFactorAndZeroKeepsNaNOut) {
  auto problem = make_problem({constraint(2)});
  constraints_->confidence.write_host()[0] = 0.25F;
  EXPECT_DOUBLE_EQ(problem.energy(), 2 * 0.25 * 25);
  constraints_->confidence.write_host()[0] = 0;
  constraints_->data.write_host()[1] = kNaN;
  EXPECT_EQ(problem.energy(), 0);
}

TEST_F(ProblemTest, TheRegularizationEnergyIsWhereNeighboursDisagree) {
  auto problem = make_problem({{energy("regularization", 10), nullptr}});
  EXPECT_EQ(problem.energy(), 0);
  problem.unknowns().write_host()[12 + 10] = 3;  // t_y of node 1: both directions of the edge see 3 mm
  EXPECT_DOUBLE_EQ(problem.energy(), 10 * 2 * 9);
  problem.unknowns().write_host()[1] = 0.3F;  // node 0 turns its arm of 10 mm to the same place
  EXPECT_NEAR(problem.energy(), 10 * 9, 1e-4);
}

TEST_F(ProblemTest, TheRotationEnergyIsTheDeviationFromAnOrthonormalFrame) {
  auto problem = make_problem({{energy("rotation", 1), nullptr}});
  problem.unknowns().write_host()[0] = 1;  // c1 = (2, 0, 0): c1.c1 - 1 = 3
  EXPECT_DOUBLE_EQ(problem.energy(), 9);
  problem.unknowns().write_host()[3] = 0.5F;  // c2 = (0.5, 1, 0): c1.c2 = 1, c2.c2 - 1 = 0.25
  EXPECT_DOUBLE_EQ(problem.energy(), 9 + 1 + 0.0625);
}

TEST_F(ProblemTest, TheUnitOfLengthDividesTheSquaresOfLengthsOnly) {
  const std::vector<Term> terms{
      {energy("rotation", 1), nullptr}, {energy("regularization", 10), nullptr}, constraint(100)};
  const auto value = [&](double unit, std::size_t term) {
    auto problem = make_problem({terms[term]}, unit);
    randomise_unknowns(problem, 0.1, 5, 1);
    return problem.energy();
  };
  EXPECT_DOUBLE_EQ(value(1000, 0), value(1, 0));
  EXPECT_NEAR(value(1000, 1) / value(1, 1), 1e-6, 1e-18);
  EXPECT_NEAR(value(1000, 2) / value(1, 2), 1e-6, 1e-18);
  const auto metres = make_problem(terms, 1000);
  EXPECT_DOUBLE_EQ(metres.effective_weight(terms[0]), 1);
  EXPECT_DOUBLE_EQ(metres.effective_weight(terms[2]), 1e-4);
}

TEST_F(ProblemTest, WeightsAndScalesOfLossesMayChange) {
  auto problem = make_problem({constraint(100), {energy("rotation", 1), nullptr}});
  problem.set_weight(0, 2);
  EXPECT_DOUBLE_EQ(problem.energy(), 2 * 25);
  problem.set_weight(0, 0);
  EXPECT_EQ(problem.energy(), 0);

  Energy tolerant = energy("constraint", 1);
  tolerant.loss = {"huber", 10};
  auto robust = make_problem({{tolerant, constraints_}});
  EXPECT_DOUBLE_EQ(robust.energy(), 25);
  robust.set_loss_scale(0, 1);
  EXPECT_DOUBLE_EQ(robust.energy(), 2 * 5 - 1);
}

TEST_F(ProblemTest, RefusesWeightsAndScalesThatAreNone) {
  auto problem = make_problem({constraint(100)});
  for (const double wrong : {-1.0, static_cast<double>(kNaN), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(error_of([&] { problem.set_weight(0, wrong); }), testing::HasSubstr("weight of energy"));
    EXPECT_THAT(error_of([&] { problem.set_loss_scale(0, wrong); }), testing::HasSubstr("scale of the loss"));
  }
  EXPECT_THAT(error_of([&] { problem.set_loss_scale(0, 0); }), testing::HasSubstr("energy constraint is 0"));
  EXPECT_DOUBLE_EQ(problem.energy(), 100 * 25);
}

TEST_F(ProblemTest, CountsInstancesAndTheNodesTheyCouple) {
  const auto problem =
      make_problem({{energy("rotation", 1), nullptr}, {energy("regularization", 1), nullptr}, constraint()});
  const auto& terms = problem.terms();
  EXPECT_EQ(instance_count(problem, terms[0]), 2U);
  EXPECT_EQ(instance_count(problem, terms[1]), 2U);
  EXPECT_EQ(instance_count(problem, terms[2]), 1U);
  EXPECT_THAT(coupled_nodes(problem, terms[0], 1), testing::ElementsAre(1));
  EXPECT_THAT(coupled_nodes(problem, terms[1], 1), testing::ElementsAre(1, 0));
  EXPECT_THAT(coupled_nodes(problem, terms[2], 0), testing::ElementsAre(0, 1));
}

TEST_F(ProblemTest, RefusesAGraphThatIsNone) {
  EXPECT_THAT(error_of([] { Problem problem({}, {}); }), testing::HasSubstr("at least one node"));
  for (const Edge edge : {Edge{0, 2}, Edge{-1, 0}}) {
    graph_.edges = {edge};
    EXPECT_THAT(error_of_constraints(), testing::HasSubstr("names a node that is not among the 2"));
  }
  graph_.edges = {{1, 1}};
  EXPECT_THAT(error_of_constraints(), testing::HasSubstr("node 1 with itself"));
}

TEST_F(ProblemTest, RefusesTermsWithoutTheirConstraints) {
  EXPECT_EQ(error_of([&] {
              make_problem({{energy("constraint", 1), nullptr}});
            }),
            "energy constraint needs constraints");
  EXPECT_EQ(error_of([&] {
              make_problem({{energy("rotation", 1), constraints_}});
            }),
            "energy rotation takes no constraints");
}

TEST_F(ProblemTest, RefusesArraysThatDoNotFitTogether) {
  const auto refused = testing::HasSubstr("do not fit together");
  const Constraints good = copy_of(*constraints_);
  constraints_->data = Array<float>(std::vector<float>(5));
  EXPECT_THAT(error_of_constraints(), refused);
  *constraints_ = copy_of(good);
  constraints_->confidence = Array<float>(std::vector<float>(2));
  EXPECT_THAT(error_of_constraints(), refused);
  *constraints_ = copy_of(good);
  constraints_->points = Array<float>(std::vector<float>(4));
  EXPECT_THAT(error_of_constraints(), refused);
  *constraints_ = copy_of(good);
  for (const int per_point : {1, 3, 0, -1}) {
    constraints_->influences.per_point = per_point;
    EXPECT_THAT(error_of_constraints(), refused) << per_point;
  }
  *constraints_ = copy_of(good);
  EXPECT_EQ(error_of_constraints(), "");
}

TEST_F(ProblemTest, RefusesInfluencesOfNodesThatAreNotThereOrThereTwice) {
  constraints_->influences.nodes.write_host() = {0, 2};
  EXPECT_THAT(error_of_constraints(), testing::HasSubstr("hangs on node 2 of 2"));
  constraints_->influences.nodes.write_host() = {-1, 1};
  EXPECT_THAT(error_of_constraints(), testing::HasSubstr("hangs on node -1 of 2"));
  constraints_->influences.nodes.write_host() = {1, 1};
  EXPECT_THAT(error_of_constraints(), testing::HasSubstr("node 1 twice"));
}

TEST_F(ProblemTest, RefusesWeightsAndUnitsThatMakeNoEnergy) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double weight : {-1.0, infinity, static_cast<double>(kNaN)}) {
    auto term = constraint();
    term.energy.weight = weight;
    EXPECT_THAT(error_of([&] { make_problem({term}); }), testing::HasSubstr("weight of energy constraint"));
  }
  for (const double unit : {0.0, -1.0, infinity, static_cast<double>(kNaN)})
    EXPECT_THAT(error_of([&] { make_problem({constraint()}, unit); }), testing::HasSubstr("unit of length"));
}

}  // namespace
}  // namespace pliant::test
