#pragma once

#include <optional>
#include <vector>

#include "experiments/report/artefacts.h"
#include "framework/evaluation/metrics.h"
#include "framework/tracking/register_pair.h"

namespace pliant {

/// A registration that was made, and what it was made of.
struct Registration {
  const FramePair& pair;
  const std::optional<PairTruth>& truth;
  const Method& method;
  Device& device;
  std::uint64_t seed;
  const RegistrationResult& result;
  const SurfaceImage& target;  ///< the points of the pair's
  const Picture& picture;      ///< that stands in for the view
};

/// Makes the same registration again and watches it: the times that are told of a run are those of one that
/// nobody watched. Steps are chosen evenly, at most about a dozen; the result is always among them.
ViewData gather_view(const Registration& registration);

}  // namespace pliant
