#pragma once

#include "framework/core/registry.h"

namespace pliant {

/// `tum`: a sequence in the layout of the TUM RGB-D benchmark (Sturm et al., A Benchmark for the Evaluation
/// of RGB-D SLAM Systems, IROS 2012): a folder with `depth.txt` and `rgb.txt`, lines of `TIME FILE`, or
/// `associations.txt`, lines of `TIME FILE TIME FILE`, and the images that they name. Depth is 16-bit PNG,
/// 5000 units a metre, along the optical axis; colour has the depth's pixels.
void register_tum(Registry& registry);

}  // namespace pliant
