#include "framework/model/tsdf_reference.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/device/shapes.h"
#include "tests/geometry/degrees_between.h"
#include "tests/geometry/made_depth.h"
#include "tests/model/ball.h"

namespace pliant {
namespace {

using test::Ball;
using test::degrees_between;

/// Width and height are no multiples of a vector.
const Camera kCamera{100, 96, 42.5, 30, 87, 61};
const Ball kBall{.wall = 720};
/// Around the ball and a part of the wall; some of it is outside of the image.
const TsdfGrid kGrid{{64, 56, 64}, {-150, -150, 480}, 5, 22};
const Eigen::Vector3d kAxis(0.3, 1, 0.1);

struct View {
  Frame frame;
  Eigen::Isometry3d camera_from_model;
};

/// From several sides; then the ball is gone, then there are noise and holes, then the camera is in the grid.
std::vector<View> views() {
  std::vector<View> views;
  for (const double degrees : {0.0, 25.0, -40.0}) {
    const Eigen::Isometry3d pose = kBall.from_around(degrees, kAxis);
    views.push_back({kBall.frame(kCamera, pose), pose});
  }
  const Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  const Ball gone{.radius = 0, .wall = 720};
  views.push_back({gone.frame(kCamera, start), start});
  views.push_back({made_depth(kCamera), Eigen::Isometry3d(Eigen::Translation3d(0, 0, 300))});
  const Eigen::Isometry3d within(Eigen::Translation3d(0, 0, -500));
  views.push_back({kBall.frame(kCamera, within), within});
  return views;
}

class TsdfKernels : public ::testing::TestWithParam<DeviceOptions> {
 protected:
  Device device_{"any", GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Shapes, TsdfKernels, ::testing::ValuesIn(test::device_shapes));

TEST_P(TsdfKernels, FuseTheSameBitsAsTheReference) {
  constexpr int max_weight = 4;  // reached on the way
  Tsdf tsdf(device_, kGrid, max_weight);
  TsdfVoxels expected = tsdf.read();
  EXPECT_EQ(std::count(expected.distances.begin(), expected.distances.end(), 0),
            static_cast<std::ptrdiff_t>(kGrid.voxels()));
  int weight = 1;
  for (const View& view : views()) {
    const DepthMap map(view.frame);
    tsdf.integrate(map, kCamera, view.camera_from_model, weight);
    const TsdfVoxels before = expected;
    integrate_reference(kGrid, max_weight, map, kCamera, view.camera_from_model, expected, weight);
    weight = 3 - weight;
    const TsdfVoxels fused = tsdf.read();
    EXPECT_TRUE(fused.distances == expected.distances);
    EXPECT_TRUE(fused.weights == expected.weights);
    EXPECT_FALSE(before.distances == expected.distances) << "the view tells nothing";
  }
  EXPECT_EQ(*std::max_element(expected.weights.begin(), expected.weights.end()), max_weight);
}

/// A lattice whose points swing by up to 30 mm, as no smooth field would have them.
DisplacementLattice swinging_lattice(Device& device, double amplitude) {
  DisplacementLattice lattice(kGrid);
  const Array<float> rest = lattice.points_at_rest(device);
  std::vector<float> moved = rest.host();
  for (std::size_t i = 0; i < moved.size(); ++i)
    moved[i] += static_cast<float>(amplitude * std::sin(0.7 * static_cast<double>(i)));
  lattice.displace(device, rest, Array<float>(std::move(moved)));
  return lattice;
}

TEST_P(TsdfKernels, FuseTheSameBitsAsTheReferenceThroughALattice) {
  const DisplacementLattice lattice = swinging_lattice(device_, 30);
  Tsdf tsdf(device_, kGrid, 3);
  TsdfVoxels expected = tsdf.read();
  for (const View& view : views()) {
    const DepthMap map(view.frame);
    tsdf.integrate(map, kCamera, view.camera_from_model, lattice);
    const TsdfVoxels before = expected;
    integrate_reference(kGrid, 3, map, kCamera, view.camera_from_model, lattice, expected);
    const TsdfVoxels fused = tsdf.read();
    EXPECT_TRUE(fused.distances == expected.distances);
    EXPECT_TRUE(fused.weights == expected.weights);
    EXPECT_FALSE(before.distances == expected.distances) << "the view tells nothing";
  }
}

TEST_P(TsdfKernels, FuseTheSameBitsThroughALatticeAtRest) {
  const DisplacementLattice lattice = swinging_lattice(device_, 0);
  Tsdf plain(device_, kGrid, 64);
  Tsdf displaced(device_, kGrid, 64);
  for (const View& view : views()) {
    const DepthMap map(view.frame);
    plain.integrate(map, kCamera, view.camera_from_model);
    displaced.integrate(map, kCamera, view.camera_from_model, lattice);
  }
  EXPECT_TRUE(plain.read().distances == displaced.read().distances);
}

TEST_P(TsdfKernels, PlaceTheLatticeAtEveryFourthVoxelAndBoundItsBricks) {
  DisplacementLattice lattice(kGrid);
  ASSERT_EQ(lattice.size(), Eigen::Vector3i(17, 15, 17));
  const std::vector<Eigen::Vector3f> rest = unflatten(lattice.points_at_rest(device_));
  std::vector<Eigen::Vector3f> moved = rest;
  std::vector<int> times(17 * 15 * 17, 0);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Eigen::Vector3d at = kGrid.model_from_voxel().inverse() * rest[i].cast<double>() / 4;
    const Eigen::Vector3i point = at.array().round().cast<int>();
    EXPECT_LT((at - point.cast<double>()).norm(), 1e-4);
    if ((point.array() < lattice.size().array()).all())
      ++times[static_cast<std::size_t>(point.x() + 17 * (point.y() + 15 * point.z()))];
    moved[i].x() += static_cast<float>(kGrid.voxel * point.x());
    moved[i].z() -= static_cast<float>(kGrid.voxel * (point.y() + point.z()));
  }
  EXPECT_THAT(times, ::testing::Each(1));
  const Eigen::Vector3i brick(2, 3, 1);
  lattice.displace(device_, flatten(rest), flatten(moved));
  const Eigen::Vector3i bricks = kGrid.bricks();
  const int index = brick.x() + bricks.x() * (brick.y() + bricks.y() * brick.z());
  const float* reach = lattice.reaches().host().data() + std::ptrdiff_t{8} * index;
  EXPECT_NEAR(reach[0], 8, 1e-4) << "its points along x are 8 to 12, along y 6 to 8, along z 2 to 4";
  EXPECT_NEAR(reach[4], 12, 1e-4);
  EXPECT_EQ(reach[1], 0);
  EXPECT_NEAR(reach[2], -12, 1e-4);
  EXPECT_NEAR(reach[6], -8, 1e-4);
  const Eigen::Vector3f displaced = lattice.displaced_reference({34, 8, 9});
  EXPECT_NEAR(displaced.x(), 34 + 8.5, 1e-3);
  EXPECT_NEAR(displaced.z(), 9 - 2 - 2.25, 1e-3);
}

/// How what the device sees compares with what the reference does.
struct Comparison {
  int seen = 0;   ///< pixels where the reference sees a point
  int same = 0;   ///< where the device sees it less than a twentieth of a voxel and 3 degrees from there
  int extra = 0;  ///< where the device alone sees one
};

Comparison compare(const SurfaceMap& map, const SurfaceImage& expected) {
  Comparison comparison;
  for (int v = 0; v < expected.points.height(); ++v) {
    for (int u = 0; u < expected.points.width(); ++u) {
      const Eigen::Vector3f point = finite_or_none(map, map.points(), {u, v});
      const Eigen::Vector3f normal = finite_or_none(map, map.normals(), {u, v});
      EXPECT_NEAR(normal.norm(), point.z() > 0 ? 1 : 0, 1e-5);
      if (expected.points(u, v).z() == 0) {
        comparison.extra += point.z() > 0 ? 1 : 0;
        continue;
      }
      ++comparison.seen;
      const bool is_same = (point - expected.points(u, v)).norm() < 0.05 * kGrid.voxel &&
                           degrees_between(normal, expected.normals(u, v)) < 3;
      comparison.same += is_same ? 1 : 0;
    }
  }
  return comparison;
}

TEST_P(TsdfKernels, SeeWhatTheReferenceSees) {
  Tsdf tsdf(device_, kGrid, 64);
  for (int i = 0; i < 3; ++i) {
    const View view = views()[static_cast<std::size_t>(i)];
    tsdf.integrate(DepthMap(view.frame), kCamera, view.camera_from_model);
  }
  const TsdfVoxels voxels = tsdf.read();
  const Eigen::Isometry3d from_behind =
      kBall.from_around(180, Eigen::Vector3d::UnitY()) * Eigen::Translation3d(0, 0, 0);
  for (const Eigen::Isometry3d& pose :
       {Eigen::Isometry3d::Identity(), kBall.from_around(15, kAxis), kBall.from_around(-60, {1, 0.2, 0}),
        Eigen::Isometry3d(Eigen::Translation3d(20, 10, -450)), from_behind}) {
    const SurfaceMap& map = tsdf.raycast(kCamera, whole_image(kCamera), pose);
    const SurfaceImage expected = raycast_reference(kGrid, voxels, kCamera, pose);
    const Comparison comparison = compare(map, expected);
    EXPECT_GE(comparison.same, 0.94 * comparison.seen);
    EXPECT_LE(comparison.extra, 0.02 * comparison.seen);
  }
}

TEST_P(TsdfKernels, DoNotSeeSurfacesFromBehind) {
  Tsdf tsdf(device_, kGrid, 64);
  const Ball wall{.radius = 0, .wall = 620};
  tsdf.integrate(DepthMap(wall.frame(kCamera, Eigen::Isometry3d::Identity())), kCamera,
                 Eigen::Isometry3d::Identity());
  const auto seen = [&](const Eigen::Isometry3d& pose) {
    const auto points = unflatten(tsdf.raycast(kCamera, whole_image(kCamera), pose).points());
    return std::count_if(points.begin(), points.end(), [](const auto& point) { return point.z() > 0; });
  };
  EXPECT_GT(seen(Eigen::Isometry3d::Identity()), 1500);
  const Ball around{.centre = {0, 0, 620}};
  EXPECT_EQ(seen(around.from_around(180, Eigen::Vector3d::UnitY())), 0);
  EXPECT_EQ(seen(around.from_around(150, Eigen::Vector3d::UnitX())), 0);
}

TEST_P(TsdfKernels, DoNotDependOnTheWindow) {
  const Frame frame = kBall.frame(kCamera, Eigen::Isometry3d::Identity());
  Frame part = frame;
  const PixelWindow window{21, 13, 41, 37};
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u)
      if (!window.contains(u, v)) part.depth(u, v) = 0;
  DepthMap cut(part);
  DepthMap whole(whole_image(kCamera));
  std::fill(whole.depth.write_host().begin(), whole.depth.write_host().end(), DepthMap::no_depth);
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u)
      if (part.depth(u, v) > 0) whole.depth.write_host()[whole.offset(u, v)] = part.depth(u, v);
  ASSERT_EQ(cut.window, window);
  Tsdf one(device_, kGrid, 64), other(device_, kGrid, 64);
  const Eigen::Isometry3d pose = kBall.from_around(10, kAxis);
  one.integrate(cut, kCamera, pose);
  other.integrate(whole, kCamera, pose);
  EXPECT_TRUE(one.read().distances == other.read().distances);
  const SurfaceMap& all = one.raycast(kCamera, whole_image(kCamera), pose);
  const SurfaceMap& some = other.raycast(kCamera, window, pose);
  int seen = 0;
  for (int v = window.top; v < window.top + window.height; ++v) {
    for (int u = window.left; u < window.left + window.width; ++u) {
      const Eigen::Vector3f point = finite_or_none(some, some.points(), {u, v});
      EXPECT_EQ(point, finite_or_none(all, all.points(), {u, v})) << u << ' ' << v;
      EXPECT_EQ(finite_or_none(some, some.normals(), {u, v}), finite_or_none(all, all.normals(), {u, v}));
      seen += point.z() > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 300);
}

TEST_P(TsdfKernels, GiveTheSameBitsTwice) {
  const auto seen = [&] {
    Device device("any", GetParam());
    Tsdf tsdf(device, kGrid, 64);
    for (const View& view : views()) tsdf.integrate(DepthMap(view.frame), kCamera, view.camera_from_model);
    return tsdf.raycast(kCamera, whole_image(kCamera), kBall.from_around(10, kAxis)).points().host();
  };
  EXPECT_EQ(seen(), seen());
}

}  // namespace
}  // namespace pliant
