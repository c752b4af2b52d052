#include <cmath>
#include <numbers>

#include "experiments/modeller/field.h"
#include "experiments/modeller/figures.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

/// A flat grid of vertices in the plane z = 0, seen from the front.
Mesh flat_sheet(double width, double height) {
  constexpr int columns = 116;
  constexpr int rows = 88;
  Mesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i)
      mesh.vertices.push_back(
          Point((i - columns / 2.0) / columns * width, (j - rows / 2.0) / rows * height, 0).cast<float>());
  }
  const auto index = [](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
      mesh.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
    }
  }
  return mesh;
}

/// Around a vertical cylinder, ends to the back; lengths are kept.
VectorField bend(double radius) {
  return [radius](const Point& p) -> Point {
    const double angle = p.x() / radius;
    return {radius * std::sin(angle) - p.x(), 0, radius * (std::cos(angle) - 1)};
  };
}

VectorField ripple(double height, double length) {
  return [=](const Point& p) -> Point {
    return {0, 0, height * std::sin(2 * std::numbers::pi * (p.x() + 0.4 * p.y()) / length)};
  };
}

/// A fold along a slanting line, rounded over some mm; both sides slope to the back.
VectorField crease(double slope, double rounding) {
  return [=](const Point& p) -> Point {
    const double across = 0.9 * p.x() + 0.436 * p.y();
    return {0, 0, -slope * (std::sqrt(across * across + rounding * rounding) - rounding)};
  };
}

/// Each row to the left by as much as it lies high.
VectorField shear(double gain) {
  return [gain](const Point& p) -> Point { return {gain * p.y(), 0, 0}; };
}

Figure make_sheet(const Parameters& identity) {
  Figure figure{flat_sheet(identity.real("width"), identity.real("height")), {}};
  std::vector<Point> points;
  for (const Eigen::Vector3f& vertex : figure.mesh.vertices) points.push_back(vertex.cast<double>());
  figure.mesh.targets = {target("bend", bend(130), points), target("ripple", ripple(8, 110), points),
                         target("crease", crease(0.5, 8), points),
                         target("stretch", stretch(Point::Zero(), {0.12, -0.04, 0}), points),
                         target("shear", shear(0.15), points)};
  figure.poses = {
      {"bend", "Bent around a vertical cylinder", {{"bend", 1}}},
      {"ripple", "Waves across it", {{"ripple", 1}}},
      {"crease", "Folded along a slanting line", {{"crease", 1}}},
      {"stretch", "Wider by 12 %, less high by 4 %: all across the rays", {{"stretch", 1}}},
      {"shear", "Rows slide over each other: all across the rays", {{"shear", 1}}},
  };
  return figure;
}

}  // namespace

FigureKind sheet_figure() {
  return {"sheet",
          "A single-sided sheet, open at its border",
          {real("width", 320).unit("mm").range(100, 1000).doc("From side to side"),
           real("height", 240).unit("mm").range(100, 1000).doc("From top to bottom")},
          make_sheet};
}

}  // namespace pliant
