#pragma once

#include <nlohmann/json_fwd.hpp>

#include "benchmarks/bench.h"
#include "framework/device/device.h"

namespace pliant::bench {

/// Tracks the sequences of chapter 6 as its tables do, until the end of where they are held deformed, and
/// prints what each frame takes: rigidly, and by the policy `adaptive` with both updates of the model. A row:
/// `sequence`, `policy`, `frames`, `fps` (mean), `slowest_frame_ms`, `registered` (share of the frames),
/// `lost` (number of them). Each frame is timed twice and the lesser counts: kernels are built in the first,
/// and what else the machine does only adds to it. Frames are rendered before. `options.quick`: two
/// sequences.
nlohmann::ordered_json measure_policies(Device& device, const Options& options);

}  // namespace pliant::bench
