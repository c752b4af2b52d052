#include <array>

#include "experiments/modeller/figures.h"
#include "experiments/modeller/implicit.h"
#include "experiments/modeller/skeleton.h"

namespace pliant {
namespace {

/// A finger from its knuckle to its tip, at rest straight.
struct Finger {
  std::string name;
  std::array<Eigen::Vector3d, 4> points;  ///< mm: the three joints, then the middle of the tip
  std::array<double, 4> radii;            ///< mm, of the finger there
  Eigen::Vector3d bend_axis;              ///< the palm is where it bends to when it turns about this
};

Finger straight_finger(const std::string& name, const Eigen::Vector3d& knuckle, double spread,
                       const Eigen::Vector3d& lengths, const std::array<double, 4>& radii) {
  const Eigen::Vector3d along = turned(5, 0, spread) * Eigen::Vector3d::UnitY();
  Finger finger{name, {}, radii, turned(0, 0, spread) * Eigen::Vector3d::UnitX()};
  finger.points[0] = knuckle;
  for (int i = 0; i < 3; ++i)
    finger.points[static_cast<std::size_t>(i) + 1] =
        finger.points[static_cast<std::size_t>(i)] + lengths[i] * along;
  return finger;
}

std::vector<Finger> fingers_of(double thickness) {
  std::vector<Finger> fingers = {
      {"thumb",
       {{{22, 20, 7}, {47, 51, 14}, {66, 77, 19}, {79, 96, 21}}},
       {13, 10.8, 10, 7.6},
       {0.31, -0.48, 0.78}},
      straight_finger("index", {25, 89, 0}, -7, {41, 24, 18}, {10, 9, 8, 6.5}),
      straight_finger("middle", {3, 93, -2}, -0.5, {46, 28, 19}, {10, 9.1, 8.1, 6.6}),
      straight_finger("ring", {-18, 88, -1}, 6.5, {42, 26, 19}, {9.6, 8.6, 7.7, 6.3}),
      straight_finger("little", {-37, 77, 2}, 16, {34, 20, 17}, {8.6, 7.5, 6.8, 5.6}),
  };
  for (Finger& finger : fingers) {
    for (double& radius : finger.radii) radius *= thickness;
  }
  return fingers;
}

Shape finger_shape(const Finger& finger) {
  std::vector<Bead> beads;
  for (std::size_t i = 0; i < finger.points.size(); ++i) beads.push_back({finger.points[i], finger.radii[i]});
  Solid solid;
  solid.add(tube(beads, 1.5), 0);
  const Eigen::Vector3d along = (finger.points[3] - finger.points[0]).normalized();
  const Eigen::Vector3d to_palm = finger.bend_axis.cross(along).normalized();
  for (const std::size_t joint : {1, 2}) {
    const double radius = finger.radii[joint];
    solid.raise(finger.points[joint] + radius * to_palm, {6, 2.4, 6}, -0.9);
    solid.raise(finger.points[joint] - radius * to_palm, {6, 5, 6}, 0.7);
  }
  return solid.shape();
}

void add_palm(Solid& hand) {
  const std::array<Bead, 4> knuckles = {
      {{{25, 87, -1}, 10.5}, {{3, 91, -3}, 10.5}, {{-18, 86, -2}, 10}, {{-36, 75, 1}, 9.5}}};
  const std::array<Bead, 4> wrist = {
      {{{12, 4, -1}, 13}, {{3, 2, -3}, 14}, {{-7, 2, -3}, 14}, {{-16, 5, -1}, 12}}};
  for (std::size_t i = 0; i < knuckles.size(); ++i) hand.add(tube({wrist[i], knuckles[i]}), 12);
  hand.add(tube({{{24, 82, 2}, 9}, {{2, 86, 1}, 9}, {{-33, 72, 3}, 8}}), 10);
  // The ball of the thumb and the heel of the hand.
  hand.add(ellipsoid({26, 37, 9}, {14, 30, 13}, turned(0, 0, -32)), 12);
  hand.add(ellipsoid({-27, 34, 6}, {13, 34, 12}, turned(0, 0, 10)), 12);
  hand.raise({-2, 52, 16}, {15, 22, 14}, -2.5);
  // The wrist, wider than it is thick.
  hand.add(tube({{{9, -60, -2}, 20}, {{8, 0, -2}, 17}}), 10);
  hand.add(tube({{{-9, -60, -2}, 20}, {{-8, 0, -2}, 17}}), 10);
}

Solid hand_solid(const std::vector<Finger>& fingers) {
  Solid hand;
  add_palm(hand);
  for (const Finger& finger : fingers) hand.add(finger_shape(finger), finger.name == "thumb" ? 12 : 6);
  hand.cut(half_space({0, -28, 0}, {0, 1, 0}), 4);
  return hand;
}

Skeleton hand_skeleton(const std::vector<Finger>& fingers) {
  Skeleton skeleton;
  skeleton.add("forearm", "", {{0, -60, -2}, {0, -8, -2}, 20}, 14);
  skeleton.add("wrist", "forearm", {{0, 0, -2}, {3, 82, -2}, 13}, 8);
  for (const Finger& finger : fingers) {
    const Eigen::Vector3d& knuckle = finger.points[0];
    if (finger.name != "thumb")
      skeleton.also({{knuckle.x() / 3, 5, -2}, knuckle - Eigen::Vector3d(0, 4, 0), 12});
  }
  for (const Finger& finger : fingers) {
    std::string parent = "wrist";
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string joint = finger.name + "_" + std::to_string(i + 1);
      // The ball of the thumb belongs to the palm as well, and gives way over all its width.
      const bool is_ball = joint == "thumb_1";
      const Bone bone{finger.points[i], finger.points[i + 1], is_ball ? 5 : finger.radii[i + 1]};
      skeleton.add(joint, parent, bone, is_ball ? 22 : 7, finger.bend_axis);
      parent = joint;
    }
  }
  return skeleton;
}

/// Turns of the three joints of a finger about its bend axis.
std::vector<NamedPose::Turn> bent(const std::string& finger, double first, double second, double third) {
  return {{finger + "_1", {first, 0, 0}}, {finger + "_2", {second, 0, 0}}, {finger + "_3", {third, 0, 0}}};
}

std::vector<NamedPose::Turn> all(const std::vector<std::vector<NamedPose::Turn>>& parts) {
  std::vector<NamedPose::Turn> turns;
  for (const auto& part : parts) turns.insert(turns.end(), part.begin(), part.end());
  return turns;
}

std::vector<NamedPose> hand_poses() {
  const auto fist =
      all({bent("middle", 86, 104, 74), bent("ring", 86, 104, 74), bent("little", 84, 102, 74)});
  const std::vector<NamedPose::Turn> thumb_across = {
      {"thumb_1", {33, -10, -33}}, {"thumb_2", {32, 0, 0}}, {"thumb_3", {51, 0, 0}}};
  return {
      {"fist",
       "All fingers closed, the thumb across them",
       {},
       all({fist, bent("index", 84, 102, 70), thumb_across})},
      {"pinch",
       "Thumb and index meet at their tips",
       {},
       all({bent("index", 47, 54, 31),
            bent("middle", 20, 25, 12),
            bent("ring", 18, 22, 12),
            bent("little", 15, 20, 10),
            {{"thumb_1", {31, 0, -13}}, {"thumb_2", {14, 0, 0}}, {"thumb_3", {-12, 0, 0}}}})},
      {"point", "The index points, the other fingers are closed", {}, all({fist, thumb_across})},
  };
}

Figure make_hand(const Parameters& identity) {
  const std::vector<Finger> fingers = fingers_of(identity.real("thickness"));
  Figure figure{polygonise(hand_solid(fingers), {2.15}), hand_poses()};
  hand_skeleton(fingers).bind(figure.mesh);
  return figure;
}

}  // namespace

FigureKind hand_figure() {
  return {"hand",
          "A right hand, its palm to the front, whose fingers bend",
          {real("thickness", 1).range(0.85, 1.1).doc("Of fingers, of the usual one")},
          make_hand};
}

}  // namespace pliant
