#include "experiments/study/expression.h"

#include <gmock/gmock.h>

#include "framework/core/error.h"

namespace pliant {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Expression, KnowsItsNamesAndItsValue) {
  const Expression fps("1000 / time_ms.total + offset", "here");
  EXPECT_THAT(fps.names(), ElementsAre("offset", "time_ms.total"));
  EXPECT_EQ(fps.value({{"time_ms.total", 20}, {"offset", 1}, {"other", 3}}), 51);
}

TEST(Expression, HasNoValueWithoutANumberOrWhereItIsNotFinite) {
  const Expression quotient("a / b", "here");
  EXPECT_EQ(quotient.value({{"a", 1}}), std::nullopt);
  EXPECT_EQ(quotient.value({{"a", 1}, {"b", 0}}), std::nullopt);
  EXPECT_EQ(quotient.value({{"a", 1}, {"b", 2}}), 0.5);
}

TEST(Expression, ComparesAndCombines) {
  const Expression holds("a <= 1.05 * b && a > 0", "here");
  EXPECT_EQ(holds.value({{"a", 1}, {"b", 1}}), 1);
  EXPECT_EQ(holds.value({{"a", 2}, {"b", 1}}), 0);
  EXPECT_EQ(Expression("a == b || a >= 3", "here").value({{"a", 2}, {"b", 2}}), 1);
  EXPECT_EQ(Expression("a != b", "here").value({{"a", 2}, {"b", 2}}), 0);
}

TEST(Expression, TellsWhatIsNoFormula) {
  for (const char* text : {"a +", "(a", "", "a b", "1 ? 2", "a = 3", "="}) {
    try {
      const Expression expression(text, "exp.yaml:3:4");
      FAIL() << text;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), StartsWith("exp.yaml:3:4: '" + std::string(text) + "' is no formula: "))
          << text;
    }
  }
}

}  // namespace
}  // namespace pliant
