#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/core/angle.h"

namespace pliant {

/// Features of a frame, their points in the model's frame.
struct ModelFeatures {
  std::vector<float> descriptors;       ///< as many numbers of each, one after the other
  std::vector<Eigen::Vector3d> points;  ///< mm

  void append(const ModelFeatures& more);
};

/// A frame whose pose was found, for what it showed of the model.
struct Keyframe {
  Eigen::Isometry3d camera_from_model;  ///< mm
  ModelFeatures color;
  ModelFeatures surface;
};

struct KeyframeOptions {
  int most = 20;               ///< at least 2
  double distance = 80;        ///< mm
  double angle = 12 * degree;  ///< radians
};

/// The keyframes of a model: from one to the next its middle moved, or turned, by some way.
class Keyframes {
 public:
  /// `middle`: of the model, mm in its frame.
  Keyframes(const KeyframeOptions& options, const Eigen::Vector3d& middle)
      : options_(options), middle_(middle) {}

  /// Whether a pose is far from those of all that are kept.
  bool wants(const Eigen::Isometry3d& camera_from_model) const;
  /// Where there is no room, the older of the two that are nearest to each other goes.
  void add(Keyframe keyframe);
  const std::vector<Keyframe>& all() const { return keyframes_; }

 private:
  double difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const;
  void drop_one();

  KeyframeOptions options_;
  Eigen::Vector3d middle_;
  std::vector<Keyframe> keyframes_;  // in the order they were added
};

}  // namespace pliant
