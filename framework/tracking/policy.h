#pragma once

#include "framework/core/registry.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// When the model is registered non-rigidly to a frame whose pose was found [thesis 4.8, chapter 6].
class Policy {
 public:
  static constexpr const char* kind = "policy";
  virtual ~Policy() = default;
  /// Whether it is to the frame of this number, the first is 1, at this error of rigid tracking.
  virtual bool registers(const TrackingError& rigid, int frame) const = 0;
};

/// Adds `rigid_only`, `every_n` and `adaptive`.
void register_policies(Registry& registry);

}  // namespace pliant
