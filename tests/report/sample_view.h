#pragma once

#include "experiments/report/view_data.h"

namespace pliant {

/// A square of side x side points, 100 mm wide and 600 mm away, that comes 3 mm nearer in each of `steps`
/// steps, of which the last is the result; with everything that a view can have.
ViewData sample_view(int side, int steps);

}  // namespace pliant
