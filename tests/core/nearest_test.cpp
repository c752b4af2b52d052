#include "framework/core/nearest.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

const std::vector<std::string> choices{"rotation", "regularization", "constraint", "cg"};

TEST(Nearest, FindsEveryKindOfSlip) {
  EXPECT_EQ(nearest("rotatio", choices), "rotation");
  EXPECT_EQ(nearest("rotattion", choices), "rotation");
  EXPECT_EQ(nearest("ratation", choices), "rotation");
  EXPECT_EQ(nearest("rotatoin", choices), "rotation");
  EXPECT_EQ(nearest("Rotation", choices), "rotation");
  EXPECT_EQ(nearest("regularisation", choices), "regularization");
}

TEST(Nearest, CountsSwappedLettersAsOneEdit) {
  // Were it two edits, a word of three letters would not be near.
  EXPECT_EQ(nearest("mpa", {"map"}), "map");
}

TEST(Nearest, PrefersTheFewestEditsThenTheFirst) {
  EXPECT_EQ(nearest("weigth", {"height", "weight"}), "weight");
  EXPECT_EQ(nearest("cat", {"bat", "hat"}), "bat");
}

TEST(Nearest, SaysNothingWhenNothingIsNear) {
  EXPECT_EQ(nearest("quaternion", choices), "");
  EXPECT_EQ(nearest("x", {"y"}), "");
  EXPECT_EQ(nearest("", choices), "");
  EXPECT_EQ(nearest("rotation", {}), "");
  EXPECT_EQ(nearest(std::string(100000, 'r'), choices), "");
}

TEST(Nearest, SuggestionIsAQuestionOrNothing) {
  EXPECT_EQ(suggestion("cgg", choices), "; did you mean 'cg'?");
  EXPECT_EQ(suggestion("quaternion", choices), "");
}

}  // namespace
}  // namespace pliant
