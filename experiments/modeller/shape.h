#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

namespace pliant {

/// A solid as a function: the distance of a point from its surface in mm, negative inside; exact or close to
/// it near the surface. Beyond `bound` no point of it lies.
struct Shape {
  std::function<double(const Eigen::Vector3d&)> distance;
  Eigen::Vector3d centre;  ///< mm, of a ball around it
  double bound;            ///< mm, radius of that ball
};

/// A point of a tube: its middle and how thick it is there, in mm.
struct Bead {
  Eigen::Vector3d centre;
  double radius;
};

/// Turns about x, then y, then z, in degrees.
Eigen::Matrix3d turned(double x, double y, double z);

Shape ball(const Eigen::Vector3d& centre, double radius);
/// `rotation` turns its axes, along which `radii` are.
Shape ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii,
                const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());
/// Half as long along its axes as `half_sizes`, edges included, which are rounded by `rounding`.
Shape rounded_box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_sizes, double rounding,
                  const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity());
/// All balls whose middles lie between two neighbouring beads, their radii between those of the beads: a
/// chain of tapered capsules. The chain is smooth where it turns by `blend` mm.
Shape tube(const std::vector<Bead>& beads, double blend = 0);
/// All that is behind the plane through a point, as seen along its normal. It has no end: to be cut away.
Shape half_space(const Eigen::Vector3d& point, const Eigen::Vector3d& normal);

/// Its image in the plane x = 0.
Shape mirrored(const Shape& shape);

/// The union of two distances whose edge is rounded by `blend` mm: the quadratic polynomial minimum of
/// Quilez, "Smooth minimum", 2013, https://iquilezles.org/articles/smin. From `blend` apart on it is the
/// minimum itself.
double smooth_minimum(double a, double b, double blend);

}  // namespace pliant
