#include <gmock/gmock.h>

#include <cmath>

#include "experiments/training/tree_growth.h"
#include "framework/core/angle.h"

namespace pliant {
namespace {

/// A patch whose cells are `left` mm beyond its point in the left half, and nothing in the right one.
DepthPatch halved(float left) {
  DepthPatch::Cells cells{};
  for (int j = 0; j < DepthPatch::cells; ++j)
    for (int i = 0; i < DepthPatch::cells / 2; ++i)
      cells[static_cast<std::size_t>(j * DepthPatch::cells + i)] = left;
  return DepthPatch(cells);
}

/// Heads turn to the side that is nearer, by as much; every third patch is of no head, and flat.
std::vector<TrainingPatch> turned_heads(int count, Draw& draw) {
  std::vector<TrainingPatch> patches;
  for (int i = 0; i < count; ++i) {
    const bool is_head = i % 3 != 0;
    const double turn = is_head ? draw.uniform(-1, 1) : 0;
    TrainingPatch patch{halved(static_cast<float>(100 * turn))};
    patch.is_head = is_head;
    patch.angles.x() = static_cast<float>(turn);
    patch.offset = Eigen::Vector3d(draw.normal(), draw.normal(), 50 * turn).cast<float>();
    patches.push_back(patch);
  }
  return patches;
}

std::vector<const TrainingPatch*> pointers(const std::vector<TrainingPatch>& patches) {
  std::vector<const TrainingPatch*> all;
  for (const TrainingPatch& patch : patches) all.push_back(&patch);
  return all;
}

/// Half the logarithm of the determinant of a covariance, by its definition.
double entropy_by_definition(const std::vector<Eigen::Vector3d>& values, double least) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& value : values) mean += value / static_cast<double>(values.size());
  Eigen::Matrix3d covariance = least * Eigen::Matrix3d::Identity();
  for (const auto& value : values)
    covariance += (value - mean) * (value - mean).transpose() / static_cast<double>(values.size());
  return 0.5 * std::log(covariance.determinant());
}

double pose_entropy_by_definition(const std::vector<const TrainingPatch*>& patches) {
  std::vector<Eigen::Vector3d> offsets;
  std::vector<Eigen::Vector3d> angles;
  for (const TrainingPatch* patch : patches) {
    if (!patch->is_head) continue;
    offsets.push_back(patch->offset.cast<double>());
    angles.push_back(patch->angles.cast<double>());
  }
  if (offsets.empty()) return 0;
  const double least_angle = 0.5 * degree;
  return entropy_by_definition(offsets, 1) + entropy_by_definition(angles, least_angle * least_angle);
}

double class_entropy_by_definition(const std::vector<const TrainingPatch*>& patches) {
  double heads = 0;
  for (const TrainingPatch* patch : patches) heads += patch->is_head ? 1 : 0;
  double entropy = 0;
  for (const double share :
       {heads / static_cast<double>(patches.size()), 1 - heads / static_cast<double>(patches.size())})
    if (share > 0) entropy -= share * std::log(share);
  return entropy;
}

TEST(TreeGrowthTest, ThresholdIsTheBestOfAllByTheDefinitionOfTheGain) {
  Draw draw(3, 0);
  const auto patches = turned_heads(60, draw);
  const auto all = pointers(patches);
  std::vector<float> values;
  for (const auto* patch : all)
    values.push_back(static_cast<float>(patch->angles.x() * 100 + 20 * draw.normal()));
  GrowthOptions options;
  options.thresholds = 9;
  const double weight = 0.7;
  const BestThreshold found = best_threshold(values, all, weight, options);

  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  double most = 0;
  for (int i = 1; i <= options.thresholds; ++i) {
    const float step = (*greatest - *least) / static_cast<float>(options.thresholds + 1);
    const float threshold = std::round((*least + static_cast<float>(i) * step) * 32) / 32;
    std::vector<const TrainingPatch*> below;
    std::vector<const TrainingPatch*> above;
    for (std::size_t p = 0; p < all.size(); ++p) (values[p] > threshold ? above : below).push_back(all[p]);
    const auto share = [&](const auto& part) {
      return static_cast<double>(part.size()) / static_cast<double>(all.size());
    };
    const auto heads = [](const auto& part) {
      return static_cast<double>(
          std::count_if(part.begin(), part.end(), [](const auto* p) { return p->is_head; }));
    };
    const double gain = class_entropy_by_definition(all) - share(below) * class_entropy_by_definition(below) -
                        share(above) * class_entropy_by_definition(above) +
                        weight * (pose_entropy_by_definition(all) -
                                  heads(below) / heads(all) * pose_entropy_by_definition(below) -
                                  heads(above) / heads(all) * pose_entropy_by_definition(above));
    if (gain <= most) continue;
    most = gain;
    EXPECT_LE(gain, found.gain + 1e-9);
  }
  EXPECT_NEAR(found.gain, most, 1e-9);
}

TEST(TreeGrowthTest, NothingIsGainedWhereAllPatchesLookAlike) {
  Draw draw(4, 0);
  const auto patches = turned_heads(30, draw);
  EXPECT_EQ(best_threshold(std::vector<float>(30, 5), pointers(patches), 1, {}).gain, 0);
}

TEST(TreeGrowthTest, ATreeTellsHeadsAndHowTheyAreTurned) {
  Draw draw(5, 0);
  const auto patches = turned_heads(900, draw);
  GrowthOptions options;
  options.tests = 40;
  const HeadTree tree = grow_tree(pointers(patches), options, draw);
  for (const float turn : {-0.8F, -0.4F, 0.4F, 0.8F}) {
    const HeadLeaf& leaf = tree.leaf_of(halved(100 * turn));
    EXPECT_GT(leaf.head_share, 0.95) << turn;
    EXPECT_NEAR(leaf.angles.x(), turn, 0.1);
    EXPECT_NEAR(leaf.offset.z(), 50 * turn, 5);
  }
  EXPECT_LT(tree.leaf_of(halved(0)).head_share, 0.2);
}

TEST(TreeGrowthTest, LeavesHoldAsManyPatchesAsAsked) {
  Draw draw(6, 0);
  const auto patches = turned_heads(300, draw);
  GrowthOptions options;
  options.tests = 20;
  options.least_patches = 60;
  const HeadTree tree = grow_tree(pointers(patches), options, draw);
  std::vector<int> counts(tree.leaves.size());
  for (const auto& patch : patches)
    ++counts[static_cast<std::size_t>(&tree.leaf_of(patch.patch) - tree.leaves.data())];
  EXPECT_GT(tree.leaves.size(), 1U);
  EXPECT_THAT(counts, ::testing::Each(::testing::Ge(60)));
}

}  // namespace
}  // namespace pliant
