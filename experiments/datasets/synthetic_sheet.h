#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "experiments/datasets/frame_source.h"
#include "framework/core/registry.h"

namespace pliant {

/// A flat sheet that bends without stretching, all in mm in the camera's frame. A point of its material has
/// coordinates (s, t), |s| <= width / 2, |t| <= height / 2:
///
///   flat(s, t) = (s, t, distance)
///   bent(s, t) = (x(s), t, z(s)),  z(s) = distance - approach + amplitude cos(w s)
///                                  x(s) = integral from 0 to s of sqrt(1 - k^2 sin^2(w r)) dr
///
/// with w = 2 pi frequency / width and k = amplitude w. Since x'^2 + z'^2 = 1 every length on the sheet is
/// kept, so that its points also move sideways; x is an elliptic integral of the second kind, E(w s, k) / w.
class BendingSheet {
 public:
  struct Shape {
    double width = 320;
    double height = 240;
    double distance = 800;   ///< of the flat sheet from the camera
    double amplitude = 25;   ///< of the wave
    double frequency = 0.6;  ///< waves over the width
    double approach = 18;    ///< towards the camera, of the whole sheet while it bends
  };

  /// Throws ConfigError when the bent sheet would reach the camera or hide a part of itself from it.
  explicit BendingSheet(const Shape& shape);

  /// The sheet on its way from flat to bent: amplitude and approach are `share` of the whole, above 0 to 1.
  BendingSheet partly(double share) const;

  Eigen::Vector3d flat(double s, double t) const { return {s, t, shape_.distance}; }
  Eigen::Vector3d bent(double s, double t) const { return {x(s), t, z(s)}; }

  /// Material coordinates (s, t) seen along the ray (a, b, 1) from the camera; none beside the sheet.
  std::optional<Eigen::Vector2d> see_flat(double a, double b) const;
  std::optional<Eigen::Vector2d> see_bent(double a, double b) const;

 private:
  void check() const;
  double x(double s) const;
  double z(double s) const;
  std::optional<double> solve(double a) const;
  std::optional<Eigen::Vector2d> inside(double s, double t) const;

  Shape shape_;
  double w_;
  double k_;
};

/// The sheet, flat in the first frame and bent in the last [thesis data set I], seen 30 times a second by a
/// pinhole camera with no background, its material coloured by the texture at (s, t, 0). At the share x of
/// the way, 3 x^2 - 2 x^3 of amplitude and approach are reached: it starts and ends at rest. Without noise
/// the depth of every pixel is exact (not rounded to whole millimetres); the scene flow is the exact motion
/// of the material seen at each pixel of the first frame, also under noise.
class SyntheticSheet : public FrameSource {
 public:
  struct Settings {
    Camera camera;
    double noise = 0;  ///< strength of the KinectNoise on the depth images
    int frames = 2;    ///< at least 2
  };
  SyntheticSheet(const BendingSheet& sheet, const Settings& settings) : sheet_(sheet), settings_(settings) {}

  /// The seed is that of the noise. A frame in which no pixel sees the sheet is a DataError. Frames are made
  /// when they are asked for.
  std::unique_ptr<DataStream> open(Device& device, std::uint64_t seed) const override;

 private:
  BendingSheet sheet_;
  Settings settings_;
};

void register_synthetic_sheet(Registry& registry);

}  // namespace pliant
