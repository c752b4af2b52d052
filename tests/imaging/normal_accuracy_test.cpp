#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/datasets/depth_sensor.h"
#include "framework/core/angle.h"
#include "framework/imaging/bilateral.h"
#include "framework/imaging/cross_product.h"
#include "framework/imaging/integral_images.h"
#include "framework/imaging/plane_fit.h"

namespace pliant {
namespace {

const Camera kCamera{525, 525, 159.5, 119.5, 320, 240};

/// A ball 120 mm in radius, before a wall, as the first Kinect sees it, filtered.
class SensedBall : public testing::Test {
 protected:
  SensedBall() {
    Frame frame{DepthImage(kCamera.width, kCamera.height, 1000), {}, {}};
    for (int v = 0; v < kCamera.height; ++v)
      for (int u = 0; u < kCamera.width; ++u)
        if (const auto point = seen_point(u, v)) frame.depth(u, v) = static_cast<float>(point->z());
    frame.depth = DepthSensor({1, 1, 1, 80, 75}, kCamera, 1).sense_reference(frame.depth, 1);
    depth_.emplace(whole_image(kCamera));
    depth_->take(frame);
    depth_ = BilateralFilter(4.5, 30, 6).filter(device_, *depth_, kCamera);
  }

  /// Mean angle in degrees to the true normals, where the ball is seen at 60 degrees or less.
  double mean_error(const Normals& normals) {
    SurfaceMap surface = unwritten_surface(kCamera, depth_->window);
    normals.write(device_, *depth_, surface);
    double sum = 0;
    int count = 0;
    for (int v = 0; v < kCamera.height; ++v) {
      for (int u = 0; u < kCamera.width; ++u) {
        const auto point = seen_point(u, v);
        const Eigen::Vector3f made = finite_or_none(surface, surface.normals(), {u, v});
        if (!point || made.isZero(0)) continue;
        const Eigen::Vector3d normal = (*point - kCentre).normalized();
        if (normal.dot(point->normalized()) > -0.5) continue;
        sum += std::acos(std::clamp(normal.dot(made.cast<double>()), -1.0, 1.0));
        ++count;
      }
    }
    EXPECT_GT(count, 15000);
    return sum / count / degree;
  }

 private:
  static std::optional<Eigen::Vector3d> seen_point(int u, int v) {
    constexpr double radius = 120;
    const Eigen::Vector3d ray = kCamera.unproject(u, v, 1).normalized();
    const double along = ray.dot(kCentre);
    const double inside = radius * radius - (kCentre.squaredNorm() - along * along);
    if (inside <= 0) return std::nullopt;
    return (along - std::sqrt(inside)) * ray;
  }

  static inline const Eigen::Vector3d kCentre{20, -10, 700};
  Device device_;
  std::optional<DepthMap> depth_;
};

TEST_F(SensedBall, HasNormalsNearTheTrueOnes) {
  EXPECT_LT(mean_error(IntegralImages(3, 0.02)), 0.95);
  EXPECT_LT(mean_error(IntegralImages(6, 0.02)), 0.8);
  EXPECT_LT(mean_error(PlaneFit()), 1.05);
  EXPECT_LT(mean_error(CrossProduct(1, 0.02)), 1.35);
}

}  // namespace
}  // namespace pliant
