#pragma once

#include <Eigen/Geometry>
#include <opencv2/rgbd/depth.hpp>
#include <optional>

#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant::bench {

/// cv::rgbd::FastICPOdometry as it comes, for our images and millimetres.
class OpencvIcp {
 public:
  using Frame = cv::Ptr<cv::rgbd::OdometryFrame>;

  explicit OpencvIcp(const Camera& camera);

  /// Its metres.
  static cv::Mat depth_of(const DepthImage& depth);
  /// Filters, points, normals and their pyramids.
  Frame prepare(const cv::Mat& depth) const;
  /// From the source's camera frame to the target's, mm; none where it gives up.
  std::optional<Eigen::Isometry3d> align(Frame source, Frame target) const;

 private:
  cv::Ptr<cv::rgbd::FastICPOdometry> odometry_;
};

}  // namespace pliant::bench
