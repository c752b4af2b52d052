#pragma once

#include <memory>
#include <vector>

namespace pliant {

/// Of each query the features whose descriptors are nearest, nearest first.
struct FeatureNeighbours {
  std::vector<std::vector<int>> features;   ///< their places in the index
  std::vector<std::vector<float>> squared;  ///< distances of descriptors
};

/// Finds descriptors [FLANN]. Exact: FLANN's randomised trees are shuffled by std::random_device and give
/// other matches in every run.
class FeatureIndex {
 public:
  /// `descriptors`: as many numbers of each feature, one after the other; must outlive this, unchanged.
  FeatureIndex(std::vector<float>& descriptors, std::size_t features);
  ~FeatureIndex();

  /// `queries`: descriptors of so many features. Fewer than `count` where the index has no more.
  FeatureNeighbours nearest(std::vector<float>& queries, std::size_t features, int count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace pliant
