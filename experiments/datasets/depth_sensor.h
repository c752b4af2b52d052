#pragma once

#include <array>
#include <cstdint>

#include "framework/core/parameters.h"
#include "framework/device/array.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"

namespace pliant {

/// The errors of a structured-light depth camera (the first Kinect). Each term is 0 where it is switched off.
struct DepthSensorSettings {
  /// Strength of axial noise, 1 as measured [Nguyen, Izadi, Lovell 2012, Eq. 3 and 4]: independent and
  /// normal, sigma = 1.2 + 1.9 (z - 0.4)^2 + 0.1 / sqrt(z) theta^2 / (pi / 2 - theta)^2 mm, z in metres,
  /// theta the angle between the ray and the normal of the surface.
  double axial = 0;
  /// Step of the disparity f b / z in eighths of a pixel: 1 as in the camera [Khoshelham, Oude Elberink 2012;
  /// Konolige, Mihelich 2011].
  double quantisation = 0;
  /// Strength of lateral noise, 1 as measured [Nguyen et al. 2012, Eq. 1 and 2]: near a step in depth a pixel
  /// has the depth of another, normally distributed around it, sigma = 0.8 + 0.035 theta / (pi / 2 - theta)
  /// pixels [the way of Barron, Malik 2013; Handa et al. 2014].
  double lateral = 0;
  /// Degrees: a surface that the ray meets at a larger angle from its normal returns no depth; 0: none does
  /// that. Nguyen et al. 2012 found no depth beyond about 80.
  double grazing = 0;
  /// Length in mm of the baseline b from the camera to the projector on its right, 75 in the camera
  /// [Khoshelham, Oude Elberink 2012]: what the projector does not light has no depth; 0: none is in shadow.
  double shadow = 0;

  bool is_on() const { return axial > 0 || quantisation > 0 || lateral > 0 || grazing > 0 || shadow > 0; }
};

/// The rows of a section that describes a sensor, all terms off, and what it says.
ParameterTable depth_sensor_table();
DepthSensorSettings read_depth_sensor(const Parameters& section);

/// Makes the depth images that a depth camera would see of exact ones. The same seed and frame give the same
/// bits on one device. Images are made on the device; the plain C++ beside it is the reference.
class DepthSensor {
 public:
  DepthSensor(const DepthSensorSettings& settings, const Camera& camera, std::uint64_t seed);

  /// `depth`: exact, mm a pixel, 0 where nothing is seen. `frame`: the noise of each differs.
  Array<float> sense(Device& device, const Array<float>& depth, std::uint32_t frame) const;
  DepthImage sense_reference(const DepthImage& depth, std::uint32_t frame) const;

 private:
  friend class SensorReference;
  using Key = std::array<std::uint32_t, 2>;

  // Neighbours that are further apart in depth than so many times the distance of their rays are of different
  // surfaces.
  static constexpr float steepest = 12;
  static constexpr float shadow_margin = 1;        // pixels of disparity that what hides is nearer by
  static constexpr float quantised_baseline = 75;  // mm
  static constexpr float half_pi = 1.5707964F;
  static constexpr float steepest_angle = 1.5533431F;  // 89 degrees: noise beyond is as there

  Key key_of(std::uint32_t frame) const;

  DepthSensorSettings settings_;
  Camera camera_;
  std::uint64_t seed_;
  float grazing_;  // radians
};

}  // namespace pliant
