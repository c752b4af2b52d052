#pragma once

#include <cstdint>

#include "framework/core/log.h"
#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/registration/nonrigid.h"
#include "framework/tracking/method.h"
#include "framework/tracking/result.h"

namespace pliant {

/// Registers the source of a pair to its target [thesis Figure 4.1]. The same pair, method, seed and device
/// give the same bits. Throws DataError when the pair or the graph gives too little to begin with,
/// NumericalError when the source is not finite where the initial alignment puts it. What goes wrong later
/// ends the loop: the result is then that of the best one before, and `termination` and `reason` say why.
/// The stages that run on the device are told in `time_ms` only while the device measures stages
/// (Device::measure_stages).
RegistrationResult register_pair(const FramePair& pair, const Method& method, Device& device,
                                 std::uint64_t seed, const Observer& observer = {});

/// Tells of each iteration of at most `max_iterations`: its residual, and how much is done of `what`.
Observer telling(const ProgressSink& progress, const std::string& what, int max_iterations);

/// The problem of the first outer iteration: source aligned, graph built, constraints matched once, nothing
/// solved. Solvers can be compared on it.
std::unique_ptr<Problem> freeze_problem(const FramePair& pair, const Method& method, Device& device,
                                        std::uint64_t seed);

}  // namespace pliant
