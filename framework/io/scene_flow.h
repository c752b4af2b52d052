#pragma once

#include <Eigen/Core>
#include <string>

#include "framework/geometry/image.h"

namespace pliant {

/// Reads true motion from a `.sflow` file (little-endian: uint32 width, height, channels = 3, then
/// float32 [channel][row][column] in metres, -inf where nothing is known). Gives mm in the camera's
/// frame, NaN where nothing is known. Throws DataError naming the file, and the pixel where the file
/// holds a NaN or another value that is no motion.
Image<Eigen::Vector3f> read_scene_flow(const std::string& path);

/// Writes motion in mm (NaN where nothing is known) as read_scene_flow reads it.
void write_scene_flow(const std::string& path, const Image<Eigen::Vector3f>& flow);

/// The same for motion in the image, in pixels, from and to `.oflow` files: channels = 2.
Image<Eigen::Vector2f> read_optical_flow(const std::string& path);
void write_optical_flow(const std::string& path, const Image<Eigen::Vector2f>& flow);

}  // namespace pliant
