#include "experiments/training/head_sitter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/modeller/pose.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

double smooth_step(double from, double to, double value) {
  const double share = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

/// Where hair grows, 0 to 1: behind a line from the top of the brow over the ears to the neck.
double hair_share(const Point& p) { return smooth_step(0, 30, 0.6 * p.y() - 0.8 * p.z()); }

struct Dent {
  Point centre;
  double radius;
  double height;
};

Dent random_dent(double strength, Draw& draw) {
  const Point direction = Point(draw.normal(), draw.normal(), draw.normal()).normalized();
  return {direction.cwiseProduct(Point(75, 105, 90)), draw.uniform(25, 60),
          strength * std::clamp(3 * draw.normal(), -6.0, 6.0)};
}

}  // namespace

Figure random_figure(const FigureKind& kind, Draw& draw) {
  std::vector<Parameters::Value> values;
  for (const Parameter& row : kind.identity.rows())
    values.push_back({row.name(), draw.uniform(*row.lowest(), *row.highest())});
  return kind.make(Parameters("", std::move(values)));
}

std::vector<Point> random_form(const Figure& figure, Draw& draw) {
  FigurePose form = rest_of(figure.mesh);
  for (const NamedPose& pose : figure.poses)
    if (draw.chance(0.35)) add_pose(figure.mesh, pose, draw.uniform(0, 1), form);
  return figure.mesh.deform(on_top(figure.mesh.rest(), form));
}

void vary_head(std::vector<Point>& vertices, double strength, Draw& draw) {
  if (strength == 0) return;
  Point stretch;
  for (int axis = 0; axis < 3; ++axis)
    stretch[axis] = 1 + strength * std::clamp(0.03 * draw.normal(), -0.07, 0.07);
  std::array<Dent, 6> dents;
  for (Dent& dent : dents) dent = random_dent(strength, draw);
  const double hair = draw.chance(0.6) ? strength * draw.uniform(0, 30) : 0;
  for (Point& p : vertices) {
    const Point outwards = p.normalized();
    double height = hair * hair_share(p);
    for (const Dent& dent : dents)
      height += dent.height * std::exp(-(p - dent.centre).squaredNorm() / (dent.radius * dent.radius));
    p = p.cwiseProduct(stretch) + height * outwards;
  }
}

void bend_neck(std::vector<Point>& vertices, const Eigen::Isometry3d& camera_from_head,
               const Eigen::Isometry3d& camera_from_shoulders) {
  const Point pivot(0, -95, -25);
  const Point shift = camera_from_head * pivot - camera_from_shoulders * pivot;
  for (Point& p : vertices) {
    const double share = smooth_step(-90, -170, p.y());
    const Point with_head = camera_from_head * p;
    p = with_head + share * (camera_from_shoulders * p + shift - with_head);
  }
}

}  // namespace pliant
