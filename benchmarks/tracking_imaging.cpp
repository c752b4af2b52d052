#include "benchmarks/tracking_imaging.h"

#include <memory>
#include <opencv2/imgproc.hpp>
#include <opencv2/rgbd.hpp>

#include "framework/imaging/bilateral.h"
#include "framework/imaging/integral_images.h"

namespace pliant::bench {
namespace {

constexpr double sigma_space = 4.5;  // pixels [thesis 3.1]
constexpr double sigma_depth = 30;   // mm
constexpr int radius = 6;

/// What the stages of ours work on.
struct Ours {
  Ours(Device& device, const TrackedImages& images)
      : camera(images.rig.depth), depth(images.region), surface(unwritten_surface(camera, images.region)) {
    depth.take(images.after);
    filtered = bilateral.filter(device, depth, camera);
    normals.write(device, *filtered, surface);
    device.finish();
  }

  Camera camera;
  BilateralFilter bilateral{sigma_space, sigma_depth, radius};
  IntegralImages normals{3, 0.02};
  DepthMap depth;
  std::optional<DepthMap> filtered;
  SurfaceMap surface;
};

/// The same in OpenCV's terms: depth in metres, cameras of the region alone.
struct OpenCv {
  explicit OpenCv(const TrackedImages& images) {
    const Camera& camera = images.rig.depth;
    const PixelWindow& region = images.region;
    const DepthImage& seen = images.after.depth;
    const cv::Mat whole(seen.height(), seen.width(), CV_32F, const_cast<float*>(seen.data()));
    whole(cv::Rect(region.left, region.top, region.width, region.height)).copyTo(depth);
    cv::bilateralFilter(depth, filtered, 2 * radius + 1, sigma_depth, sigma_space);
    const cv::Matx33f intrinsics(
        static_cast<float>(camera.fx), 0, static_cast<float>(camera.cx - region.left), 0,
        static_cast<float>(camera.fy), static_cast<float>(camera.cy - region.top), 0, 0, 1);
    const cv::Mat metres = filtered / 1000;
    cv::rgbd::depthTo3d(metres, cv::Mat(intrinsics), points);
    fals = cv::rgbd::RgbdNormals::create(depth.rows, depth.cols, CV_32F, cv::Mat(intrinsics));
    fals->initialize();
    (*fals)(points, normals);
  }

  cv::Mat depth, filtered, points, normals;
  cv::Ptr<cv::rgbd::RgbdNormals> fals;
};

}  // namespace

std::vector<StagePair> imaging_stages(Device& device, const TrackedImages& images) {
  const auto ours = std::make_shared<Ours>(device, images);
  const auto opencv = std::make_shared<OpenCv>(images);
  return {{"bilateral",
           [ours, &device] {
             ours->filtered = ours->bilateral.filter(device, ours->depth, ours->camera);
             device.finish();
           },
           [opencv] {
             cv::bilateralFilter(opencv->depth, opencv->filtered, 2 * radius + 1, sigma_depth, sigma_space);
           }},
          {"normals",
           [ours, &device] {
             ours->normals.write(device, *ours->filtered, ours->surface);
             device.finish();
           },
           [opencv] { (*opencv->fals)(opencv->points, opencv->normals); }}};
}

}  // namespace pliant::bench
