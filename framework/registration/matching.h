#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "framework/registration/target.h"

namespace pliant {

/// `source` behind lanes.cl and point_map.cl: what kernels over maps of points share.
std::string with_point_map(std::string_view source);

/// A kernel of projection.cl.
cl::Kernel projection_kernel(Device& device, const std::string& name);

/// The arguments that kernels over a target take: fx, fy, cx, cy and width, height.
cl_float4 pinhole(const Camera& camera);
cl_int2 image_size(const Camera& camera);

/// A vector of the target for plain C++ references: (0, 0, 0) unless it is finite and so is its square.
Eigen::Vector3f finite_or_none(const Array<float>& vectors, std::size_t index);

/// Plain C++ reference of projective association [thesis 4.2]: row-major offset of the pixel that the point
/// (mm, camera frame) projects to; none when that lies outside or has no target point.
std::optional<std::size_t> target_pixel_reference(const Target& target, const Eigen::Vector3f& point);

}  // namespace pliant
