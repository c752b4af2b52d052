#pragma once

#include <cstdint>

#include "framework/core/log.h"
#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/registration/method.h"
#include "framework/registration/result.h"

namespace pliant {

/// Registers the source of a pair to its target [thesis Figure 4.1]. The same pair, method, seed and device
/// give the same bits. Throws DataError when the pair or the graph gives too little to work with,
/// NumericalError when there is no finite answer. The stages that run on the device are told in `time_ms`
/// only while the device measures stages (Device::measure_stages).
RegistrationResult register_pair(const FramePair& pair, const Method& method, Device& device,
                                 std::uint64_t seed, const ProgressSink& progress = {});

/// The problem of the first outer iteration: source aligned, graph built, constraints matched once, nothing
/// solved. Solvers can be compared on it.
std::unique_ptr<Problem> freeze_problem(const FramePair& pair, const Method& method, Device& device,
                                        std::uint64_t seed);

}  // namespace pliant
