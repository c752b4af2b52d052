#include "benchmarks/tracking_model.h"

#include <memory>
#include <opencv2/rgbd/volume.hpp>

#include "framework/model/tsdf.h"

namespace pliant::bench {
namespace {

constexpr int resolution = 256;       // voxels
constexpr double side = 3000;         // mm
constexpr double distance = 300;      // mm
constexpr double truncation = 5;      // voxels
constexpr double margin = 0.25;       // of the object's longest side
constexpr int max_weight = 64;        // frames
constexpr float step_factor = 0.25F;  // of the truncation, OpenCV's own default

/// A frame without what is not tracked.
Frame tracked(const Frame& frame, const TrackedImages& images) {
  Frame kept = frame;
  for (int v = 0; v < kept.depth.height(); ++v) {
    for (int u = 0; u < kept.depth.width(); ++u) {
      const bool is_far = images.depth_cut > 0 && kept.depth(u, v) > images.depth_cut;
      if (is_far || !images.region.contains(u, v)) kept.depth(u, v) = 0;
    }
  }
  return kept;
}

TsdfGrid grid_for(Device& device, const TrackedImages& images) {
  const Camera& camera = images.rig.depth;
  if (images.region == whole_image(camera))
    return grid_before_camera(resolution, side, distance, {truncation});
  const DepthMap seen(tracked(images.before, images));
  return grid_around(make_surface_map(device, seen, camera), resolution, margin, {truncation});
}

struct Ours {
  Ours(Device& device, const TrackedImages& images, const TsdfGrid& grid)
      : camera(images.rig.depth),
        region(images.region),
        pose(images.after_from_before),
        depth(tracked(images.after, images)),
        tsdf(device, grid, max_weight) {
    tsdf.integrate(DepthMap(tracked(images.before, images)), camera, Eigen::Isometry3d::Identity());
    tsdf.integrate(depth, camera, pose);
  }

  Camera camera;
  PixelWindow region;
  Eigen::Isometry3d pose;
  DepthMap depth;
  Tsdf tsdf;
};

cv::Matx44f in_metres(Eigen::Matrix4d pose) {
  pose.topRightCorner<3, 1>() /= 1000;
  cv::Matx44f matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix(row, column) = static_cast<float>(pose(row, column));
  return matrix;
}

/// The same in OpenCV's terms: metres, a camera of the region alone, poses from the camera to the model.
struct OpenCv {
  OpenCv(const TrackedImages& images, const TsdfGrid& grid)
      : camera(static_cast<float>(images.rig.depth.fx), static_cast<float>(images.rig.depth.fy),
               static_cast<float>(images.rig.depth.cx - images.region.left),
               static_cast<float>(images.rig.depth.cy - images.region.top)),
        pose(in_metres(images.after_from_before.inverse().matrix())),
        depth(region_of(tracked(images.after, images), images.region)) {
    Eigen::Matrix4d corner = Eigen::Matrix4d::Identity();
    corner.topRightCorner<3, 1>() = grid.origin;
    volume = cv::kinfu::makeVolume(cv::kinfu::VolumeType::TSDF, static_cast<float>(grid.voxel / 1000),
                                   in_metres(corner), step_factor, static_cast<float>(grid.truncation / 1000),
                                   max_weight, 0, cv::Vec3i(grid.size.x(), grid.size.y(), grid.size.z()));
    const cv::Mat before = region_of(tracked(images.before, images), images.region);
    volume->integrate(before, 1000, cv::Matx44f::eye(), camera);
    volume->integrate(depth, 1000, pose, camera);
  }

  static cv::Mat region_of(const Frame& frame, const PixelWindow& region) {
    const cv::Mat whole(frame.depth.height(), frame.depth.width(), CV_32F,
                        const_cast<float*>(frame.depth.data()));
    return whole(cv::Rect(region.left, region.top, region.width, region.height)).clone();
  }

  cv::kinfu::Intr camera;
  cv::Matx44f pose;
  cv::Mat depth, points, normals;
  cv::Ptr<cv::kinfu::Volume> volume;
};

}  // namespace

std::vector<StagePair> model_stages(Device& device, const TrackedImages& images) {
  const TsdfGrid grid = grid_for(device, images);
  const auto ours = std::make_shared<Ours>(device, images, grid);
  const auto opencv = std::make_shared<OpenCv>(images, grid);
  return {{"integrate",
           [ours, &device] {
             ours->tsdf.integrate(ours->depth, ours->camera, ours->pose);
             device.finish();
           },
           [opencv] { opencv->volume->integrate(opencv->depth, 1000, opencv->pose, opencv->camera); }},
          {"raycast",
           [ours, &device] {
             ours->tsdf.raycast(ours->camera, ours->region, ours->pose);
             device.finish();
           },
           [opencv] {
             opencv->volume->raycast(opencv->pose, opencv->camera, opencv->depth.size(), opencv->points,
                                     opencv->normals);
           }}};
}

}  // namespace pliant::bench
