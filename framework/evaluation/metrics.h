#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/evaluation/nearest_points.h"
#include "framework/evaluation/truth.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// How far a (deformed) source lies from the target, and from the truth where that is known. All in mm,
/// `sd` the population's. A mean over no point is 0, never NaN: look at `coverage`.
struct Metrics {
  double residual_mean = 0;  ///< to the target point at the pixel a point projects to, nothing rejected
  double residual_sd = 0;
  double coverage = 0;      ///< share of the source points that land on a valid target pixel
  double nearest_mean = 0;  ///< to the nearest target point
  double nearest_sd = 0;
  /// End-point error against the true motion; absent when no point has truth.
  struct Truth {
    double epe_mean = 0;
    double epe_sd = 0;
    double epe_p95 = 0;          ///< the least error that 95 % of the points do not exceed
    double epe_moving_mean = 0;  ///< over points whose true motion exceeds 1 mm; 0 when there is none
    /// Over points whose true position the target shows. Where the truth does not know: one of its points
    /// lies within 10 mm there, in one of the 3 x 3 pixels around.
    double epe_seen_mean = 0;
    double epe_hidden_mean = 0;  ///< over the others: covered, cut off or out of view
    double hidden_share = 0;     ///< of the points with truth
  };
  std::optional<Truth> truth;
};

/// Measures moved source points against the target of a pair. Every call takes one point per point of
/// the source. A point that is not finite is NaN in every list, counts as not covered and is left out of
/// the other means.
class Evaluation {
 public:
  /// `source`: the source as given (its pixels look up the truth); `target`: the target's valid points.
  /// Throws DataError when the target has none, and as `check` of a pair and of its truth do.
  Evaluation(const FramePair& pair, const std::optional<PairTruth>& truth, const Surface& source,
             SurfaceImage target);
  Evaluation(const Evaluation&) = delete;
  Evaluation& operator=(const Evaluation&) = delete;

  /// `points[i]` is where source point i was moved to (mm, camera frame).
  Metrics measure(const std::vector<Eigen::Vector3f>& points) const;
  /// The same where `nearest(points)` is known.
  Metrics measure(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& nearest) const;
  /// Per point: distance to the target point at its pixel; NaN where there is none.
  std::vector<float> residuals(const std::vector<Eigen::Vector3f>& points) const;
  /// Per point: distance to the nearest target point.
  std::vector<float> nearest(const std::vector<Eigen::Vector3f>& points,
                             const ShareSink& progress = {}) const;
  /// Per point: distance to its true position; NaN where unknown; empty without truth.
  std::vector<float> end_point_errors(const std::vector<Eigen::Vector3f>& points) const;

 private:
  bool is_seen(const Eigen::Vector3f& truth) const;
  std::optional<Metrics::Truth> measure_truth(const std::vector<Eigen::Vector3f>& points) const;

  Camera camera_;
  SurfaceImage target_;
  NearestPoints nearest_;
  std::vector<Eigen::Vector3f> truth_;  // true position per source point, NaN where unknown
  std::vector<bool> moving_;
  std::vector<bool> seen_;
};

}  // namespace pliant
