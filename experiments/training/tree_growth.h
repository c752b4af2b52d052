#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "experiments/training/draw.h"
#include "framework/pose/head_forest.h"

namespace pliant {

/// A patch with what a tree should say of it.
struct TrainingPatch {
  DepthPatch patch;
  bool is_head = false;
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< mm, from the patch's point to the head's centre
  Eigen::Vector3f angles = Eigen::Vector3f::Zero();  ///< radians
};

struct GrowthOptions {
  int tests = 250;          ///< pairs of boxes that are tried for each question
  int thresholds = 24;      ///< of each pair
  int looked_at = 1200;     ///< patches, at most, by which a question is chosen
  int least_patches = 20;   ///< in a leaf
  int greatest_depth = 16;  ///< questions from the first to a leaf
  double steepness = 4;     ///< questions until telling poses counts for most; before, telling heads does
};

/// How much a set of patches tells, in one pass over them.
class PatchMoments {
 public:
  void add(const TrainingPatch& patch);
  void add(const PatchMoments& other);
  void subtract(const PatchMoments& other);

  int count() const { return heads_ + others_; }
  int heads() const { return heads_; }
  /// Entropy of the answer to whether a patch is on a head, nats.
  double class_entropy() const;
  /// Differential entropy of the offsets' and the angles' normal distributions, nats, but for a constant; 0
  /// without any head. A variance counts as no less than that of (1 mm)^2 and (0.5 degrees)^2.
  double pose_entropy() const;
  /// Mean and spread of the heads, and their share.
  HeadLeaf leaf() const;

 private:
  using Symmetric = Eigen::Matrix<double, 6, 1>;  // xx, xy, xz, yy, yz, zz

  int heads_ = 0;
  int others_ = 0;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d angles_ = Eigen::Vector3d::Zero();
  Symmetric offset_products_ = Symmetric::Zero();
  Symmetric angle_products_ = Symmetric::Zero();
};

/// What a question gains by parting a set [Fanelli et al., DAGM 2011]: information about the class, and,
/// by `pose_weight`, about the pose of what is a head.
double information_gain(const PatchMoments& below, const PatchMoments& above, double pose_weight);

/// Of many values, which threshold parts the patches best, all but the middle ones being equally far apart.
struct BestThreshold {
  float threshold = 0;
  double gain = 0;  ///< 0: none parts them
};
/// `values`: of a test, by patch.
BestThreshold best_threshold(const std::vector<float>& values,
                             const std::vector<const TrainingPatch*>& patches, double pose_weight,
                             const GrowthOptions& options);

/// Grows a tree on some patches.
HeadTree grow_tree(const std::vector<const TrainingPatch*>& patches, const GrowthOptions& options,
                   Draw& draw);

}  // namespace pliant
