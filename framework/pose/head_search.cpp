#include "framework/pose/head_search.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace pliant {
namespace {

constexpr double bandwidth = 20;     // mm, of mean shift
constexpr double agreeing = 40;      // mm from the centre
constexpr double cell = 60;          // mm, of the grid in which the search begins
constexpr double head_area = 22000;  // mm^2 that a camera sees of a head, about
constexpr double one_head = 0.35;    // radians: rotations further from the mean do not agree

struct Vote {
  Eigen::Vector3d centre;  // mm, camera frame
  double weight;
  const HeadLeaf* leaf;
};

std::vector<Vote> cast_votes(const HeadForest& forest, const DepthImage& depth, const Camera& camera,
                             const HeadSearchOptions& options) {
  std::vector<Vote> votes;
  for (int v = options.stride / 2; v < depth.height(); v += options.stride) {
    for (int u = options.stride / 2; u < depth.width(); u += options.stride) {
      if (!is_depth(depth(u, v))) continue;
      const DepthPatch patch(depth, camera, u, v);
      const Eigen::Vector3d point = camera.unproject(u, v, depth(u, v));
      for (const HeadTree& tree : forest.trees) {
        const HeadLeaf& leaf = tree.leaf_of(patch);
        if (leaf.head_share < options.least_share || leaf.offset_spread > options.greatest_spread) continue;
        const double spread = std::max(leaf.offset_spread, 1.0F);
        votes.push_back({point + leaf.offset.cast<double>(), leaf.head_share / (spread * spread), &leaf});
      }
    }
  }
  return votes;
}

/// The middle of the votes in the cell of a coarse grid that has the most.
Eigen::Vector3d start(const std::vector<Vote>& votes) {
  struct Sum {
    double weight = 0;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  };
  std::map<std::array<int, 3>, Sum> cells;
  for (const Vote& vote : votes) {
    const Eigen::Vector3i at = (vote.centre / cell).array().floor().cast<int>();
    Sum& sum = cells[{at.x(), at.y(), at.z()}];
    sum.weight += vote.weight;
    sum.centre += vote.weight * vote.centre;
  }
  const auto most = std::max_element(cells.begin(), cells.end(), [](const auto& a, const auto& b) {
    return a.second.weight < b.second.weight;
  });
  return most->second.centre / most->second.weight;
}

Eigen::Vector3d shifted(const std::vector<Vote>& votes, const Eigen::Vector3d& from) {
  double weight = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Vote& vote : votes) {
    const double away = (vote.centre - from).squaredNorm() / (bandwidth * bandwidth);
    if (away > 16) continue;
    const double share = vote.weight * std::exp(-away / 2);
    weight += share;
    sum += share * vote.centre;
  }
  return weight > 0 ? Eigen::Vector3d(sum / weight) : from;
}

Eigen::Vector3d mode_of(const std::vector<Vote>& votes) {
  constexpr int most_steps = 20;
  constexpr double near = 0.1;  // mm
  Eigen::Vector3d centre = start(votes);
  for (int i = 0; i < most_steps; ++i) {
    const Eigen::Vector3d next = shifted(votes, centre);
    const bool is_there = (next - centre).norm() < near;
    centre = next;
    if (is_there) break;
  }
  return centre;
}

/// The rotation nearest to a sum of some.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& sum) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

/// The mean of the rotations of votes, the second time without those that are far from it.
Eigen::Matrix3d mean_rotation(const std::vector<const Vote*>& votes) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const bool is_first : {true, false}) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Vote* vote : votes) {
      const Eigen::Matrix3d rotation = head_rotation(vote->leaf->angles.cast<double>());
      if (!is_first && Eigen::AngleAxisd(mean.transpose() * rotation).angle() > one_head) continue;
      const double spread = std::max(vote->leaf->angle_spread, 0.01F);
      sum += rotation / (spread * spread);
    }
    if (sum.isZero()) break;
    mean = nearest_rotation(sum);
  }
  return mean;
}

}  // namespace

std::optional<HeadEstimate> find_head(const HeadForest& forest, const DepthImage& depth, const Camera& camera,
                                      const HeadSearchOptions& options) {
  const std::vector<Vote> votes = cast_votes(forest, depth, camera, options);
  if (votes.empty()) return std::nullopt;
  const Eigen::Vector3d centre = mode_of(votes);
  std::vector<const Vote*> agree;
  for (const Vote& vote : votes)
    if ((vote.centre - centre).norm() < agreeing) agree.push_back(&vote);
  if (agree.empty() || !(centre.z() > 0)) return std::nullopt;
  const double patches = head_area * camera.fx * camera.fy / (centre.z() * centre.z()) / (options.stride * options.stride);
  const double possible = patches * static_cast<double>(forest.trees.size());
  HeadEstimate estimate;
  estimate.confidence = std::min(static_cast<double>(agree.size()) / possible, 1.0);
  if (estimate.confidence < options.least_confidence) return std::nullopt;
  estimate.camera_from_head.linear() = mean_rotation(agree);
  estimate.camera_from_head.translation() = centre;
  return estimate;
}

}  // namespace pliant
