#include "experiments/datasets/kinect_noise.h"

#include <cmath>
#include <numbers>

namespace pliant {
namespace {

double axial_sigma(double depth) {
  const double beyond = (depth - 400) / 1000;
  return 1.2 + 1.9 * beyond * beyond;
}

// The upper 53 bits: all that a double holds.
double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace

double KinectNoise::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - unit_interval(generator_())));
  return radius * std::cos(2 * std::numbers::pi * unit_interval(generator_()));
}

double KinectNoise::disturb(double depth) {
  constexpr double kBaseline = 75;
  const double noisy = depth + strength_ * axial_sigma(depth) * normal();
  if (noisy <= 0) return 0;
  const double step = strength_ / 8;
  const double steps = std::round(focal_length_ * kBaseline / noisy / step);
  return steps > 0 ? focal_length_ * kBaseline / (steps * step) : 0;
}

void KinectNoise::disturb(DepthImage& depth) {
  if (strength_ == 0) return;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    float& value = depth.data()[i];
    if (value > 0) value = static_cast<float>(disturb(double{value}));
  }
}

}  // namespace pliant
