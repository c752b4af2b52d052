#include <ceres/jet.h>
#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "framework/problem/energy.h"
#include "framework/problem/loss.h"

namespace pliant {
namespace {

class EveryLoss : public ::testing::TestWithParam<std::string> {
 protected:
  Loss loss_{GetParam(), 3};
};

TEST_P(EveryLoss, IsTheSquareNearZero) {
  EXPECT_EQ(loss_.value(0), 0);
  EXPECT_DOUBLE_EQ(loss_.weight(0), 1);
  EXPECT_NEAR(loss_.value(1e-6), 1e-6, 1e-12);
}

TEST_P(EveryLoss, HasItsDerivatives) {
  for (const double s : {0.01, 1.0, 4.0, 8.0, 10.0, 30.0, 200.0}) {
    const double step = 1e-5;
    EXPECT_NEAR(loss_.weight(s), (loss_.value(s + step) - loss_.value(s - step)) / (2 * step), 1e-7) << s;
    EXPECT_NEAR(loss_.curvature(s), (loss_.weight(s + step) - loss_.weight(s - step)) / (2 * step), 1e-7)
        << s;
  }
}

/// rho, with rho' in its jet, of a loss over jets, by its name.
ceres::Jet<double, 1> value_over_jets(const std::string& name, double s, double scale) {
  using Jet = ceres::Jet<double, 1>;
  const Jet at(s, 0);
  if (name == "huber") return huber_value<Jet>(at, Jet(scale));
  if (name == "tukey") return tukey_value<Jet>(at, Jet(scale));
  if (name == "welsch") return welsch_value<Jet>(at, Jet(scale));
  return none_value<Jet>(at, Jet(scale));
}

TEST_P(EveryLoss, HasTheDerivativeOfItsJets) {
  for (const double s : {0.0, 0.01, 1.0, 8.999, 9.001, 30.0, 200.0}) {
    const auto jet = value_over_jets(GetParam(), s, 3);
    EXPECT_DOUBLE_EQ(jet.a, loss_.value(s));
    EXPECT_NEAR(jet.v[0], loss_.weight(s), 1e-14) << s;
  }
}

TEST_P(EveryLoss, NeverCountsMoreThanTheSquare) {
  double before = 0;
  for (double s = 0.5; s < 400; s *= 1.3) {
    EXPECT_LE(loss_.value(s), s * (1 + 1e-12));
    EXPECT_GE(loss_.value(s), before);
    before = loss_.value(s);
  }
}

INSTANTIATE_TEST_SUITE_P(Losses, EveryLoss, ::testing::ValuesIn(loss_names()));

TEST(Loss, OutliersOfARobustOneStopPulling) {
  EXPECT_NEAR((Loss{"huber", 3}.weight(900)), 0.1, 1e-12);
  EXPECT_EQ((Loss{"tukey", 3}.weight(10)), 0);
  EXPECT_LT((Loss{"welsch", 3}.weight(900)), 1e-40);
  EXPECT_EQ((Loss{"none", 3}.weight(900)), 1);
  EXPECT_FALSE(Loss{}.is_robust());
  EXPECT_TRUE((Loss{"huber", 3}.is_robust()));
}

TEST(Loss, MustBeKnown) { EXPECT_THROW((Loss{"hubert", 3}.value(1)), std::logic_error); }

}  // namespace
}  // namespace pliant
