#include "framework/pose/head_search.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace pliant {
namespace {

constexpr double bandwidth = 20;      // mm, of mean shift
constexpr double agreeing = 40;       // mm from the centre
constexpr double cell = 60;           // mm, of the grid in which the search begins
constexpr float least_angle = 0.02F;  // radians: no vote is surer of its angles
constexpr int approaching = 10;       // refinements that lead to a pose, and then
constexpr int averaged = 8;           // so many whose mean is taken
// Radians: how unsure the trees that refine are of the angles of most heads, and of hardly any. In between
// are heads that look far up or down as well as what is none: there it counts how many votes agree.
constexpr double surely_head = 0.1;
constexpr double no_head = 0.4;
constexpr double head_area = 22000;  // mm^2 that a camera sees of a head, about

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
      const Eigen::Vector3d point = camera.unproject(u, v, depth(u, v));
      const DepthPatch patch = patch_around(depth, camera, point);
      for (const HeadTree& tree : forest.voting) {
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

/// What votes agree upon.
Eigen::Isometry3d mean_pose(const std::vector<const Vote*>& votes, const Eigen::Vector3d& centre) {
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  for (const Vote* vote : votes) {
    const double spread = std::max(vote->leaf->angle_spread, least_angle);
    rotations += head_rotation(vote->leaf->angles.cast<double>()) / (spread * spread);
  }
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  camera_from_head.linear() = nearest_rotation(rotations);
  camera_from_head.translation() = centre;
  return camera_from_head;
}

/// A pose, and how unsure trees are that were asked about it.
struct Refined {
  Eigen::Isometry3d camera_from_head = Eigen::Isometry3d::Identity();
  double spread = 0;  // radians, the mean over the trees
};

/// Nearer to the head's pose than one that is nearly right.
Refined refined_once(const std::vector<HeadTree>& trees, const std::vector<Eigen::Vector3f>& points,
                     const Eigen::Isometry3d& camera_from_head) {
  const DepthPatch patch = patch_of_head(points, camera_from_head);
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  double spread = 0;
  for (const HeadTree& tree : trees) {
    const HeadLeaf& leaf = tree.leaf_of(patch);
    offset += leaf.offset.cast<double>();
    turn += leaf.angles.cast<double>();
    spread += leaf.angle_spread;
  }
  const double share = 1 / static_cast<double>(trees.size());
  return {camera_from_head * moved(share * offset, share * turn), share * spread};
}

/// Where that ends, again and again. It does not end in a point: the mean of the later poses is closer.
Refined refined(const std::vector<HeadTree>& trees, const std::vector<Eigen::Vector3f>& points,
                const Eigen::Isometry3d& start) {
  Refined now{start};
  Eigen::Vector3d places = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  double spreads = 0;
  for (int i = 0; i < approaching + averaged; ++i) {
    now = refined_once(trees, points, now.camera_from_head);
    if (i < approaching) continue;
    places += now.camera_from_head.translation() / averaged;
    rotations += now.camera_from_head.linear();
    spreads += now.spread / averaged;
  }
  Refined mean;
  mean.camera_from_head.linear() = nearest_rotation(rotations);
  mean.camera_from_head.translation() = places;
  mean.spread = spreads;
  return mean;
}

/// From where the votes are, and from beside: of all that is reached, what the trees are surest of.
Refined best_refined(const std::vector<HeadTree>& trees, const std::vector<Eigen::Vector3f>& points,
                     const Eigen::Isometry3d& start) {
  constexpr double yaw = 0.7;  // radians
  constexpr double pitch = 0.45;
  Refined best;
  bool is_first = true;
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, yaw, 0), Eigen::Vector3d(0, -yaw, 0),
        Eigen::Vector3d(pitch, 0, 0), Eigen::Vector3d(-pitch, 0, 0)}) {
    const Refined found = refined(trees, points, start * moved(Eigen::Vector3d::Zero(), turn));
    if (is_first || found.spread < best.spread) best = found;
    is_first = false;
  }
  return best;
}

}  // namespace

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& sum) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

std::vector<Eigen::Vector3f> points_near(const DepthImage& depth, const Camera& camera,
                                         const Eigen::Vector3d& centre) {
  constexpr double radius = 200;  // mm
  constexpr double spacing = 2.5;
  const Eigen::Vector2d pixel = camera.project(centre);
  const Eigen::Vector2d around = Eigen::Vector2d(camera.fx, camera.fy) * radius / centre.z();
  const int step = std::max(1, static_cast<int>(spacing * camera.fx / centre.z()));
  const auto first = [](double value) { return static_cast<int>(std::max(value, 0.0)); };
  const auto last = [](double value, int size) { return static_cast<int>(std::min(value, size - 1.0)); };
  std::vector<Eigen::Vector3f> points;
  for (int v = first(pixel.y() - around.y()); v <= last(pixel.y() + around.y(), depth.height()); v += step) {
    for (int u = first(pixel.x() - around.x()); u <= last(pixel.x() + around.x(), depth.width()); u += step) {
      if (!is_depth(depth(u, v)) || std::abs(depth(u, v) - centre.z()) > radius) continue;
      points.push_back(camera.unproject(u, v, depth(u, v)).cast<float>());
    }
  }
  return points;
}

std::optional<HeadEstimate> find_head(const HeadForest& forest, const DepthImage& depth, const Camera& camera,
                                      const HeadSearchOptions& options) {
  const std::vector<Vote> votes = cast_votes(forest, depth, camera, options);
  if (votes.empty()) return std::nullopt;
  const Eigen::Vector3d centre = mode_of(votes);
  std::vector<const Vote*> agree;
  for (const Vote& vote : votes)
    if ((vote.centre - centre).norm() < agreeing) agree.push_back(&vote);
  if (agree.empty() || !(centre.z() > 0)) return std::nullopt;
  const double patches =
      head_area * camera.fx * camera.fy / (centre.z() * centre.z()) / (options.stride * options.stride);
  const double possible = patches * static_cast<double>(forest.voting.size());
  const double agreement = std::min(static_cast<double>(agree.size()) / possible, 1.0);
  if (agreement < options.least_confidence) return std::nullopt;
  const Refined pose =
      best_refined(forest.refining, points_near(depth, camera, centre), mean_pose(agree, centre));
  const double certainty = std::clamp((no_head - pose.spread) / (no_head - surely_head), 0.0, 1.0);
  const HeadEstimate estimate{pose.camera_from_head, agreement * certainty};
  if (estimate.confidence < options.least_confidence) return std::nullopt;
  return estimate;
}

}  // namespace pliant
