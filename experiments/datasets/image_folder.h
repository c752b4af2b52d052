#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// `folder`: a sequence of depth PNGs, and colour and masks where there are some, by the patterns of their
/// names. The star of a pattern stands for what tells the frames apart; they are sorted by it, numbers as
/// numbers, and colour and mask belong to the depth for which it stands for the same number or text. Frames
/// are evenly spaced in time.
void register_image_folder(Registry& registry);

}  // namespace pliant
