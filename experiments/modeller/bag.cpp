#include <cmath>
#include <numbers>

#include "experiments/modeller/field.h"
#include "experiments/modeller/figures.h"
#include "experiments/modeller/implicit.h"
#include "experiments/modeller/skeleton.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

/// Half the size of the bag without handles, in mm.
struct BagMeasures {
  double width;
  double height;
  double thickness;
};

/// An arch above the bag, in front or behind.
Shape handle(const BagMeasures& bag, double z) {
  constexpr int links = 24;
  std::vector<Bead> beads;
  for (int i = 0; i <= links; ++i) {
    const double angle = std::numbers::pi * i / links;
    const double rise = 70 * std::pow(std::sin(angle), 0.8);
    beads.push_back(
        {{0.4 * bag.width * std::cos(angle), bag.height - 16 + rise, z * (1 - 0.3 * std::sin(angle))}, 7});
  }
  return tube(beads, 2);
}

Solid bag_solid(const BagMeasures& bag) {
  const double w = bag.width;
  const double h = bag.height;
  const double t = bag.thickness;
  Solid solid;
  // Filled below, thin at the seam above, drawn in at the sides.
  solid.add(rounded_box({0, -4, 0}, {0.9 * w, h - 10, 0.5 * t}, 0.48 * t), 0);
  solid.add(ellipsoid({0, -0.3 * h, 0}, {1.02 * w, 0.78 * h, 1.1 * t}), 55);
  solid.add(tube({{{-0.86 * w, h - 12, 0}, 11}, {{0, h - 20, 0}, 11}, {{0.86 * w, h - 12, 0}, 11}}, 6), 22);
  for (const double side : {1.0, -1.0}) {
    solid.add(handle(bag, side * 0.42 * t), 6);
    // The seam, and wrinkles of cloth where it hangs from the handles and is pulled to the corners.
    solid.raise({0, h - 36, side * 0.5 * t}, {1.4 * w, 5, 0.4 * t}, -4);
    solid.raise_pair({0.46 * w, 0.38 * h, side * 0.85 * t}, {9, 0.36 * h, 0.5 * t}, -5);
    solid.raise_pair({0.66 * w, 0.3 * h, side * 0.7 * t}, {10, 0.4 * h, 0.5 * t}, 4);
    solid.raise_pair({0.78 * w, -0.72 * h, side * 0.6 * t}, {0.2 * w, 9, 0.5 * t}, -5);
    solid.raise({0.1 * w, 0.1 * h, side * t}, {0.3 * w, 8, 0.5 * t}, -3);
  }
  return solid;
}

/// Bands across the bag, each of which bends a part of the fold.
Skeleton bag_skeleton(const BagMeasures& bag) {
  constexpr double blend = 30;
  const double fold = -0.12 * bag.height;
  const auto band = [](double low, double high) { return Bone{{0, low, 0}, {0, high, 0}, 0}; };
  Skeleton skeleton;
  skeleton.add("lower", "", band(-bag.height, fold - 25), blend);
  skeleton.add("fold_1", "lower", band(fold - 20, fold + 20), blend);
  skeleton.add("fold_2", "fold_1", band(fold + 25, fold + 65), blend);
  skeleton.add("upper", "fold_2", band(fold + 70, 1.6 * bag.height), blend);
  return skeleton;
}

VectorField pressed(const BagMeasures& bag) {
  const Point fist(0, -0.1 * bag.height, bag.thickness);
  const Point middle(0, -0.3 * bag.height, 0);
  return bump(fist, {60, 55, 1.3 * bag.thickness}) * shift({0, 0, -1.15 * bag.thickness}) +
         bump(middle, {1.8 * bag.width, 1.1 * bag.height, 400}) * stretch(middle, {0.08, 0.06, 0.2});
}

Figure make_bag(const Parameters& identity) {
  const BagMeasures bag{identity.real("width") / 2, identity.real("height") / 2,
                        identity.real("thickness") / 2};
  Figure figure{polygonise(bag_solid(bag), {5}), {}};
  std::vector<Point> points;
  for (const Eigen::Vector3f& vertex : figure.mesh.vertices) points.push_back(vertex.cast<double>());
  figure.mesh.targets = {target("pressed", pressed(bag), points)};
  bag_skeleton(bag).bind(figure.mesh);
  figure.poses = {
      {"pressed", "A fist pressed into its front, the sides bulge", {{"pressed", 1}}},
      {"folded",
       "Its upper half bent to the front",
       {},
       {{"fold_1", {32, 0, 0}}, {"fold_2", {32, 0, 0}}, {"upper", {32, 0, 0}}}},
  };
  return figure;
}

}  // namespace

FigureKind bag_figure() {
  return {"bag",
          "A soft bag with two handles",
          {real("width", 320).unit("mm").range(240, 420).doc("From side to side"),
           real("height", 260).unit("mm").range(200, 340).doc("From its bottom to its seam"),
           real("thickness", 110).unit("mm").range(80, 150).doc("From front to back")},
          make_bag};
}

}  // namespace pliant
