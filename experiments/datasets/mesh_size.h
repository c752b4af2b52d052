#pragma once

#include <Eigen/Geometry>
#include <string>

namespace pliant {

/// Whether depth cameras are seldom pointed at what is so small or so large: the longest side of its box, in
/// mm.
bool is_odd_size(const Eigen::AlignedBox3d& box);

/// "it is 200 x 150 x 3 mm".
std::string described_size(const Eigen::AlignedBox3d& box);

/// The same, with what to do about a size that is wrong: `unit`, the mm that one of the file's numbers was
/// taken for, is what the parameter gives.
std::string described_size(const Eigen::AlignedBox3d& box, double unit, const std::string& parameter);

}  // namespace pliant
