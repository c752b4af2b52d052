#include "benchmarks/tracking_pose.h"

#include <memory>

#include "benchmarks/opencv_icp.h"

namespace pliant::bench {

StagePair pose_stage(Device& device, const TrackedImages& images, const SurfaceMap& source,
                     const SurfaceMap& target, const ProjectiveIcpOptions& options) {
  const auto icp = std::make_shared<ProjectiveIcp>(device, options);
  const auto opencv = std::make_shared<OpencvIcp>(images.rig.depth);
  const OpencvIcp::Frame before = opencv->prepare(OpencvIcp::depth_of(images.before.depth));
  const cv::Mat after = OpencvIcp::depth_of(images.after.depth);
  return {"icp", [icp, &source, &target] { icp->estimate(source, target, Eigen::Isometry3d::Identity()); },
          [opencv, before, after] { opencv->align(before, opencv->prepare(after)); }};
}

}  // namespace pliant::bench
