#include <algorithm>
#include <cmath>

#include "experiments/modeller/implicit.h"

namespace pliant {
namespace {

double smooth_step(double t) {
  const double share = std::clamp(t, 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

}  // namespace

Solid& Solid::add(const Shape& shape, double blend) {
  steps_.push_back({Kind::add, shape, blend});
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(shape.bound + blend);
  box_.extend(Eigen::AlignedBox3d(shape.centre - reach, shape.centre + reach));
  return *this;
}

Solid& Solid::cut(const Shape& shape, double blend) {
  steps_.push_back({Kind::cut, shape, blend});
  return *this;
}

Solid& Solid::add_pair(const Shape& shape, double blend) {
  return add(shape, blend).add(mirrored(shape), blend);
}

Solid& Solid::cut_pair(const Shape& shape, double blend) {
  return cut(shape, blend).cut(mirrored(shape), blend);
}

Solid& Solid::raise(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, double height) {
  constexpr double negligible = 4;  // radii away
  const Eigen::Vector3d inverse = radii.cwiseInverse();
  const auto bump = [=](const Eigen::Vector3d& point) {
    return height * std::exp(-(point - centre).cwiseProduct(inverse).squaredNorm());
  };
  steps_.push_back({Kind::raise, {bump, centre, negligible * radii.maxCoeff()}, 0});
  return *this;
}

Solid& Solid::raise_pair(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, double height) {
  return raise(centre, radii, height).raise({-centre.x(), centre.y(), centre.z()}, radii, height);
}

Solid& Solid::press(const Shape& shape, double depth, double rim) {
  steps_.push_back({Kind::press, shape, rim, depth});
  return *this;
}

Solid& Solid::press_pair(const Shape& shape, double depth, double rim) {
  return press(shape, depth, rim).press(mirrored(shape), depth, rim);
}

double Solid::distance(const Eigen::Vector3d& point) const {
  double distance = std::numeric_limits<double>::max();
  for (const Step& step : steps_) {
    // Most steps are too far away to matter. A shape's distance counts as no less than the ball's around it,
    // so that to leave it out changes nothing.
    const double beyond = (point - step.shape.centre).norm() - step.shape.bound;
    switch (step.kind) {
      case Kind::add:
        if (beyond >= distance + step.blend) break;
        distance = smooth_minimum(distance, std::max(beyond, step.shape.distance(point)), step.blend);
        break;
      case Kind::cut:
        if (beyond >= step.blend - distance) break;
        distance = -smooth_minimum(-distance, std::max(beyond, step.shape.distance(point)), step.blend);
        break;
      case Kind::raise:
        if (beyond < 0) distance -= step.shape.distance(point);
        break;
      case Kind::press:
        if (beyond < 0) distance += step.depth * smooth_step(-step.shape.distance(point) / step.blend);
        break;
    }
  }
  return distance;
}

Shape Solid::shape() const {
  return {[solid = *this](const Eigen::Vector3d& point) { return solid.distance(point); }, box_.center(),
          box_.diagonal().norm() / 2};
}

}  // namespace pliant
