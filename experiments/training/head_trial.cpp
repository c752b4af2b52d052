#include "experiments/training/head_trial.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "experiments/training/all_processors.h"
#include "framework/core/angle.h"
#include "framework/core/stopwatch.h"

namespace pliant {
namespace {

/// What estimates have in common that truths have not, in the head's frame.
Eigen::Isometry3d mean_offset(const std::vector<HeadView>& views,
                              const std::vector<std::optional<HeadEstimate>>& found) {
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!found[i]) continue;
    const Eigen::Isometry3d offset = views[i].camera_from_head.inverse() * found[i]->camera_from_head;
    shift += offset.translation();
    rotations += offset.linear();
    ++count;
  }
  if (count == 0) return mean;
  mean.linear() = nearest_rotation(rotations);
  mean.translation() = shift / count;
  return mean;
}

}  // namespace

HeadTrial try_head_forest(const HeadForest& forest, const HeadSearchOptions& options, const HeadViews& views,
                          int count, std::uint64_t seed, bool without_mean_offset) {
  std::vector<HeadView> drawn(static_cast<std::size_t>(count));
  on_all_processors(drawn.size(), [&](std::size_t i) {
    Draw draw(seed, i);
    drawn[i] = views.draw(draw);
  });
  HeadTrial trial;
  trial.views = count;
  std::vector<std::optional<HeadEstimate>> found;
  for (const HeadView& view : drawn) {
    const Stopwatch watch;
    found.push_back(find_head(forest, view.depth, head_camera(), options));
    trial.milliseconds.push_back(watch.milliseconds());
  }
  const Eigen::Isometry3d offset =
      without_mean_offset ? mean_offset(drawn, found) : Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (!found[i]) continue;
    const Eigen::Isometry3d truth = drawn[i].camera_from_head * offset;
    const Eigen::Isometry3d& estimate = found[i]->camera_from_head;
    const Eigen::Vector3d difference = head_angles(estimate.linear()) - head_angles(truth.linear());
    ++trial.found;
    trial.position.push_back((estimate.translation() - truth.translation()).norm());
    trial.angles.emplace_back(difference.cwiseAbs() / degree);
    trial.rotation.push_back(Eigen::AngleAxisd(truth.linear().transpose() * estimate.linear()).angle() /
                             degree);
  }
  return trial;
}

MeanAndMost mean_and_most(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {sum / static_cast<double>(values.size()), values[values.size() * 95 / 100]};
}

}  // namespace pliant
