#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/modeller/figures.h"

namespace pliant {
namespace {

using test::made;
using test::posed;
using test::vertex_near;

class Head : public ::testing::Test {
 protected:
  /// Where the vertex nearest to a point goes, in mm.
  Eigen::Vector3d motion(const std::string& pose, const Eigen::Vector3d& point) const {
    const std::size_t vertex = vertex_near(head_, point);
    return posed(head_, pose)[vertex] - head_.mesh.vertices[vertex].cast<double>();
  }

  double motion_of_target(const std::string& target, const Eigen::Vector3d& point) const {
    const auto found = std::find_if(head_.mesh.targets.begin(), head_.mesh.targets.end(),
                                    [&](const MorphTarget& known) { return known.name == target; });
    return found->displacements.at(vertex_near(head_, point)).norm();
  }

  const Figure head_ = made("head");
  const Eigen::Vector3d corner_{26, -69, 80};
  const Eigen::Vector3d cheek_{50, -58, 60};
  const Eigen::Vector3d upper_lip_{0, -65, 97};
  const Eigen::Vector3d lower_lip_{0, -73, 96};
  const Eigen::Vector3d brow_{15, 15, 88};
};

TEST_F(Head, NoExpressionMovesSkullOrNeck) {
  for (const NamedPose& pose : head_.poses) {
    EXPECT_LT(motion(pose.name, {0, 112, -6}).norm(), 0.05) << pose.name;
    EXPECT_LT(motion(pose.name, {0, 25, -103}).norm(), 0.05) << pose.name;
    EXPECT_LT(motion(pose.name, {0, -145, 15}).norm(), 0.05) << pose.name;
  }
}

TEST_F(Head, ExpressionsAreAsLargeAsFacesMakeThem) {
  const Eigen::Vector3d right_corner(-corner_.x(), corner_.y(), corner_.z());
  const Eigen::Vector3d left = motion("smile", corner_);
  const Eigen::Vector3d right = motion("smile", right_corner);
  for (const Eigen::Vector3d& moved : {left, right}) {
    EXPECT_GT(moved.norm(), 6);
    EXPECT_LT(moved.norm(), 11);
    EXPECT_GT(moved.y(), 3) << "up";
    EXPECT_LT(moved.z(), -2) << "and back";
  }
  EXPECT_GT(left.x(), 3);
  EXPECT_LT(right.x(), -3);
  const Eigen::Vector3d inflated = motion("cheeks", cheek_);
  EXPECT_GT(inflated.x(), 7);
  EXPECT_GT(inflated.norm(), 9);
  EXPECT_LT(inflated.norm(), 13);
  EXPECT_GT(motion("kiss", upper_lip_).z(), 7);
  EXPECT_LT(motion("kiss", upper_lip_).z(), 12);
  EXPECT_LT(motion("kiss", corner_).x(), -3);
  const Eigen::Vector3d brow = motion("angry", brow_);
  EXPECT_LT(brow.y(), -4) << "down";
  EXPECT_LT(brow.x(), -1) << "and together";
  EXPECT_LT(brow.norm(), 8);
  EXPECT_GT(motion_of_target("smile_left", corner_), 6);
  EXPECT_LT(motion_of_target("smile_left", right_corner), 0.5);
  EXPECT_GT(motion_of_target("smile_right", right_corner), 6);
}

TEST_F(Head, AnOpenMouthPartsTheLips) {
  const std::size_t upper = vertex_near(head_, upper_lip_);
  const std::size_t lower = vertex_near(head_, lower_lip_);
  const auto gap = [&](const std::vector<Eigen::Vector3d>& points) {
    return points[upper].y() - points[lower].y();
  };
  const double at_rest = gap(head_.mesh.deform(head_.mesh.rest()));
  EXPECT_LT(at_rest, 12);
  EXPECT_GT(gap(posed(head_, "open_mouth")), at_rest + 15);
  EXPECT_LT(motion("open_mouth", {0, -112, 80}).y(), -17);
  EXPECT_GT(motion("open_mouth", {0, -112, 80}).y(), -28);
}

TEST_F(Head, AnIdentityIsOtherNumbers) {
  const auto reach = [](const Figure& figure, int axis) {
    double most = 0;
    for (const Eigen::Vector3f& vertex : figure.mesh.vertices) most = std::max<double>(most, vertex[axis]);
    return most;
  };
  const Figure wide = made("head", {{"width", 164}});
  EXPECT_GT(reach(wide, 0), reach(head_, 0) + 5);
  const auto front_at = [](const Figure& figure, const Eigen::Vector3d& point) {
    return figure.mesh.vertices[vertex_near(figure, point)];
  };
  const Eigen::Vector3d beyond_chin(0, -100, 110);
  EXPECT_GT(front_at(made("head", {{"chin", 6}}), beyond_chin).z(), front_at(head_, beyond_chin).z() + 2);
}

}  // namespace
}  // namespace pliant
