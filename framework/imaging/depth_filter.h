#pragma once

#include <optional>

#include "framework/core/registry.h"
#include "framework/imaging/depth_map.h"

namespace pliant {

/// Takes noise out of a depth map before surfaces are made of it.
class DepthFilter {
 public:
  static constexpr const char* kind = "filter";
  virtual ~DepthFilter() = default;
  /// The map with other values at the same pixels; none when it stays as it is. Only enqueues.
  /// `camera`: the one that took it.
  virtual std::optional<DepthMap> filter(Device& device, const DepthMap& map, const Camera& camera) const = 0;
};

/// Adds `none`, `bilateral` and `bilateral_by_noise`.
void register_filters(Registry& registry);

}  // namespace pliant
