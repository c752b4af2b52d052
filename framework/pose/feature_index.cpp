#include "framework/pose/feature_index.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>

namespace pliant {
namespace {

flann::Matrix<float> rows_of(std::vector<float>& descriptors, std::size_t features) {
  return {descriptors.data(), features, features > 0 ? descriptors.size() / features : 0};
}

}  // namespace

struct FeatureIndex::Tree {
  Tree(std::vector<float>& descriptors, std::size_t features) : index(rows_of(descriptors, features)) {
    index.buildIndex();
  }
  flann::KDTreeSingleIndex<flann::L2<float>> index;
};

FeatureIndex::FeatureIndex(std::vector<float>& descriptors, std::size_t features)
    : tree_(std::make_unique<Tree>(descriptors, features)) {}

FeatureIndex::~FeatureIndex() = default;

FeatureNeighbours FeatureIndex::nearest(std::vector<float>& queries, std::size_t features, int count) const {
  FeatureNeighbours found;
  tree_->index.knnSearch(rows_of(queries, features), found.features, found.squared,
                         static_cast<std::size_t>(count), flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  return found;
}

}  // namespace pliant
