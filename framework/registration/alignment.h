#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "framework/geometry/frame.h"

namespace pliant {

/// A rigid motion that brings the source near the target, and what it rests on.
struct AlignmentResult {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< millimetres, camera frame
  int matches = 0;  ///< candidate matches (0 where the method has none)
  int inliers = 0;  ///< those that agree with `motion`
};

/// Finds the rigid motion from which non-rigid registration starts.
class Alignment {
 public:
  static constexpr const char* kind = "alignment";
  virtual ~Alignment() = default;
  /// Deterministic for a given seed. Throws DataError when the pair gives too little to align.
  virtual AlignmentResult align(const FramePair& pair, std::uint64_t seed) const = 0;
};

}  // namespace pliant
