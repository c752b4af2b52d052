#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/core/angle.h"
#include "framework/model/tsdf.h"
#include "tests/geometry/mesh_shape.h"
#include "tests/model/ball.h"

namespace pliant {
namespace {

using test::Ball;

const Camera kCamera{260, 260, 79.5, 59.5, 160, 120};
const Ball kBall;
const TsdfGrid kGrid{{64, 64, 64}, {-115, -128, 480}, 3.8, 19};

/// The ball seen from all around.
void fuse(Tsdf& tsdf) {
  for (int degrees = 0; degrees < 360; degrees += 30) {
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.7, 0.7, 0)}) {
      const Eigen::Isometry3d pose = kBall.from_around(degrees, axis);
      tsdf.integrate(DepthMap(kBall.frame(kCamera, pose)), kCamera, pose);
    }
  }
}

TEST(TsdfAccuracy, TheMeshIsTheSurfaceThatWasSeen) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  fuse(tsdf);
  const Mesh mesh = tsdf.mesh();
  double sum = 0;
  double worst = 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const double error = std::abs((vertex.cast<double>() - kBall.centre).norm() - kBall.radius);
    sum += error;
    worst = std::max(worst, error);
  }
  EXPECT_LT(sum / static_cast<double>(mesh.vertices.size()), 0.15 * kGrid.voxel);
  EXPECT_LT(worst, kGrid.voxel);
  const test::MeshShape shape = test::shape_of(mesh);
  EXPECT_EQ(shape.open_edges, 0);
  EXPECT_EQ(shape.euler, 2) << "one closed surface: nothing else floats in the volume";
  const double volume = 4 * EIGEN_PI / 3 * std::pow(kBall.radius, 3);
  EXPECT_NEAR(shape.volume, volume, 0.02 * volume);
}

TEST(TsdfAccuracy, WhatIsSeenIsWhatWasSeen) {
  Device device;
  Tsdf tsdf(device, kGrid, 64);
  fuse(tsdf);
  for (const double degrees : {0.0, 17.0}) {
    const Eigen::Isometry3d pose = kBall.from_around(degrees, {0.2, 1, 0.3});
    const SurfaceMap& map = tsdf.raycast(kCamera, whole_image(kCamera), pose);
    std::vector<double> errors;
    std::vector<double> angles;
    int seen = 0;
    for (int v = 0; v < kCamera.height; ++v) {
      for (int u = 0; u < kCamera.width; ++u) {
        const double truth = kBall.depth(kCamera, pose, u, v);
        seen += truth > 0 ? 1 : 0;
        const Eigen::Vector3d point = finite_or_none(map, map.points(), {u, v}).cast<double>();
        if (!(truth > 0 && point.z() > 0)) continue;
        errors.push_back(std::abs(point.z() - truth));
        const Eigen::Vector3d normal = (pose.inverse() * point - kBall.centre).normalized();
        const Eigen::Vector3d found =
            pose.linear().transpose() * finite_or_none(map, map.normals(), {u, v}).cast<double>();
        angles.push_back(std::acos(std::min(normal.dot(found), 1.0)) / degree);
      }
    }
    ASSERT_GT(errors.size(), 0.97 * seen);
    std::sort(errors.begin(), errors.end());
    std::sort(angles.begin(), angles.end());
    EXPECT_LT(errors[errors.size() / 2], 0.6);
    EXPECT_LT(errors[errors.size() * 95 / 100], 2.5);
    EXPECT_LT(angles[angles.size() / 2], 3);
  }
}

}  // namespace
}  // namespace pliant
