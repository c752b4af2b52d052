#include "framework/geometry/joint_chain.h"

#include <gmock/gmock.h>

namespace pliant {
namespace {

using ::testing::ElementsAre;

/// The parents of children of one joint, which is the first of the names.
std::vector<int> chained(std::vector<std::string> children) {
  std::vector<int> parents(children.size() + 1, 0);
  parents[0] = -1;
  children.insert(children.begin(), "Armature");
  return chained_parents(children, parents);
}

TEST(JointChain, FollowsTheBonesOfAFinger) {
  EXPECT_THAT(chained({"index-finger-tip", "index-finger-phalanx-distal", "index-finger-phalanx-intermediate",
                       "index-finger-phalanx-proximal", "index-finger-metacarpal", "wrist"}),
              ElementsAre(-1, 2, 3, 4, 5, 6, 0));
}

TEST(JointChain, SkipsBonesThatAreMissing) {
  EXPECT_THAT(chained({"thumb-metacarpal", "thumb-phalanx-proximal", "thumb-phalanx-distal", "thumb-tip"}),
              ElementsAre(-1, 0, 1, 2, 3));
}

TEST(JointChain, FindsTheWordsHoweverTheyAreWritten) {
  EXPECT_THAT(chained({"IndexProximal", "Distal.index", "middle distal", "MIDDLE_PROXIMAL"}),
              ElementsAre(-1, 0, 1, 4, 0));
}

TEST(JointChain, KeepsHandsApart) {
  EXPECT_THAT(chained({"left_wrist", "right_wrist", "right_index_proximal", "left_index_proximal"}),
              ElementsAre(-1, 0, 0, 2, 1));
}

TEST(JointChain, FollowsNumbers) {
  EXPECT_THAT(chained({"tail_10", "tail_2", "tail_9", "head"}), ElementsAre(-1, 3, 0, 2, 0));
  EXPECT_THAT(chained({"tail.001", "tail", "tail.003"}), ElementsAre(-1, 2, 0, 1));
  EXPECT_THAT(chained({"tail1", "tail2", "ear1"}), ElementsAre(-1, 0, 1, 0));
}

TEST(JointChain, LeavesOtherNamesAndOtherParents) {
  EXPECT_THAT(chained({"hip", "knee", "ankle", "wrist"}), ElementsAre(-1, 0, 0, 0, 0));
  EXPECT_THAT(chained_parents({"a_1", "a_2", "b_1", "b_2"}, {-1, 0, -1, 0}), ElementsAre(-1, 0, -1, 0));
  EXPECT_THAT(chained_parents({}, {}), ElementsAre());
}

TEST(JointChain, NeverMakesACycle) {
  const std::vector<std::string> words{"wrist", "tip", "distal", "proximal", "a", "1", "2"};
  std::vector<std::string> names{"root"};
  for (const std::string& first : words)
    for (const std::string& second : words)
      for (const std::string& third : words) names.push_back(first + "-" + second + "-" + third);
  std::vector<int> parents(names.size(), 0);
  parents[0] = -1;
  const std::vector<int> chains = chained_parents(names, parents);
  for (std::size_t i = 0; i < chains.size(); ++i) {
    std::size_t steps = 0;
    for (int joint = static_cast<int>(i); joint >= 0; joint = chains[static_cast<std::size_t>(joint)])
      ASSERT_LE(++steps, chains.size()) << names[i];
  }
}

}  // namespace
}  // namespace pliant
