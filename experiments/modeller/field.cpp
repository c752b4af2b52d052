#include "experiments/modeller/field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/core/angle.h"

namespace pliant {

using Point = Eigen::Vector3d;

ScalarField bump(const Point& centre, double radius) { return bump(centre, Point::Constant(radius)); }

ScalarField bump(const Point& centre, const Point& radii) {
  return [centre, inverse = Point(radii.cwiseInverse())](const Point& p) {
    return std::exp(-(p - centre).cwiseProduct(inverse).squaredNorm());
  };
}

ScalarField rise(ScalarField value, double low, double high) {
  return [value = std::move(value), low, high](const Point& p) {
    const double t = std::clamp((value(p) - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  };
}

ScalarField coordinate(int axis) {
  return [axis](const Point& p) { return p[axis]; };
}

VectorField shift(const Point& displacement) {
  return [displacement](const Point&) { return displacement; };
}

VectorField turn(const Point& centre, const Point& axis, double degrees) {
  const Eigen::Matrix3d moved =
      Eigen::AngleAxisd(degrees * degree, axis.normalized()).toRotationMatrix() - Eigen::Matrix3d::Identity();
  return [centre, moved](const Point& p) -> Point { return moved * (p - centre); };
}

VectorField away_from(const Point& centre, double distance) {
  return [centre, distance](const Point& p) -> Point { return distance * (p - centre).normalized(); };
}

VectorField stretch(const Point& centre, const Point& gains) {
  return [centre, gains](const Point& p) -> Point { return gains.cwiseProduct(p - centre); };
}

ScalarField operator*(ScalarField a, ScalarField b) {
  return [a = std::move(a), b = std::move(b)](const Point& p) { return a(p) * b(p); };
}

VectorField operator*(ScalarField a, VectorField b) {
  return [a = std::move(a), b = std::move(b)](const Point& p) -> Point { return a(p) * b(p); };
}

VectorField operator+(VectorField a, VectorField b) {
  return [a = std::move(a), b = std::move(b)](const Point& p) -> Point { return a(p) + b(p); };
}

ScalarField inverse(ScalarField field) {
  return [field = std::move(field)](const Point& p) { return 1 - field(p); };
}

VectorField mirrored(VectorField field) {
  return [field = std::move(field)](const Point& p) -> Point {
    const Point image = field({-p.x(), p.y(), p.z()});
    return {-image.x(), image.y(), image.z()};
  };
}

VectorField both_sides(const VectorField& field) { return field + mirrored(field); }

MorphTarget target(const std::string& name, const VectorField& field, const std::vector<Point>& points) {
  MorphTarget made{name, {}};
  made.displacements.reserve(points.size());
  for (const Point& point : points) made.displacements.push_back(field(point).cast<float>());
  return made;
}

}  // namespace pliant
