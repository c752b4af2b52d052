#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "experiments/report/heat_map.h"
#include "experiments/view/tracked_frame.h"

namespace pliant {

/// What is kept of a frame to be drawn: the model from its camera, and how far the frame is from it.
struct Moment {
  std::string caption;     ///< the frame's number and error
  cv::Mat model;           ///< its pixels are Rgb
  Image<float> distances;  ///< mm; NaN: none
};

/// Of a frame with a model.
Moment moment_of(const TrackedFrame& tracked);

/// Moments of one stream side by side, at least one, as a PNG: the colours of the scale, and of each moment
/// its caption, the model and the distances. `a_row`: how many stand beside each other at most.
std::vector<std::uint8_t> draw_moments(const std::vector<Moment>& moments, const ColorScale& scale,
                                       int a_row);

}  // namespace pliant
