#include "benchmarks/opencv_icp.h"

namespace pliant::bench {
namespace {

constexpr double millimetres = 1000;  // a metre

}  // namespace

OpencvIcp::OpencvIcp(const Camera& camera) {
  const cv::Mat matrix = (cv::Mat_<float>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  odometry_ = cv::rgbd::FastICPOdometry::create(matrix);
}

cv::Mat OpencvIcp::depth_of(const DepthImage& depth) {
  const cv::Mat image(depth.height(), depth.width(), CV_32F, const_cast<float*>(depth.data()));
  return image / millimetres;
}

OpencvIcp::Frame OpencvIcp::prepare(const cv::Mat& depth) const {
  Frame frame = cv::rgbd::OdometryFrame::create(cv::Mat(), depth);
  odometry_->prepareFrameCache(frame, cv::rgbd::OdometryFrame::CACHE_ALL);
  return frame;
}

std::optional<Eigen::Isometry3d> OpencvIcp::align(Frame source, Frame target) const {
  cv::Mat motion;
  if (!odometry_->compute(source, target, motion)) return std::nullopt;
  Eigen::Isometry3d found = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      found.matrix()(row, column) = motion.at<double>(row, column) * (column == 3 ? millimetres : 1);
  return found;
}

}  // namespace pliant::bench
