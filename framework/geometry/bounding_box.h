#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace pliant {

/// The box along the axes around points; an empty one when there is no point.
template <class Point>
Eigen::AlignedBox<typename Point::Scalar, Point::RowsAtCompileTime> box_around(
    const std::vector<Point>& points) {
  Eigen::AlignedBox<typename Point::Scalar, Point::RowsAtCompileTime> box;
  for (const Point& point : points) box.extend(point);
  return box;
}

}  // namespace pliant
