#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/datasets/frame_source.h"

namespace pliant {

/// Distances of some followed points from where they truly are, mm; all 0 where there are none.
struct PointErrors {
  int count = 0;
  double mean = 0;
  double p95 = 0;
  double max = 0;
};

/// The same of those that are known, and of two kinds of them.
struct FollowedErrors {
  PointErrors all;
  PointErrors visible;  ///< the frame shows them
  /// They are more than 1 mm from where the rigid motion of the object alone would have brought them; none
  /// where that is not known.
  PointErrors moving;
};

/// Judges points of a deforming model by where a stream knows that they went.
class PointTruth {
 public:
  /// The points are those that frame `first`, which began the model, shows at `pixels` of its depth camera.
  /// `stream` must outlive this.
  PointTruth(const DataStream& stream, int first, std::vector<Eigen::Vector2i> pixels)
      : stream_(stream),
        first_(first),
        pixels_(std::move(pixels)),
        start_(stream.points_of(first, pixels_, first)) {}

  /// Of the points in frame `number`, one a pixel, mm in the model's frame; none where the truth is not
  /// known. Points that are not finite, and pixels that truly show nothing, are left out. Asked of the frame
  /// that a generated stream gave last, it renders nothing. Throws std::invalid_argument when there are not
  /// as many points as pixels.
  std::optional<FollowedErrors> error_of(const std::vector<Eigen::Vector3f>& points,
                                         const Eigen::Isometry3d& camera_from_model, int number) const;

 private:
  std::vector<bool> find_moving(const TruePoints& truth, int number) const;

  const DataStream& stream_;
  int first_;
  std::vector<Eigen::Vector2i> pixels_;
  std::optional<TruePoints> start_;  // in that frame
};

}  // namespace pliant
