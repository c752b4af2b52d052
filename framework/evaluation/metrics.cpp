#include "framework/evaluation/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "framework/core/error.h"

namespace pliant {
namespace {

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr float moving_distance = 1;  // mm
constexpr float seen_distance = 10;   // mm: beyond the noise of a depth camera, below what hides anything

struct Spread {
  double mean = 0;
  double sd = 0;
};

/// Mean and population standard deviation of values without NaN; zeros when there are none.
Spread spread_of(const std::vector<float>& values) {
  Spread spread;
  if (values.empty()) return spread;
  for (const float value : values) spread.mean += value;
  spread.mean /= static_cast<double>(values.size());
  double squares = 0;
  for (const float value : values) squares += (value - spread.mean) * (value - spread.mean);
  spread.sd = std::sqrt(squares / static_cast<double>(values.size()));
  return spread;
}

std::vector<float> known(std::vector<float> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](float value) { return std::isnan(value); }),
               values.end());
  return values;
}

/// The smallest value that at least 95 of 100 do not exceed.
double percentile_95(std::vector<float> values) {
  const std::size_t rank = (values.size() * 95 + 99) / 100 - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

}  // namespace

Evaluation::Evaluation(const FramePair& pair, const std::optional<PairTruth>& truth, const Surface& source,
                       SurfaceImage target)
    : camera_(pair.camera), target_(std::move(target)), nearest_(target_.points, camera_) {
  check(pair);
  if (nearest_.empty()) throw DataError(pair.name + ": the target has no point to measure against");
  if (!truth) return;
  check(*truth, pair);
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector2i& pixel = source.pixels[i];
    const Eigen::Vector3f flow = truth->scene_flow(pixel.x(), pixel.y());
    truth_.push_back(source.points[i] + flow);  // NaN where the flow is
    moving_.push_back(flow.norm() > moving_distance);
    seen_.push_back(truth->visible.empty() ? is_seen(truth_.back())
                                           : truth->visible(pixel.x(), pixel.y()) != 0);
  }
}

std::vector<float> Evaluation::residuals(const std::vector<Eigen::Vector3f>& points) const {
  std::vector<float> distances(points.size(), unknown);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_point(points[i])) continue;
    const Eigen::Vector2d pixel = camera_.project(points[i].cast<double>()).array().round();
    // Compared before the conversion: a point beside the camera lands further out than an int reaches.
    const bool inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < target_.points.width() &&
                        pixel.y() < target_.points.height();
    if (!inside) continue;
    const Eigen::Vector3f& target = target_.points(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    if (is_point(target)) distances[i] = (points[i] - target).norm();
  }
  return distances;
}

std::vector<float> Evaluation::nearest(const std::vector<Eigen::Vector3f>& points,
                                       const ShareSink& progress) const {
  return nearest_.distances(points, progress);
}

std::vector<float> Evaluation::end_point_errors(const std::vector<Eigen::Vector3f>& points) const {
  std::vector<float> distances;
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    const bool has_both = points[i].allFinite() && truth_[i].allFinite();
    distances.push_back(has_both ? (points[i] - truth_[i]).norm() : unknown);
  }
  return distances;
}

Metrics Evaluation::measure(const std::vector<Eigen::Vector3f>& points) const {
  return measure(points, nearest(points));
}

Metrics Evaluation::measure(const std::vector<Eigen::Vector3f>& points,
                            const std::vector<float>& nearest) const {
  Metrics metrics;
  const std::vector<float> landed = known(residuals(points));
  const Spread residual = spread_of(landed);
  metrics.residual_mean = residual.mean;
  metrics.residual_sd = residual.sd;
  if (!points.empty())
    metrics.coverage = static_cast<double>(landed.size()) / static_cast<double>(points.size());
  const Spread near = spread_of(known(nearest));
  metrics.nearest_mean = near.mean;
  metrics.nearest_sd = near.sd;
  metrics.truth = measure_truth(points);
  return metrics;
}

bool Evaluation::is_seen(const Eigen::Vector3f& truth) const {
  if (!is_point(truth)) return false;
  const Eigen::Vector2d centre = camera_.project(truth.cast<double>()).array().round();
  if (!(centre.cwiseAbs().maxCoeff() < 1e6)) return false;  // further out than any image
  for (int v = static_cast<int>(centre.y()) - 1; v <= static_cast<int>(centre.y()) + 1; ++v)
    for (int u = static_cast<int>(centre.x()) - 1; u <= static_cast<int>(centre.x()) + 1; ++u)
      if (target_.points.contains(u, v) && is_point(target_.points(u, v)) &&
          (truth - target_.points(u, v)).norm() < seen_distance)
        return true;
  return false;
}

std::optional<Metrics::Truth> Evaluation::measure_truth(const std::vector<Eigen::Vector3f>& points) const {
  const std::vector<float> errors = end_point_errors(points);
  const std::vector<float> all = known(errors);
  if (all.empty()) return std::nullopt;
  std::vector<float> moving, seen, hidden;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (std::isnan(errors[i])) continue;
    if (moving_[i]) moving.push_back(errors[i]);
    (seen_[i] ? seen : hidden).push_back(errors[i]);
  }
  const Spread spread = spread_of(all);
  return Metrics::Truth{spread.mean,
                        spread.sd,
                        percentile_95(all),
                        spread_of(moving).mean,
                        spread_of(seen).mean,
                        spread_of(hidden).mean,
                        static_cast<double>(hidden.size()) / static_cast<double>(all.size())};
}

}  // namespace pliant
