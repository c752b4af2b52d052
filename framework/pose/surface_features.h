#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/surface_map.h"

namespace pliant {

/// Features of a surface's form.
struct SurfaceFeatures {
  static constexpr int length = 66;  ///< numbers of a descriptor

  std::vector<float> descriptors;
  std::vector<Eigen::Vector3d> points;  ///< mm, camera frame
};

/// Fast point feature histograms [Rusu, Blodow, Beetz, "Fast point feature histograms (FPFH) for 3D
/// registration", ICRA 2009] of two radii, 25 and 50 mm, one behind the other, of points about 9 mm apart. A
/// point without a normal, or with fewer than 8 neighbours in the smaller radius, has none. Reads the map
/// from the device.
SurfaceFeatures find_surface_features(const SurfaceMap& seen);

}  // namespace pliant
