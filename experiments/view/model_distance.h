#pragma once

#include "framework/geometry/image.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// How far each point of a frame is from the plane of the model's point at the same pixel, mm; NaN where
/// either has none. Over the window, which both have in common. Reads both from the device.
Image<float> model_distances(const SurfaceMap& seen, const SurfaceMap& model);

}  // namespace pliant
