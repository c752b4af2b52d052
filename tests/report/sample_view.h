#pragma once

#include "experiments/report/view_data.h"

namespace pliant {

/// A square of side x side points, 100 mm wide and 600 mm away, that comes 3 mm nearer in each of `steps`
/// steps, of which the last is the result; with everything that a view can have.
ViewData sample_view(int side, int steps);

/// A square of side x side points, 100 mm wide and 600 mm from where a camera begins, seen in each of `steps`
/// frames while that goes 20 mm aside a frame; a quarter of it is missing, and errors grow frame by frame.
ViewData sample_frames(int side, int steps);

}  // namespace pliant
