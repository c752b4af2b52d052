#pragma once

#include <string>
#include <string_view>

#include "framework/device/device.h"
#include "framework/geometry/pixel_window.h"

namespace pliant {

/// `source` behind lanes.cl and depth_map.cl, and the options that these take: what kernels over depth maps
/// share.
std::string with_depth_map(std::string_view source);
std::string depth_map_options();

/// The same behind plane.cl as well, which finds normals.
std::string with_plane(std::string_view source);
std::string plane_options();

/// Work-items of a kernel of which each makes a vector of pixels of a row of a window.
std::size_t row_vectors(const Device& device, const PixelWindow& window);

}  // namespace pliant
