#include "experiments/modeller/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/core/angle.h"

namespace pliant {
namespace {

/// A tapered capsule: the least, over all its balls, of the distance from the ball. That ball lies where the
/// line to the point meets the surface at a right angle.
class TaperedCapsule {
 public:
  TaperedCapsule(const Bead& from, const Bead& to)
      : from_(from), length_((to.centre - from.centre).norm()), axis_((to.centre - from.centre) / length_) {
    narrowing_ = std::clamp((from.radius - to.radius) / length_, -0.99, 0.99);
    slope_ = narrowing_ / std::sqrt(1 - narrowing_ * narrowing_);
  }

  double distance(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d offset = point - from_.centre;
    const double along = offset.dot(axis_);
    const double squared = std::max(offset.squaredNorm() - along * along, 0.0);
    const double place = std::clamp(along - std::sqrt(squared) * slope_, 0.0, length_);
    const double beyond = along - place;
    return std::sqrt(squared + beyond * beyond) - (from_.radius - place * narrowing_);
  }

 private:
  Bead from_;
  double length_;
  Eigen::Vector3d axis_;
  double narrowing_;  // mm of radius a mm along the axis
  double slope_;
};

}  // namespace

Eigen::Matrix3d turned(double x, double y, double z) {
  return (Eigen::AngleAxisd(z * degree, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(y * degree, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(x * degree, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Shape ball(const Eigen::Vector3d& centre, double radius) {
  return {[=](const Eigen::Vector3d& point) { return (point - centre).norm() - radius; }, centre, radius};
}

Shape ellipsoid(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii,
                const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d inverse = radii.cwiseInverse();
  const Eigen::Matrix3d back = rotation.transpose();
  const double least = radii.minCoeff();
  // To first order: the value of the quadric, whose zeros are the surface, over the length of its gradient.
  const auto distance = [=](const Eigen::Vector3d& point) {
    const Eigen::Vector3d scaled = (back * (point - centre)).cwiseProduct(inverse);
    const double value = scaled.norm();
    const double gradient = scaled.cwiseProduct(inverse).norm();
    return gradient < 1e-9 ? -least : value * (value - 1) / gradient;
  };
  return {distance, centre, radii.maxCoeff()};
}

Shape rounded_box(const Eigen::Vector3d& centre, const Eigen::Vector3d& half_sizes, double rounding,
                  const Eigen::Matrix3d& rotation) {
  const Eigen::Vector3d core = half_sizes.array() - rounding;
  const Eigen::Matrix3d back = rotation.transpose();
  const auto distance = [=](const Eigen::Vector3d& point) {
    const Eigen::Vector3d beyond = (back * (point - centre)).cwiseAbs() - core;
    return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0) - rounding;
  };
  return {distance, centre, half_sizes.norm()};
}

Shape tube(const std::vector<Bead>& beads, double blend) {
  std::vector<TaperedCapsule> links;
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    if (i > 0) links.emplace_back(beads[i - 1], beads[i]);
    box.extend(beads[i].centre);
  }
  double bound = 0;
  for (const Bead& bead : beads) bound = std::max(bound, (bead.centre - box.center()).norm() + bead.radius);
  const auto distance = [=](const Eigen::Vector3d& point) {
    double least = std::numeric_limits<double>::max();
    for (const TaperedCapsule& link : links) least = smooth_minimum(least, link.distance(point), blend);
    return least;
  };
  return {distance, box.center(), bound + blend};
}

Shape half_space(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d unit = normal.normalized();
  return {[=](const Eigen::Vector3d& place) { return unit.dot(place - point); }, point,
          std::numeric_limits<double>::infinity()};
}

Shape mirrored(const Shape& shape) {
  const auto image = [](const Eigen::Vector3d& point) {
    return Eigen::Vector3d(-point.x(), point.y(), point.z());
  };
  return {[distance = shape.distance, image](const Eigen::Vector3d& point) { return distance(image(point)); },
          image(shape.centre), shape.bound};
}

double smooth_minimum(double a, double b, double blend) {
  const double overlap = blend - std::abs(a - b);
  return std::min(a, b) - (overlap > 0 ? overlap * overlap / (4 * blend) : 0);
}

}  // namespace pliant
