#pragma once

#include "framework/device/device.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// Cells between four neighbouring points of a deformed view that were turned inside out: their image goes
/// around the other way though their normals still look at the camera. `moved`: one point a pixel of the
/// window, where a camera saw them before, in order. Waits for the device.
int count_folded_cells(Device& device, const SurfaceMap& moved);

/// Plain C++ reference of count_folded_cells.
int count_folded_cells_reference(const SurfaceMap& moved);

}  // namespace pliant
