#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// `deepdeform`: a sequence of the DeepDeform data set (Bozic et al., DeepDeform: Learning Non-Rigid RGB-D
/// Reconstruction with Semi-Supervised Data, CVPR 2020): a folder with `color/FRAME.jpg`, `depth/FRAME.png`
/// (16-bit, mm along the optical axis), `mask/FRAME_OBJECT.png` or `mask/FRAME.png`,
/// `scene_flow/OBJECT_SOURCE_TARGET.sflow` (metres), `optical_flow/OBJECT_SOURCE_TARGET.oflow` (pixels) and
/// `intrinsics.txt`; colour has the depth's pixels. Only depth and intrinsics need to be there.
void register_deepdeform(Registry& registry);

}  // namespace pliant
