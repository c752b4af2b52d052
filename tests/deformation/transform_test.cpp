#include "framework/deformation/node_transform.h"

#include <ceres/jet.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "framework/deformation/quaternion.h"
#include "framework/deformation/warp.h"

namespace pliant {
namespace {

using Form = Eigen::Matrix<double, 3, 4>;  // columns of R - I, then t
using Step = Eigen::Matrix<double, 6, 1>;

TEST(NodeTransform, AffineHasTheTwelveNumbersOfItsForm) {
  Registry registry;
  register_transforms(registry);
  const auto affine = registry.make<NodeTransform>(Parameters("affine", {}));
  EXPECT_EQ(affine->unknowns, affine_size);
  EXPECT_TRUE(affine->is_free());
}

TEST(NodeTransform, QuaternionHasSixFreeNumbers) {
  Registry registry;
  register_transforms(registry);
  const auto quaternion = registry.make<NodeTransform>(Parameters("quaternion", {}));
  EXPECT_EQ(quaternion->unknowns, 6);
  EXPECT_FALSE(quaternion->is_free());
}

class QuaternionTest : public testing::Test {
 protected:
  static Form form_of(const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
    Form form;
    form << R - Eigen::Matrix3d::Identity(), t;
    return form;
  }
  static Eigen::Matrix3d matrix_of(const Form& form) {
    return form.leftCols<3>() + Eigen::Matrix3d::Identity();
  }
  double normal() { return normal_(generator_); }
  template <class Matrix>
  Matrix random(double scale) {
    return Matrix::NullaryExpr([&] { return scale * normal(); });
  }

  /// Every branch: no turn, tiny ones, half turns about each axis, and any.
  std::vector<Form> rotations() {
    std::vector<Eigen::Matrix3d> all{Eigen::Matrix3d::Identity()};
    for (int axis = 0; axis < 3; ++axis)
      for (const double angle : {1e-7, 1e-3, 1.0, M_PI, -3.1})
        all.push_back(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix());
    for (int i = 0; i < 40; ++i)
      all.push_back(Eigen::Quaterniond(random<Eigen::Vector4d>(1)).normalized().toRotationMatrix());
    std::vector<Form> forms;
    for (const auto& R : all) forms.push_back(form_of(R, random<Eigen::Vector3d>(30)));
    return forms;
  }

  static Form retract(const Form& form, const Step& step) {
    Form moved;
    transform_.retract(form.data(), step.data(), moved.data());
    return moved;
  }
  static Form nearest(const Form& form) {
    Form found;
    transform_.nearest(form.data(), found.data());
    return found;
  }
  /// By singular values: the reference.
  static Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& A) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
    return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
  }
  static double distance_from_rotations(const Eigen::Matrix3d& R) {
    return std::max((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), std::abs(R.determinant() - 1));
  }

  inline static const NodeTransform transform_ = quaternion_transform();

 private:
  std::mt19937 generator_{1};
  std::normal_distribution<double> normal_;
};

TEST_F(QuaternionTest, PullsBackByTheDerivativeOfAStep) {
  using Jet = ceres::Jet<double, 6>;
  for (const Form& form : rotations()) {
    std::array<Jet, affine_size> at, moved;
    std::array<Jet, 6> step;
    for (std::size_t i = 0; i < affine_size; ++i) at[i] = Jet(form.data()[i]);
    for (int i = 0; i < 6; ++i) step[static_cast<std::size_t>(i)] = Jet(0, i);
    quaternion_retract(at.data(), step.data(), moved.data());
    Eigen::Matrix<double, affine_size, 6> T;
    for (int i = 0; i < affine_size; ++i) T.row(i) = moved[static_cast<std::size_t>(i)].v.transpose();
    const auto v = random<Eigen::Matrix<double, affine_size, 1>>(1);
    Step pulled;
    transform_.pull_back(form.data(), v.data(), pulled.data());
    EXPECT_LT((pulled - T.transpose() * v).norm(), 1e-12) << form;
  }
}

TEST_F(QuaternionTest, AStepTurnsAndMovesAsTheQuaternionOfItDoes) {
  for (const Form& form : rotations())
    for (const double size : {0.0, 1e-4, 0.3, 5.0}) {
      const Step step = random<Step>(size);
      const Eigen::Vector3d half = step.head<3>() / 2;
      const Eigen::Quaterniond turn = Eigen::Quaterniond(1, half.x(), half.y(), half.z()).normalized();
      const Form moved = retract(form, step);
      EXPECT_LT((matrix_of(moved) - turn * matrix_of(form)).norm(), 1e-14);
      EXPECT_EQ(moved.col(3), form.col(3) + step.tail<3>());
    }
}

TEST_F(QuaternionTest, StaysARotationHoweverManyStepsInSinglePrecision) {
  std::array<float, affine_size> form{}, moved{};
  for (int i = 0; i < 5000; ++i) {
    std::array<float, 6> step{};
    for (float& value : step) value = static_cast<float>(0.2 * normal());
    quaternion_retract(form.data(), step.data(), moved.data());
    form = moved;
    const Eigen::Matrix3d R =
        matrix_of(Eigen::Map<const Eigen::Matrix<float, 3, 4>>(form.data()).cast<double>());
    ASSERT_LT(distance_from_rotations(R), 3e-6) << "after step " << i;
  }
}

TEST_F(QuaternionTest, SmallTurnsKeepTheirDigitsInSinglePrecision) {
  for (const double size : {1e-2, 1e-4, 1e-6, 1e-9}) {
    const Form before = form_of(Eigen::AngleAxisd(size, Eigen::Vector3d(1, 2, 2) / 3).toRotationMatrix(),
                                Eigen::Vector3d(1, 2, 3));
    const Step step = random<Step>(size);
    const Form expected = retract(before, step);
    const Eigen::Matrix<float, 3, 4> given = before.cast<float>();
    const Eigen::Matrix<float, 6, 1> given_step = step.cast<float>();
    Eigen::Matrix<float, 3, 4> moved;
    quaternion_retract(given.data(), given_step.data(), moved.data());
    EXPECT_LT((moved.leftCols<3>().cast<double>() - expected.leftCols<3>()).norm(),
              1e-6 * expected.leftCols<3>().norm())
        << size;
  }
}

TEST_F(QuaternionTest, TheNearestRotationIsThatOfTheSingularValues) {
  for (int i = 0; i < 200; ++i) {
    Eigen::Matrix3d A = random<Eigen::Matrix3d>(1);
    const Eigen::Vector3d singular = A.jacobiSvd().singularValues();
    // Turned inside out, the two smallest values decide; near a tie any rotation between is as good.
    const double gap = A.determinant() > 0 ? singular[1] + singular[2] : singular[1] - singular[2];
    if (gap < 0.1 * singular[0]) continue;
    const Form form = form_of(A, random<Eigen::Vector3d>(30));
    const Form found = nearest(form);
    EXPECT_LT((matrix_of(found) - nearest_rotation(A)).norm(), 1e-9) << A;
    EXPECT_EQ(found.col(3), form.col(3));
  }
}

TEST_F(QuaternionTest, ARotationIsNearestToItself) {
  for (const Form& form : rotations()) {
    EXPECT_LT((nearest(form) - form).norm(), 1e-14);
    const Eigen::Matrix<float, 3, 4> given = form.cast<float>();
    Eigen::Matrix<float, 3, 4> found;
    quaternion_nearest(given.data(), found.data());
    EXPECT_LT((found - given).norm(), 1e-6) << "in single precision";
  }
  EXPECT_TRUE(nearest(Form::Zero()).isZero(0)) << "rest stays rest to the bit";
}

TEST_F(QuaternionTest, SomeRotationIsNearestWhereManyAre) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, 1, -1).asDiagonal();
  for (const Eigen::Matrix3d& A :
       {Eigen::Matrix3d(Eigen::Matrix3d::Zero()), Eigen::Matrix3d(-Eigen::Matrix3d::Identity()), mirror,
        Eigen::Matrix3d(Eigen::Vector3d(1e6, 0, 0).asDiagonal())})
    EXPECT_LT(distance_from_rotations(matrix_of(nearest(form_of(A, Eigen::Vector3d::Zero())))), 1e-12) << A;
}

TEST_F(QuaternionTest, WhatIsNoNumberStaysNone) {
  for (int entry = 0; entry < affine_size; ++entry) {
    Form form = Form::Zero();
    form.data()[entry] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(nearest(form).allFinite()) << entry;
  }
}

}  // namespace
}  // namespace pliant
