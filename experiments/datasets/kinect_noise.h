#pragma once

#include <cstdint>
#include <random>

#include "framework/geometry/image.h"

namespace pliant {

/// The error of a structured-light depth camera, in two steps per pixel:
///  1. axial noise: independent and normal, sigma(z) = strength * (1.2 + 1.9 ((z - 400) / 1000)^2) mm
///     (Nguyen, Izadi, Lovell 2012);
///  2. the camera measures disparity d = focal_length * 75 mm / z in steps of strength / 8 pixels.
/// Strength 1 is the camera as it is, 0 changes nothing.
class KinectNoise {
 public:
  /// `focal_length` in pixels. The same seed gives the same bits on every standard library, whose
  /// generators, unlike their distributions, are fixed by the C++ standard.
  KinectNoise(double strength, double focal_length, std::uint64_t seed)
      : strength_(strength), focal_length_(focal_length), generator_(seed) {}

  /// Disturbs every pixel with depth, in row-major order; one that is carried to infinity or behind the
  /// camera has no depth any more.
  void disturb(DepthImage& depth);

 private:
  double disturb(double depth);
  double normal();

  double strength_;
  double focal_length_;
  std::mt19937_64 generator_;
};

}  // namespace pliant
