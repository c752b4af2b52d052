#include "experiments/modeller/figures.h"
#include "experiments/modeller/implicit.h"
#include "experiments/modeller/skeleton.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

// A standing adult of 1750 mm whose legs end above the knees; y = 0 is the ground. Lengths of its parts are
// shares of its height after Winter, "Biomechanics and motor control of human movement", 2009, Figure 4.1.
const Point neck(0, 1450, -10);
const Point chest(0, 1290, 0);
const Point pelvis(0, 960, 0);
const Point hip(92, 900, 0);
const Point knee(115, 480, 8);

/// The left arm, which hangs away from the body at rest.
struct Arm {
  Point shoulder{190, 1410, -12};
  Point elbow;
  Point wrist;
  Point fingers;
  explicit Arm(double length) {
    const Eigen::Matrix3d away = turned(0, 0, 42);
    const auto along = [&](const Point& from, double share) -> Point {
      return from + length * share * (away * Point(0, -1, 0.03));
    };
    elbow = along(shoulder, 305);
    wrist = along(elbow, 255);
    fingers = along(wrist, 150);
  }
};

void add_head(Solid& solid) {
  solid.add(ellipsoid({0, 1648, 0}, {76, 96, 98}), 0);
  solid.add(ellipsoid({0, 1588, 30}, {58, 76, 62}), 30);
  solid.add(tube({{{0, 1630, 92}, 8}, {{0, 1592, 106}, 11}}), 14);
  solid.raise_pair({32, 1632, 92}, {22, 13, 30}, -9);
  solid.raise({0, 1560, 96}, {32, 5, 30}, -4);
  solid.raise({0, 1542, 92}, {24, 9, 30}, 3);
  solid.add_pair(ellipsoid({76, 1616, -10}, {9, 32, 19}, turned(0, -20, 0)), 8);
  solid.add(tube({{{0, 1580, -18}, 56}, {neck, 60}}), 28);
}

void add_torso(Solid& solid, double girth) {
  const double g = girth;
  solid.add(ellipsoid({0, 1310, 0}, {168 * g, 165, 112 * g}), 50);
  solid.add(ellipsoid({0, 1130, 4}, {140 * g, 190, 98 * g}), 70);
  solid.add(ellipsoid({0, 950, -2}, {164 * g, 125, 112 * g}), 70);
  // Shoulders and the slope to the neck.
  solid.add_pair(tube({{{30, 1450, -18}, 44}, {{150, 1412, -14}, 52}}), 45);
  solid.add_pair(ellipsoid({72, 1335, 70 * g}, {80, 54, 34}, turned(0, 20, 0)), 40);
  solid.raise({0, 1320, 120}, {12, 70, 40}, -5);
  solid.raise({0, 1060, 105 * g}, {9, 9, 20}, -5);
  // The back: its groove and the shoulder blades.
  solid.raise({0, 1200, -110 * g}, {18, 170, 40}, -8);
  solid.raise_pair({82, 1340, -105 * g}, {45, 65, 40}, 7);
}

Solid arm_solid(const Arm& arm) {
  Solid solid;
  const auto between = [](const Point& a, const Point& b, double share) -> Point {
    return a + share * (b - a);
  };
  solid.add(tube({{arm.shoulder, 58},
                  {between(arm.shoulder, arm.elbow, 0.45), 50},
                  {arm.elbow, 38},
                  {between(arm.elbow, arm.wrist, 0.25), 39},
                  {arm.wrist, 27}},
                 6),
            0);
  // A mitten with a thumb.
  const Eigen::Matrix3d away = turned(0, 0, 42);
  solid.add(ellipsoid(between(arm.wrist, arm.fingers, 0.45), {20, 62, 44}, away), 18);
  solid.add(ellipsoid(between(arm.wrist, arm.fingers, 0.95), {17, 60, 38}, away), 14);
  solid.add(tube({{between(arm.wrist, arm.fingers, 0.3) + Point(-4, 0, 28), 18},
                  {between(arm.wrist, arm.fingers, 0.85) + Point(-14, 0, 62), 12}}),
            12);
  return solid;
}

Solid body_solid(const Arm& arm, double girth) {
  Solid solid;
  add_head(solid);
  add_torso(solid, girth);
  solid.add_pair(
      tube({{hip + Point(0, 0, -4), 96 * girth}, {knee + Point(0, 120, 0), 66 * girth}, {knee, 58}}, 30), 30);
  solid.add_pair(arm_solid(arm).shape(), 28);
  solid.cut(half_space({0, 560, 0}, {0, 1, 0}), 12);
  return solid;
}

Skeleton body_skeleton(const Arm& arm) {
  const Point forward = Point::UnitZ();
  const Point right(-1, 0, 0);
  Skeleton skeleton;
  skeleton.add("pelvis", "", {pelvis - Point(0, 40, 0), pelvis + Point(0, 60, 0), 120}, 70, right);
  skeleton.add("chest", "pelvis", {chest - Point(0, 180, 0), chest + Point(0, 110, 0), 120}, 70, right);
  skeleton.add("head", "chest", {neck + Point(0, 30, 0), {0, 1720, 0}, 70}, 60, right);
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "left" : "right";
    const auto mirror = [side](const Point& p) -> Point { return {side * p.x(), p.y(), p.z()}; };
    const Point middle = arm.shoulder + 0.12 * (arm.elbow - arm.shoulder);
    skeleton.add("clavicle_" + name, "chest", {mirror({60, 1435, -16}), mirror(arm.shoulder), 45}, 80,
                 forward);
    skeleton.add("shoulder_" + name, "clavicle_" + name, {mirror(middle), mirror(arm.elbow), 38}, 75,
                 forward);
    skeleton.add("elbow_" + name, "shoulder_" + name, {mirror(arm.elbow), mirror(arm.wrist), 34}, 45,
                 forward);
    skeleton.add("wrist_" + name, "elbow_" + name, {mirror(arm.wrist), mirror(arm.fingers), 26}, 30, forward);
    skeleton.add("hip_" + name, "pelvis", {mirror(hip), mirror(knee), 80}, 70, right);
  }
  return skeleton;
}

std::vector<NamedPose> body_poses() {
  return {
      {"arms_up",
       "Both arms raised",
       {},
       {{"clavicle_left", {25, 0, 0}},
        {"shoulder_left", {75, 0, 0}},
        {"clavicle_right", {-25, 0, 0}},
        {"shoulder_right", {-75, 0, 0}}}},
      {"arms_forward",
       "Both arms to the front",
       {},
       {{"shoulder_left", {10, 0, -72}}, {"shoulder_right", {-10, 0, -72}}}},
      {"wave",
       "The right hand raised to wave",
       {},
       {{"clavicle_right", {-12, 0, 0}}, {"shoulder_right", {-40, 0, 0}}, {"elbow_right", {-85, 0, 0}}}},
  };
}

Figure make_body(const Parameters& identity) {
  const Arm arm(identity.real("arm_length"));
  const Point left_hand = (arm.wrist + arm.fingers) / 2;
  const Point right_hand(-left_hand.x(), left_hand.y(), left_hand.z());
  const Sampling sampling{
      10.6, {0, 1580, 60}, 700, {{{0, 1610, 80}, 110, 0.5}, {left_hand, 90, 0.45}, {right_hand, 90, 0.45}}};
  Figure figure{polygonise(body_solid(arm, identity.real("girth")), sampling), body_poses()};
  body_skeleton(arm).bind(figure.mesh);
  return figure;
}

}  // namespace

FigureKind body_figure() {
  return {"body",
          "A standing person down to the knees, whose arms move",
          {real("girth", 1).range(0.85, 1.25).doc("Of trunk and thighs, of the usual one"),
           real("arm_length", 1).range(0.85, 1.15).doc("Of the usual one")},
          make_body};
}

}  // namespace pliant
