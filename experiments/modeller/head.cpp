#include "experiments/modeller/head.h"

#include "experiments/modeller/figures.h"
#include "experiments/modeller/implicit.h"

namespace pliant {
namespace {

// Sizes follow the means that anthropometry gives for adults: Farkas, "Anthropometry of the head and face",
// 1994.
ParameterTable identity_table() {
  return {
      real("width", 150).unit("mm").range(138, 164).doc("Breadth of the skull"),
      real("jaw", 100).unit("mm").range(90, 120).doc("Breadth between the corners of the jaw"),
      real("chin", 0).unit("mm").range(-4, 6).doc("How far the chin stands out beyond the usual"),
      real("nose_length", 48).unit("mm").range(42, 56).doc("From between the eyes to below the nose"),
      real("brow", 3).unit("mm").range(0, 6).doc("How far the brow stands out"),
      real("cheek_fullness", 0).unit("mm").range(-3, 6).doc("How far the cheeks are filled out"),
      real("lips", 1).range(0.6, 1.5).doc("Thickness of the lips, of the usual one"),
  };
}

void add_skull(Solid& solid, const HeadMeasures& head) {
  solid.add(ellipsoid({0, 25, -6}, {head.half_width, 87, 97}), 0);
  solid.add(ellipsoid({0, -38, 28}, {59, 78, 57}), 25);
  // Jaw, from below the ear to the chin.
  solid.add_pair(
      tube({{{head.jaw - 15, -52, 2}, 14}, {{head.jaw - 18, -78, 18}, 13}, {{13, -102, 66}, 11}}, 14), 22);
  solid.add(ellipsoid({0, -99, 70 + head.chin}, {19, 15, 16}), 14);
  // Cheekbones and brow.
  solid.add_pair(tube({{{60, -10, 8}, 7}, {{50, -19, 48}, 9}, {{36, -26, 64}, 10}}, 12), 18);
  solid.add_pair(ellipsoid({34, -54, 50}, {24, 30, 24}), 22);
  solid.add_pair(tube({{{6, 15, 79}, 7}, {{28, 18, 76}, 7}, {{50, 7, 56}, 6}}, 8), 14);
  solid.raise_pair({22, 15, 86}, {20, 7, 20}, head.brow);
  solid.raise_pair({47, -54, 55}, {18, 22, 22}, head.cheek_fullness);
}

void add_eyes(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d& eye = head.eye;
  solid.raise_pair(eye + Eigen::Vector3d(-1, 1, 12), {17, 12, 20}, -9);
  solid.raise_pair(eye + Eigen::Vector3d(-17, 4, 14), {8, 10, 14}, -3);
  // The opening of the lids is where a ball above and one below overlap, in front.
  Solid opening;
  opening.add(ball(eye + Eigen::Vector3d(0, -17, 12), 22.2), 0);
  Solid beyond;
  beyond.add(ball(eye, 100), 0).cut(ball(eye + Eigen::Vector3d(0, 19, 12), 24), 0);
  opening.cut(beyond.shape(), 1).cut(half_space(eye + Eigen::Vector3d(0, 0, 4), {0, 0, 1}), 2);
  Solid lids;
  lids.add(ellipsoid(eye, {15.5, 14.2, 15}), 0).cut(opening.shape(), 2);
  solid.add_pair(lids.shape(), 7);
  solid.add_pair(ball(eye, 12.4), 1);
}

void add_nose(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d& tip = head.nose_tip;
  const Eigen::Vector3d root(0, 5, 80);
  const Eigen::Vector3d bridge = 0.5 * (root + tip) + Eigen::Vector3d(0, 0, 1.5);
  solid.add_pair(tube({{{5, 2, 74}, 6}, {tip + Eigen::Vector3d(8, 0, -16), 9}}), 12);
  solid.add(tube({{root, 7}, {bridge, 7}, {tip, 9}, {tip + Eigen::Vector3d(0, -7, -9), 5}}, 6), 10);
  solid.add_pair(ellipsoid(tip + Eigen::Vector3d(11, -3, -11), {6.5, 7.2, 9}, turned(0, 25, 0)), 6);
  solid.cut_pair(ellipsoid(tip + Eigen::Vector3d(6, -6.5, -4), {2.8, 5, 4.2}, turned(-15, 0, 10)), 2.5);
}

void add_mouth(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d& m = head.mouth;
  const double thick = head.lips;
  solid.add(ellipsoid(m + Eigen::Vector3d(0, 2, -25), {34, 28, 24}), 18);
  solid.raise({0, m.y() + 13, m.z() + 4}, {3.2, 7, 8}, -1.6);
  solid.raise_pair({4.8, m.y() + 12, m.z() + 4}, {2.6, 6, 8}, 0.9);
  solid.raise({0, m.y() - 18, m.z()}, {20, 6, 14}, -2.5);
  const auto at = [&](double x, double y, double z) { return Eigen::Vector3d(m + Eigen::Vector3d(x, y, z)); };
  const Eigen::Vector3d corner = head.corner - m;
  const double c = corner.x();
  solid.add(tube({{at(-c, 0.5, corner.z()), 2},
                  {at(-0.5 * c, 5.2, -3), 3.8 * thick},
                  {at(-4, 6.6, 0), 4.6 * thick},
                  {at(4, 6.6, 0), 4.6 * thick},
                  {at(0.5 * c, 5.2, -3), 3.8 * thick},
                  {at(c, 0.5, corner.z()), 2}},
                 3),
            3);
  solid.add(tube({{at(-c, -0.5, corner.z()), 2},
                  {at(-0.5 * c, -7, -4), 4.6 * thick},
                  {at(0, -8.2, -2), 5.6 * thick},
                  {at(0.5 * c, -7, -4), 4.6 * thick},
                  {at(c, -0.5, corner.z()), 2}},
                 3),
            3);
  solid.cut(ellipsoid(m + Eigen::Vector3d(0, 0, -29), {22, 13, 19}), 4);
  solid.cut(ellipsoid(m + Eigen::Vector3d(0, 0, -12), {c, 2.3, 26}), 3);
}

void add_ears(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d middle(head.half_width - 2, -8, -12);
  Solid ear;
  ear.add(ellipsoid(middle, {8, 31, 18}, turned(-12, -22, -8)), 0);
  ear.cut(ellipsoid(middle + Eigen::Vector3d(9, 3, 5), {8, 19, 10}, turned(-12, -22, -8)), 4);
  solid.add_pair(ear.shape(), 5);
}

void add_neck(Solid& solid) {
  solid.add(tube({{{0, -50, -28}, 46}, {{0, -190, -36}, 50}}), 24);
  solid.cut(half_space({0, -158, 0}, {0, 1, 0}), 8);
}

Solid head_solid(const HeadMeasures& head) {
  Solid solid;
  add_skull(solid, head);
  add_neck(solid);
  add_ears(solid, head);
  add_eyes(solid, head);
  add_nose(solid, head);
  add_mouth(solid, head);
  return solid;
}

Figure make_head(const Parameters& identity) {
  const HeadMeasures head(identity);
  Figure figure{polygonise(head_solid(head), {2.1, {0, -28, 80}, 36}), head_poses()};
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& vertex : figure.mesh.vertices) points.push_back(vertex.cast<double>());
  figure.mesh.targets = head_targets(head, points);
  const VectorField closing = mouth_closing(head);
  for (std::size_t i = 0; i < points.size(); ++i)
    figure.mesh.vertices[i] = (points[i] + closing(points[i])).cast<float>();
  return figure;
}

}  // namespace

HeadMeasures::HeadMeasures(const Parameters& identity)
    : half_width(identity.real("width") / 2),
      jaw(identity.real("jaw") / 2),
      brow(identity.real("brow")),
      cheek_fullness(identity.real("cheek_fullness")),
      lips(identity.real("lips")),
      chin(identity.real("chin")),
      eye(31.5, -1, 64),
      nose_tip(0, 11 - identity.real("nose_length"), 101),
      mouth(0, -67, 90),
      corner(26, -67, 78) {}

FigureKind head_figure() {
  return {"head", "A head with a face that can smile, speak and frown", identity_table(), make_head};
}

}  // namespace pliant
