#include "experiments/modeller/field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

TEST(Field, IsPutTogetherLikeAFormula) {
  const VectorField field = bump({1, 2, 3}, 4) * shift({0, 0, 5}) + shift({1, 0, 0});
  EXPECT_LT((field({1, 2, 3}) - Point(1, 0, 5)).norm(), 1e-12);
  EXPECT_LT((field({5, 2, 3}) - Point(1, 0, 5 * std::exp(-1))).norm(), 1e-12);
  const ScalarField product = bump({0, 0, 0}, {2, 4, 8}) * inverse(rise(coordinate(0), -1, 3));
  EXPECT_NEAR(product({1, 0, 0}), std::exp(-0.25) / 2, 1e-12);
}

TEST(Field, ARiseIsFlatAtBothEnds) {
  const ScalarField field = rise(coordinate(1), 10, 20);
  EXPECT_EQ(field({0, 10, 0}), 0);
  EXPECT_EQ(field({0, 20, 0}), 1);
  EXPECT_NEAR(field({0, 15, 0}), 0.5, 1e-12);
  EXPECT_LT(field({0, 10.1, 0}), 1e-3);
}

TEST(Field, ATurnIsARotationAboutAnAxis) {
  const VectorField field = turn({0, 1, 0}, Point::UnitZ(), 90);
  EXPECT_LT((field({2, 1, 7}) - Point(-2, 2, 0)).norm(), 1e-12);
  EXPECT_LT(field({0, 1, 7}).norm(), 1e-12);
}

TEST(Field, BothSidesAreMirrorImages) {
  const VectorField field = both_sides(bump({10, 0, 0}, 2) * shift({1, 2, 3}));
  EXPECT_LT((field({10, 0, 0}) - Point(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((field({-10, 0, 0}) - Point(-1, 2, 3)).norm(), 1e-12);
}

TEST(Field, BecomesATargetAtThePoints) {
  const MorphTarget made = target("wide", stretch({1, 0, 0}, {0.5, 0, 0}), {{1, 5, 5}, {3, 0, 0}});
  EXPECT_EQ(made.name, "wide");
  ASSERT_EQ(made.displacements.size(), 2U);
  EXPECT_EQ(made.displacements[0], Eigen::Vector3f(0, 0, 0));
  EXPECT_EQ(made.displacements[1], Eigen::Vector3f(1, 0, 0));
}

}  // namespace
}  // namespace pliant
