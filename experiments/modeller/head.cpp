#include "experiments/modeller/head.h"

#include <cmath>

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
      real("brow", 2).unit("mm").range(0, 6).doc("How far the brow stands out"),
      real("cheek_fullness", 0).unit("mm").range(-3, 6).doc("How far the cheeks are filled out"),
      real("lips", 1).range(0.6, 1.5).doc("Thickness of the lips, of the usual one"),
  };
}

void add_skull(Solid& solid, const HeadMeasures& head) {
  solid.add(ellipsoid({0, 25, -6}, {head.half_width, 87, 97}), 0);
  solid.add(ellipsoid({0, -38, 28}, {head.jaw + 8, 78, 57}), 25);
  // Jaw, from below the ear to the chin.
  solid.add_pair(
      tube({{{head.jaw - 15, -52, 2}, 14}, {{head.jaw - 18, -78, 18}, 13}, {{13, -102, 66}, 11}}, 14), 22);
  solid.add(ellipsoid({0, -99, 70 + head.chin}, {19, 15, 16}), 14);
  // Cheekbones and brow.
  solid.add_pair(tube({{{60, -10, 8}, 7}, {{50, -19, 48}, 9}, {{36, -26, 64}, 10}}, 12), 18);
  solid.add_pair(ellipsoid({head.jaw - 16.5, -54, 50}, {24, 30, 24}), 22);
  solid.add_pair(tube({{{6, 18, 78}, 7}, {{28, 23, 74.5}, 7}, {{54, 9, 46}, 5}}, 10), 20);
  solid.raise_pair({22, 19, 86}, {20, 7, 20}, head.brow);
  solid.raise_pair({47, -54, 55}, {18, 22, 22}, head.cheek_fullness);
}

void add_eyes(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d& eye = head.eye;
  solid.raise_pair(eye + Eigen::Vector3d(-1, 0, 12), {18, 13, 20}, -6.5);
  solid.raise_pair(eye + Eigen::Vector3d(-17, 4, 14), {8, 10, 14}, -3);
  solid.raise_pair(eye + Eigen::Vector3d(16, -2, 2), {8, 10, 10}, 2.5);
  solid.add_pair(ellipsoid(eye, {15.2, 13.8, 14.6}), 9);
  // The opening of the lids is where a rod above and one below overlap.
  const auto rod = [&](double y, double radius) {
    const Eigen::Vector3d middle = eye + Eigen::Vector3d(-0.5, y, 0);
    return tube({{middle, radius}, {middle + Eigen::Vector3d(0, 0, 30), radius}});
  };
  Solid beyond;
  beyond.add(ball(eye, 100), 0).cut(rod(14.5, 21.6), 0);
  Solid opening;
  opening.add(rod(-13, 20.4), 0).cut(beyond.shape(), 0);
  solid.press_pair(opening.shape(), 2.3, 3.6);
  solid.raise_pair(eye + Eigen::Vector3d(0, 0, 13), {3.2, 3.2, 4}, -0.8);
}

void add_nose(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d& tip = head.nose_tip;
  const Eigen::Vector3d root(0, 5, 80);
  const Eigen::Vector3d bridge = 0.5 * (root + tip) + Eigen::Vector3d(0, 0, 1.5);
  solid.add_pair(tube({{{5, 2, 74}, 6}, {tip + Eigen::Vector3d(8, 0, -16), 9}}), 12);
  solid.add(tube({{root, 7}, {bridge, 7}, {tip, 9}, {tip + Eigen::Vector3d(0, -7.5, -8), 5}}, 6), 10);
  solid.add_pair(ellipsoid(tip + Eigen::Vector3d(11, -3, -11), {6.5, 7.2, 9}, turned(0, 25, 0)), 9);
  // The rims of the nostrils, then these.
  solid.add_pair(tube({{tip + Eigen::Vector3d(4.5, -7, 0.5), 3.6}, {tip + Eigen::Vector3d(12, -7, -7), 4}}),
                 5);
  solid.press_pair(ellipsoid(tip + Eigen::Vector3d(6.6, -10, -3), {4, 6, 4.6}, turned(0, -20, 0)), 2.6, 3);
}

/// From one corner of the mouth to the other. Beads are of its left half and relative to the mouth's middle.
Shape lip(const HeadMeasures& head, const Bead& middle, const Bead& side) {
  const Eigen::Vector3d corner = head.corner - head.mouth;
  const Bead end{{corner.x(), std::copysign(0.8, middle.centre.y()), corner.z()}, 2.2};
  std::vector<Bead> beads;
  for (const Bead& bead : {end, side, middle}) {
    const Eigen::Vector3d& p = bead.centre;
    beads.push_back({head.mouth + Eigen::Vector3d(-p.x(), p.y(), p.z()), bead.radius});
  }
  for (const Bead& bead : {middle, side, end}) beads.push_back({head.mouth + bead.centre, bead.radius});
  return tube(beads, 3);
}

void add_mouth(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d& m = head.mouth;
  solid.add(ellipsoid(m + Eigen::Vector3d(0, 2, -27), {34, 28, 24}), 18);
  // The groove between nose and mouth, its sides, and the hollow above the chin.
  solid.raise({0, m.y() + 12, m.z() + 4}, {3.2, 6, 8}, -0.8);
  solid.raise_pair({5, m.y() + 11, m.z() + 4}, {3, 5, 8}, 0.3);
  solid.raise({0, m.y() - 18, m.z()}, {20, 6, 14}, -2.5);
  // The cavity of the mouth, its opening, and lips around it.
  solid.cut(ellipsoid(m + Eigen::Vector3d(0, 0, -29), {22, 13, 19}), 4);
  solid.cut(ellipsoid(m + Eigen::Vector3d(0, 0, -12), {head.corner.x() - 1, 7, 26}), 2);
  const double side = 0.55 * head.corner.x();
  const double t = head.lips;
  solid.add(lip(head, {{3.5, 2 + 4.2 * t, 0.5}, 4.2 * t}, {{side, 1.6 + 3.4 * t, -3}, 3.4 * t}), 3);
  solid.add(lip(head, {{3, -2 - 5.4 * t, -1.5}, 5.4 * t}, {{side, -1.6 - 4.3 * t, -4}, 4.3 * t}), 3);
}

void add_ears(Solid& solid, const HeadMeasures& head) {
  const Eigen::Vector3d middle(head.half_width - 2, -8, -12);
  Solid ear;
  ear.add(ellipsoid(middle, {8, 31, 18}, turned(-12, -22, -8)), 0);
  ear.cut(ellipsoid(middle + Eigen::Vector3d(9, 3, 5), {8, 19, 10}, turned(-12, -22, -8)), 4);
  solid.add_pair(ear.shape(), 8);
}

void add_neck(Solid& solid) {
  solid.add(tube({{{0, -50, -28}, 46}, {{0, -190, -36}, 50}}), 24);
  solid.cut(half_space({0, -150, 0}, {0, 1, 0}), 14);
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

/// Finest around the eyes and the mouth.
Sampling head_sampling(const HeadMeasures& head) {
  const Eigen::Vector3d right_eye(-head.eye.x(), head.eye.y(), head.eye.z());
  const Eigen::Vector3d forward(0, 0, 11);
  const Eigen::Vector3d ear(head.half_width, -8, -12);
  return {2.5,
          {0, -28, 75},
          42,
          {{head.eye + forward, 19, 0.58},
           {right_eye + forward, 19, 0.58},
           {head.mouth, 26, 0.4},
           {ear, 30, 0.35},
           {Eigen::Vector3d(-ear.x(), ear.y(), ear.z()), 30, 0.35}}};
}

/// What makes a face of the skin: without light nothing else tells where eyes, brows and lips are.
std::vector<ColorPatch> face_patches(const HeadMeasures& head) {
  std::vector<ColorPatch> patches;
  const auto add = [&](const Eigen::Vector3d& centre, const Eigen::Vector3f& radii,
                       const Eigen::Vector3f& color, float strength) {
    patches.push_back({centre.cast<float>(), radii, color, strength});
  };
  const auto add_pair = [&](const Eigen::Vector3d& centre, const Eigen::Vector3f& radii,
                            const Eigen::Vector3f& color, float strength) {
    add(centre, radii, color, strength);
    add({-centre.x(), centre.y(), centre.z()}, radii, color, strength);
  };
  const Eigen::Vector3f shade(120, 80, 62), hair(58, 40, 30), white(205, 196, 188), iris(62, 42, 32),
      red(150, 74, 70);
  const Eigen::Vector3d& eye = head.eye;
  add_pair(eye + Eigen::Vector3d(-4, 3, 8), {27, 17, 26}, shade, 0.75F);
  add_pair(eye + Eigen::Vector3d(-3, 24, 12), {26, 6, 24}, hair, 0.85F);
  add_pair(eye + Eigen::Vector3d(-0.5, 0, 12), {15, 6, 12}, white, 0.8F);
  add_pair(eye + Eigen::Vector3d(0, 0, 14), {7, 7, 10}, iris, 1);
  add_pair(head.nose_tip + Eigen::Vector3d(7, -10, -4), {6, 5, 7}, hair, 0.7F);
  add(head.mouth + Eigen::Vector3d(0, 0, -4), {30, 10, 22}, red, 0.85F);
  return patches;
}

Figure make_head(const Parameters& identity) {
  const HeadMeasures head(identity);
  Figure figure{polygonise(head_solid(head), head_sampling(head)), head_poses(), face_patches(head)};
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
      eye(31.5, -2, 67),
      nose_tip(0, 11 - identity.real("nose_length"), 101),
      mouth(0, -50 - 0.4 * identity.real("nose_length"), 90),
      corner(26, mouth.y(), 78) {}

FigureKind head_figure() {
  return {"head", "A head with a face that can smile, speak and frown", identity_table(), make_head};
}

}  // namespace pliant
