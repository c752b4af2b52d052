#include "experiments/view/surface_attachment.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace pliant {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// 41 x 41 points, 3 mm apart, of a slope around (0, 0, 600).
Points slope() {
  Points points;
  for (int v = -20; v <= 20; ++v)
    for (int u = -20; u <= 20; ++u) {
      const auto x = static_cast<float>(3 * u);
      points.emplace_back(x, 3.0F * static_cast<float>(v), 600 + 0.3F * x);
    }
  return points;
}

/// Points within 40 mm of a place move; the others stay.
Points moved_near(Points points, const Eigen::Vector3f& place, const Eigen::Isometry3d& motion) {
  for (Eigen::Vector3f& point : points)
    if ((point - place).norm() < 40) point = (motion * point.cast<double>()).cast<float>();
  return points;
}

constexpr double reach = 30;  // mm
const Eigen::Vector3d anchor(30, -12, 609);

double shift_of(const Eigen::Isometry3d& motion, const Eigen::Vector3d& point) {
  return (motion * point - point).norm();
}

TEST(SurfaceAttachment, ShiftsWithItsPartOfTheSurface) {
  const Points rest = slope();
  const SurfaceAttachment attachment(rest, anchor, reach);
  EXPECT_LT(shift_of(attachment.motion(rest), anchor), 1e-6);
  const Eigen::Isometry3d shift(Eigen::Translation3d(0, 6, -8));  // 10 mm
  const Eigen::Isometry3d motion = attachment.motion(moved_near(rest, anchor.cast<float>(), shift));
  EXPECT_LT((motion.matrix() - shift.matrix()).norm(), 1e-3);
  const Points elsewhere = moved_near(rest, {-50, 40, 585}, shift);
  EXPECT_LT(shift_of(attachment.motion(elsewhere), anchor), 1e-6) << "the other cheek";
}

TEST(SurfaceAttachment, TurnsWithIt) {
  const Points rest = slope();
  const SurfaceAttachment attachment(rest, anchor, reach);
  const Eigen::Isometry3d turn = Eigen::Translation3d(anchor + Eigen::Vector3d(10, 0, 0)) *
                                 Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized()) *
                                 Eigen::Translation3d(-anchor);
  const Eigen::Isometry3d motion = attachment.motion(moved_near(rest, anchor.cast<float>(), turn));
  EXPECT_LT((motion.matrix() - turn.matrix()).norm(), 1e-3);
  EXPECT_NEAR(shift_of(motion, anchor), 10, 1e-3);
}

TEST(SurfaceAttachment, IsCarriedByTheNearestPointsOnly) {
  Points points = slope();
  const SurfaceAttachment attachment(points, anchor, 1000);
  std::vector<float> distances;
  for (const Eigen::Vector3f& point : points) distances.push_back((point - anchor.cast<float>()).norm());
  std::nth_element(distances.begin(), distances.begin() + SurfaceAttachment::most, distances.end());
  const float farthest = distances[SurfaceAttachment::most];
  for (Eigen::Vector3f& point : points)
    if ((point - anchor.cast<float>()).norm() > farthest) point.x() += 100;
  EXPECT_LT(shift_of(attachment.motion(points), anchor), 1e-6);
}

TEST(SurfaceAttachment, StaysWithoutPointsAndOnlyShiftsWhereTheyTellNoTurn) {
  const Points far{{0, 0, 900}, {10, 0, 900}, {0, 10, 900}};
  EXPECT_TRUE(SurfaceAttachment(far, anchor, reach).motion(far).matrix().isIdentity(0));
  Points line;
  for (int i = -4; i <= 4; ++i)
    line.push_back(anchor.cast<float>() + Eigen::Vector3f(static_cast<float>(i), 0, 0));
  const SurfaceAttachment attachment(line, anchor, reach);
  Points moved;
  for (const Eigen::Vector3f& point : line)
    moved.emplace_back(anchor.x(), point.x() - anchor.x() + 5, point.z());
  const Eigen::Isometry3d motion = attachment.motion(moved);
  EXPECT_TRUE(motion.linear().isIdentity(0));
  EXPECT_NEAR(motion.translation().y(), 5 - anchor.y(), 1e-4);
}

}  // namespace
}  // namespace pliant
