#include "framework/deformation/warp.h"

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include <random>

#include "tests/device/shapes.h"

namespace pliant {
namespace {

using Columns = Eigen::Matrix3Xd;

Columns columns(const Array<float>& values) {
  return Eigen::Map<const Eigen::Matrix3Xf>(values.host().data(), 3,
                                            static_cast<Eigen::Index>(values.size() / 3))
      .cast<double>();
}

Array<float> array(const Columns& values) {
  const Eigen::Matrix3Xf single = values.cast<float>();
  return Array<float>(std::vector<float>(single.data(), single.data() + single.size()));
}

/// A cloud of points with unit normals, hung on random nodes among them.
class WarpTest : public testing::TestWithParam<DeviceOptions> {
 protected:
  static constexpr Eigen::Index kPoints = 517;
  static constexpr int kNodes = 23;

  WarpTest() {
    const auto random = [this] { return std::normal_distribution<double>()(generator_); };
    nodes_ = Columns::NullaryExpr(3, kNodes, random) * 60;
    nodes_.row(2).array() += 800;
    Columns points = Columns::NullaryExpr(3, kPoints, random) * 60;
    points.row(2).array() += 800;
    Columns normals = Columns::NullaryExpr(3, kPoints, random);
    normals.colwise().normalize();
    normals.col(7).setZero();  // a point without a normal
    rest_ = {array(points), array(normals)};
    std::vector<Eigen::Vector3f> nodes;
    for (int j = 0; j < kNodes; ++j) nodes.emplace_back(nodes_.col(j).cast<float>());
    influences_ = compute_influences_reference(rest_.points.host(), nodes, 4);
  }

  /// The affine forms of all nodes when the whole space moves by x -> R x + t.
  Array<float> everywhere(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) const {
    std::vector<float> forms;
    for (int j = 0; j < kNodes; ++j) {
      Eigen::Matrix<double, 3, 4> form;
      form << R - Eigen::Matrix3d::Identity(), R * nodes_.col(j) + t - nodes_.col(j);
      for (Eigen::Index i = 0; i < form.size(); ++i) forms.push_back(static_cast<float>(form.data()[i]));
    }
    return Array<float>(std::move(forms));
  }

  Array<float> random_forms(double matrix, double translation) {
    std::normal_distribution<double> normal;
    std::vector<float> forms(affine_size * kNodes);
    for (std::size_t i = 0; i < forms.size(); ++i)
      forms[i] = static_cast<float>(normal(generator_) * (i % affine_size < 9 ? matrix : translation));
    return Array<float>(std::move(forms));
  }

  PointSet on_device(const Array<float>& affine) {
    PointSet moved{Array<float>(rest_.points.size()), Array<float>(rest_.normals.size())};
    warp(device_, rest_, influences_, array(nodes_), affine, moved);
    return moved;
  }

  static double difference(const Array<float>& a, const Columns& b) {
    return (columns(a) - b).cwiseAbs().maxCoeff();
  }

  std::mt19937 generator_{5};
  Device device_{"any", GetParam()};
  Columns nodes_;
  PointSet rest_;
  Influences influences_;
};

INSTANTIATE_TEST_SUITE_P(Shapes, WarpTest, testing::ValuesIn(test::device_shapes));

TEST_P(WarpTest, TheIdentityLeavesEveryBit) {
  const auto moved = on_device(Array<float>(std::vector<float>(affine_size * kNodes, 0)));
  EXPECT_EQ(moved.points.host(), rest_.points.host());
  EXPECT_LT(difference(moved.normals, columns(rest_.normals)), 2e-7);
}

TEST_P(WarpTest, ARigidMotionOfAllNodesMovesEverythingRigidly) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Eigen::Vector3d t(30, -200, 11);
  const auto affine = everywhere(R, t);
  const Columns points = (R * columns(rest_.points)).colwise() + t;
  const Columns normals = R * columns(rest_.normals);
  const auto reference = warp_reference(rest_, influences_, array(nodes_), affine);
  const auto moved = on_device(affine);
  EXPECT_LT(difference(moved.points, points), 1e-3) << "mm, at a distance of a metre";
  EXPECT_LT(difference(moved.normals, normals), 1e-6);
  EXPECT_LT(difference(reference.points, points), 1e-3);
  EXPECT_LT(difference(reference.normals, normals), 1e-6);
}

// A normal stays perpendicular to what it was perpendicular to: under x -> A x it turns with A^-T.
TEST_P(WarpTest, AShearAndAMirrorTurnNormalsWithTheCofactors) {
  Eigen::Matrix3d shear;
  shear << 1, 0.7, 0, 0, 1.3, -0.2, 0.1, 0, 0.8;
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  for (const Eigen::Matrix3d& A : {shear, mirror}) {
    const auto moved = on_device(everywhere(A, Eigen::Vector3d::Zero()));
    EXPECT_LT(difference(moved.points, A * columns(rest_.points)), 1e-3);
    Columns expected = A.determinant() * A.inverse().transpose() * columns(rest_.normals);
    for (auto column : expected.colwise()) column = column.stableNormalized().eval();
    EXPECT_LT(difference(moved.normals, expected), 1e-5);
  }
}

TEST_P(WarpTest, TheDeviceAgreesWithTheReference) {
  for (const double size : {0.01, 0.3}) {
    const auto affine = random_forms(size, 100 * size);
    const auto moved = on_device(affine);
    const auto expected = warp_reference(rest_, influences_, array(nodes_), affine);
    EXPECT_LT(difference(moved.points, columns(expected.points)), 1e-3);
    EXPECT_LT(difference(moved.normals, columns(expected.normals)), 1e-4);
  }
}

TEST_P(WarpTest, PointsAloneGoWhereTheyGoWithTheirNormals) {
  const auto affine = random_forms(0.1, 10);
  Array<float> alone(rest_.points.size());
  warp_points(device_, rest_.points, influences_, array(nodes_), affine, alone);
  EXPECT_EQ(alone.host(), on_device(affine).points.host());
}

TEST_P(WarpTest, NormalsStayOfUnitLengthOrZero) {
  const auto moved = columns(on_device(random_forms(0.2, 10)).normals);
  for (Eigen::Index i = 0; i < kPoints; ++i)
    EXPECT_NEAR(moved.col(i).norm(), i == 7 ? 0 : 1, 1e-6) << "point " << i;
}

TEST_P(WarpTest, ACollapsedMatrixGivesNoNaN) {
  const auto moved = on_device(everywhere(Eigen::Matrix3d::Zero(), Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(columns(moved.normals).allFinite());
  EXPECT_TRUE(columns(moved.points).allFinite());
}

TEST_P(WarpTest, NothingIsMovedWhenThereIsNothing) {
  rest_ = {};
  influences_ = {4, {}, {}};
  EXPECT_TRUE(on_device(everywhere(Eigen::Matrix3d::Identity(), {0, 0, 1})).points.host().empty());
}

}  // namespace
}  // namespace pliant
