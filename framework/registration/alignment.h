#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "framework/geometry/frame.h"

namespace pliant {

/// Points of the source (`from`) and of the target (`to`) that are believed to be the same, in mm.
struct PointMatches {
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;

  std::size_t size() const { return from.size(); }
};

/// A rigid motion that brings the source near the target, and what it rests on.
struct AlignmentResult {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< millimetres, camera frame
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
  /// `wants_features`: an energy will use AlignmentResult::features, where the method finds any.
  virtual AlignmentResult align(const FramePair& pair, std::uint64_t seed, bool wants_features) const = 0;
};

}  // namespace pliant
