#include "framework/geometry/point_set.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/device/shapes.h"

namespace pliant {
namespace {

using Vectors = std::vector<Eigen::Vector3f>;

const Vectors kPoints{{1, 2, 900}, {0, 0, 0}, {-30, 4, 700}, {0, 0, 650}, {0, 0, 0}, {-1, 0, 0}};
const Vectors kNormals{{0, 0, -1}, {0, 0, 0}, {0.6F, 0, -0.8F}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}};

PointSet made_set(const Vectors& points, const Vectors& normals) {
  return {flatten(points), flatten(normals)};
}

/// Many of them, so that there is more than one work-group.
PointSet many(std::size_t count) {
  Vectors points, normals;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(kPoints[i % kPoints.size()] * static_cast<float>(1 + i / kPoints.size()));
    normals.push_back(kNormals[i % kNormals.size()]);
  }
  return made_set(points, normals);
}

class PointSetTest : public ::testing::TestWithParam<DeviceOptions> {
 protected:
  Device device_{"any", GetParam()};
};

TEST_P(PointSetTest, PlacedPointsLieAtTheirIndicesAndTheRestStays) {
  PointSet into = many(200);
  const Vectors before = unflatten(into.points);
  const Vectors normals_before = unflatten(into.normals);
  const std::vector<int> indices{7, 0, 199, 64, 3, 130};
  place_points(device_, made_set(kPoints, kNormals), Array<int>(indices), into);
  const Vectors points = unflatten(into.points);
  const Vectors normals = unflatten(into.normals);
  ASSERT_EQ(points.size(), 200U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found = std::find(indices.begin(), indices.end(), static_cast<int>(i));
    const auto k = static_cast<std::size_t>(found - indices.begin());
    EXPECT_EQ(points[i], found == indices.end() ? before[i] : kPoints[k]) << i;
    EXPECT_EQ(normals[i], found == indices.end() ? normals_before[i] : kNormals[k]) << i;
  }
}

TEST_P(PointSetTest, PlacingUndoesPicking) {
  const PointSet set = many(150);
  PointSet into = no_points(device_, 150);
  const Array<int> indices(indices_of_points(device_, set));
  place_points(device_, pick_points(device_, set, indices), indices, into);
  EXPECT_EQ(into.points.host(), set.points.host());
}

TEST_P(PointSetTest, MovesAllPointsAndLeavesNoneWhereThereIsNone) {
  const Eigen::Isometry3d motion =
      Eigen::Translation3d(10, -20, 35) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized());
  const PointSet set = many(200);
  PointSet moved = many(200);
  move_points(device_, set, motion, moved);
  const Vectors points = unflatten(set.points);
  const Vectors normals = unflatten(set.normals);
  const Vectors moved_points = unflatten(moved.points);
  const Vectors moved_normals = unflatten(moved.normals);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d expected = motion * points[i].cast<double>();
    if (points[i] == Eigen::Vector3f::Zero())
      EXPECT_EQ(moved_points[i], points[i]) << i;
    else
      EXPECT_LT((moved_points[i].cast<double>() - expected).norm(), 1e-6 * expected.norm()) << i;
    EXPECT_LT((moved_normals[i].cast<double>() - motion.linear() * normals[i].cast<double>()).norm(), 1e-6);
  }
}

TEST_P(PointSetTest, NoPointsAreNone) {
  const PointSet none = no_points(device_, 70);
  EXPECT_EQ(none.points.host(), std::vector<float>(210, 0));
  EXPECT_EQ(none.normals.host(), std::vector<float>(210, 0));
  EXPECT_TRUE(indices_of_points(device_, none).empty());
}

TEST_P(PointSetTest, FindsWhichArePoints) {
  EXPECT_EQ(indices_of_points(device_, made_set(kPoints, kNormals)), (std::vector<int>{0, 2, 3, 5}));
  const std::vector<int> found = indices_of_points(device_, many(600));
  EXPECT_EQ(found.size(), 400U);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
}

TEST_P(PointSetTest, NothingIsNothing) {
  PointSet none = no_points(device_, 0);
  EXPECT_TRUE(none.points.empty());
  EXPECT_TRUE(indices_of_points(device_, none).empty());
  PointSet into = many(6);
  const std::vector<float> before = into.points.host();
  place_points(device_, none, Array<int>(std::vector<int>{}), into);
  EXPECT_EQ(into.points.host(), before);
}

INSTANTIATE_TEST_SUITE_P(DeviceShapes, PointSetTest, ::testing::ValuesIn(test::device_shapes));

}  // namespace
}  // namespace pliant
