#pragma once

#include <optional>

#include "framework/core/registry.h"
#include "framework/tracking/frame_record.h"

namespace pliant {

/// What a policy judges by.
struct PolicyInput {
  int frame;                   ///< its number, the first is 1
  const TrackingError& rigid;  ///< of rigid tracking
  /// The last registration, if it was rejected: of which frame, at which error of rigid tracking (mm).
  struct Rejection {
    int frame;
    double error;
  };
  std::optional<Rejection> rejection;
};

/// When the model is registered non-rigidly to a frame whose pose was found [thesis 4.8, chapter 6].
class Policy {
 public:
  static constexpr const char* kind = "policy";
  virtual ~Policy() = default;
  virtual bool registers(const PolicyInput& input) const = 0;
  /// Whether it never does: the model is taken to be rigid.
  virtual bool is_rigid() const { return false; }
};

/// Adds `rigid_only`, `every_n` and `adaptive`.
void register_policies(Registry& registry);

}  // namespace pliant
