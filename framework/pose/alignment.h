#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/geometry/point_matches.h"
#include "framework/geometry/surface_map.h"

namespace pliant {

/// What an alignment may look at; all of it stays as it is during the call. Maps are
/// filtered by the method's filter.
struct AlignmentInput {
  const FramePair& pair;
  Device& device;
  const SurfaceMap& source;
  const Array<int>& source_pixels;  ///< offsets in its window of the pixels that have a point
  const SurfaceMap& target;
  std::uint64_t seed = 0;
  /// Whether an energy will use AlignmentResult::features, where the method finds any.
  bool wants_features = false;
};

/// A rigid motion that brings the source near the target, and what it rests on.
struct AlignmentResult {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< millimetres, camera frame
  std::string method = "none";  ///< what found `motion`: "none", "features", "icp" or "features, icp"
  std::string reason;           ///< in words, why that one, and what became of the others
  /// Whether the source is far from the target and no motion was found that brings it near: it stays.
  bool failed = false;
  int matches = 0;  ///< candidate matches (0 where the method has none)
  int inliers = 0;  ///< those that agree with `motion`
  /// The candidates that agree with `motion` as far as a deformation allows.
  PointMatches features;
};

/// Finds the rigid motion from which non-rigid registration starts.
class Alignment {
 public:
  static constexpr const char* kind = "alignment";
  virtual ~Alignment() = default;
  /// Deterministic for a given seed. Throws DataError when the pair gives too little to align.
  virtual AlignmentResult align(const AlignmentInput& input) const = 0;
};

}  // namespace pliant
