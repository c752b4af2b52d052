#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <vector>

#include "framework/device/device.h"

namespace pliant {

inline void PrintTo(const DeviceOptions& shape, std::ostream* out) {
  *out << "vectors of " << *shape.vector_width << ", " << *shape.work_group_size << " work-items";
}

namespace test {

/// As on GPUs, with few work-items. Unoptimised: drivers for CPUs take minutes to optimise barriers away.
inline const DeviceOptions gpu_shape{1, 8, "-cl-opt-disable"};

/// What kernels must agree with their references in, wherever the tests run.
inline const std::vector<DeviceOptions> device_shapes{{16, 1, ""}, gpu_shape};

}  // namespace test
}  // namespace pliant
