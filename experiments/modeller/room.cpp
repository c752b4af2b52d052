#include <array>
#include <cmath>
#include <map>

#include "experiments/modeller/field.h"
#include "experiments/modeller/figures.h"
#include "experiments/modeller/shape.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

/// Appends the surface of a grid of cells, whose corners `place` puts: (0, 0, 0) to (1, 1, 1) over the whole.
template <class Place>
void add_grid(const Eigen::Vector3i& cells, const Place& place, Mesh& mesh) {
  std::map<std::array<int, 3>, int> known;
  const auto corner = [&](const Eigen::Vector3i& at) {
    const auto [entry, is_new] =
        known.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(mesh.vertices.size()));
    const Point share = at.cast<double>().cwiseQuotient(cells.cast<double>());
    if (is_new) mesh.vertices.push_back(Point(place(share)).template cast<float>());
    return entry->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3i right = Eigen::Vector3i::Unit((axis + 1) % 3);
    const Eigen::Vector3i up = Eigen::Vector3i::Unit((axis + 2) % 3);
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < cells.dot(right); ++i)
        for (int j = 0; j < cells.dot(up); ++j) {
          const Eigen::Vector3i low = side * cells[axis] * Eigen::Vector3i::Unit(axis) + i * right + j * up;
          const Eigen::Vector3i& first = side == 1 ? right : up;  // counter-clockwise from outside
          const Eigen::Vector3i& second = side == 1 ? up : right;
          mesh.triangles.emplace_back(corner(low), corner(low + first), corner(low + right + up));
          mesh.triangles.emplace_back(corner(low), corner(low + right + up), corner(low + second));
        }
  }
}

struct Block {
  Point centre;
  Point half_size;  ///< mm along its own axes
  double turn = 0;  ///< degrees, about the vertical
};

void add_block(const Block& block, Mesh& mesh) {
  constexpr double spacing = 70;
  const Eigen::Matrix3d rotation = turned(0, block.turn, 0);
  const Eigen::Vector3i cells = (2 * block.half_size / spacing).array().ceil().max(2).cast<int>();
  add_grid(
      cells,
      [&](const Point& share) -> Point {
        return block.centre + rotation * (2 * share - Point::Ones()).cwiseProduct(block.half_size);
      },
      mesh);
}

void add_ball(const Point& centre, double radius, Mesh& mesh) {
  add_grid(
      Eigen::Vector3i::Constant(18),
      [&](const Point& share) -> Point {
        // Even angles rather than even lengths on the faces of the cube, so that cells are alike.
        const Point side = ((share - Point::Constant(0.5)) * std::acos(0.0)).array().tan();
        return centre + radius * side.normalized();
      },
      mesh);
}

/// A corner of a room with furniture. Things stand 2 mm apart: none meets another.
Figure make_room(const Parameters& identity) {
  const double width = identity.real("width");
  const double depth = identity.real("depth");
  constexpr double height = 2000;
  constexpr double wall = 30;  // half its thickness
  constexpr double gap = 2;
  Figure figure;
  Mesh& mesh = figure.mesh;
  add_block({{0, -wall, 0}, {width / 2, wall, depth / 2}}, mesh);
  const double high = height / 2;
  add_block({{0, high + gap, wall - depth / 2}, {width / 2, high, wall}}, mesh);
  const double along = (depth - 2 * wall - gap) / 2;
  add_block({{wall - width / 2, high + gap, depth / 2 - along}, {wall, high, along}}, mesh);
  const auto stand = [&](const Point& foot, const Point& half_size, double turn) {
    add_block({foot + Point(0, half_size.y() + gap, 0), half_size, turn}, mesh);
  };
  stand({0.14 * width, 0, -0.22 * depth}, {330, 360, 230}, 12);   // a chest,
  stand({0.14 * width, 722, -0.22 * depth}, {130, 90, 110}, 40);  // a box on it,
  stand({-0.27 * width, 0, -0.1 * depth}, {210, 240, 210}, -25);  // a stool,
  stand({0.37 * width, 0, -0.05 * depth}, {120, 700, 160}, -8);   // a shelf
  stand({-0.02 * width, 0, 0.18 * depth}, {180, 90, 140}, 30);    // and a case
  const std::size_t first = mesh.vertices.size();
  add_ball({-0.27 * width, 482 + 2 * gap + 150, -0.1 * depth}, 150, mesh);
  const std::size_t last = mesh.vertices.size();
  add_ball({0.2 * width, gap + 200, 0.15 * depth}, 200, mesh);
  std::vector<Point> points;
  for (const Eigen::Vector3f& vertex : mesh.vertices) points.push_back(vertex.cast<double>());
  MorphTarget lifted = target("lift", shift({0, 250, 0}), points);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (i < first || i >= last) lifted.displacements[i].setZero();
  mesh.targets = {lifted};
  figure.poses = {{"lift", "The ball on the stool goes up by 250 mm", {{"lift", 1}}}};
  return figure;
}

}  // namespace

FigureKind room_figure() {
  return {"room",
          "The corner of a room, with furniture and balls",
          {real("width", 2800).unit("mm").range(2400, 4000).doc("From side to side"),
           real("depth", 2200).unit("mm").range(2000, 3000).doc("From the wall at the back to the front")},
          make_room};
}

}  // namespace pliant
