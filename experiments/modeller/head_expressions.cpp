#include <algorithm>
#include <cmath>
#include <complex>

#include "experiments/modeller/head.h"

namespace pliant {
namespace {

using Point = Eigen::Vector3d;

double away_from_middle(const Point& p) { return std::abs(p.x()); }

/// How much of a motion of the jaw a point takes: all of the lower lip and the chin, nothing of the upper
/// lip. Cheeks and lips share it as an elastic sheet does around a slit that opens to an ellipse:
/// Westergaard, "Bearing pressures and cracks", Journal of Applied Mechanics, 1939. The slit is the mouth,
/// and ends in the cavity behind.
ScalarField jaw_share(const HeadMeasures& head) {
  const double half_slit = head.corner.x() - 8.5;
  const ScalarField in_front = rise(coordinate(2), 48, 70);
  const ScalarField below = [=](const Point& p) {
    const double slit = half_slit * in_front(p);
    const double y = p.y() - head.mouth.y();
    const std::complex<double> place(std::abs(p.x()), y);
    const double lift = std::copysign(std::sqrt(place * place - slit * slit).imag(), y);
    return std::pow((1 - lift / std::hypot(half_slit, y)) / 2, 1.5);
  };
  return below * rise(coordinate(2), 14, 50) * rise(coordinate(1), -140, -112);
}

VectorField smile(const HeadMeasures& head) {
  return bump(head.corner, 17) * shift({6, 6, -5}) + bump({41, -34, 66}, 19) * shift({1, 4, 3.5}) +
         bump(head.corner + Point(-12, 0, 8), 12) * shift({1, -1, -2}) +
         bump(head.eye + Point(0, -6, 12), {14, 5, 12}) * shift({0, 1.5, 0});
}

}  // namespace

VectorField mouth_closing(const HeadMeasures& head) {
  return inverse(rise(away_from_middle, head.corner.x() - 10, head.corner.x() + 2)) *
         bump(head.mouth, {1e3, 5.5, 22}) * stretch(head.mouth, {0, -0.92, 0});
}

std::vector<MorphTarget> head_targets(const HeadMeasures& head, const std::vector<Point>& points) {
  const Point& mouth = head.mouth;
  const Point cheek(head.jaw + 1 + 0.7 * head.cheek_fullness, -57, 51 + 0.4 * head.cheek_fullness);
  const VectorField cheeks =
      both_sides(bump(cheek, 25) * shift({11.5, 0, 7})) + bump(mouth, {20, 14, 15}) * shift({0, 0, -1});
  const VectorField kiss = bump(mouth, {32, 14, 25}) * stretch(mouth, {-0.45, 0, 0}) +
                           bump(mouth, {20, 14, 22}) * shift({0, 0, 9.5}) +
                           both_sides(bump({40, -60, 60}, 18) * shift({-2, 0, -2}));
  const VectorField open_mouth =
      jaw_share(head) * (turn({0, -10, 5}, Point::UnitX(), 6) + shift({0, -15, 2}));
  const VectorField angry = both_sides(bump({15, 15, 85}, {15, 12, 20}) * shift({-2.5, -5, 1}) +
                                       bump({13, 8, 80}, {9, 9, 15}) * shift({-1.5, -1, 2}) +
                                       bump(head.corner, 14) * shift({-1, -4, 0}) +
                                       bump(head.nose_tip + Point(11, -3, -11), 9) * shift({1.5, 2.5, 0}) +
                                       bump(head.eye + Point(-2, 6, 13), {13, 5, 12}) * shift({0, -2, 0}));
  return {target("smile_left", smile(head), points), target("smile_right", mirrored(smile(head)), points),
          target("cheeks", cheeks, points),          target("kiss", kiss, points),
          target("open_mouth", open_mouth, points),  target("angry", angry, points)};
}

std::vector<NamedPose> head_poses() {
  return {
      {"smile",
       "The corners of the mouth go up and back, the cheeks rise",
       {{"smile_left", 1}, {"smile_right", 1}}},
      {"cheeks", "Both cheeks inflated", {{"cheeks", 1}}},
      {"kiss", "The lips narrow and come forward", {{"kiss", 1}}},
      {"open_mouth", "The jaw drops and the lips part", {{"open_mouth", 1}}},
      {"angry", "The brows go down and together", {{"angry", 1}}},
  };
}

}  // namespace pliant
