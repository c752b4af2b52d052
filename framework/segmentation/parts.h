#pragma once

#include <optional>

#include "framework/core/parameters.h"
#include "framework/geometry/camera.h"
#include "framework/geometry/image.h"
#include "framework/geometry/pixel_window.h"

namespace pliant {

/// The parameter `speck` of methods that look for connected parts, pixels.
Parameter speck_parameter();
/// The parameter `margin` of methods that find a window, pixels.
Parameter margin_parameter();

/// The bounding window of what is not zero, without specks: parts of fewer pixels than `speck` that are
/// connected by their sides. None where there is nothing else. A few stray pixels of noise would else decide
/// where the object ends.
std::optional<PixelWindow> window_of_parts(const MaskImage& shown, int speck);

/// A window with `margin` pixels more on each side, as far as the camera's image reaches.
PixelWindow widened(const PixelWindow& window, int margin, const Camera& camera);

}  // namespace pliant
