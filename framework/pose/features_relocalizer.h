#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "framework/core/registry.h"
#include "framework/pose/feature_index.h"
#include "framework/pose/keyframes.h"
#include "framework/pose/relocalizer.h"
#include "framework/pose/rigid_ransac.h"

namespace pliant {

struct FeaturesRelocalizerOptions {
  KeyframeOptions keyframes;
  double pixels = 7000;  ///< of the object at most, in the image where colour features are looked for
  double ratio = 0.8;    ///< nearest over nearest elsewhere: descriptor distances of colour, at most
  int min_inliers = 8;   ///< colour features; with fewer agreeing there is no pose
  int enough = 20;       ///< so many agreeing colour features need none of the surface beside them
  RansacOptions ransac{20000, 15};
  std::uint64_t seed = 1;
};

/// Finds the pose by features of keyframes: those of colour [SIFT] where the frames have it, and where these
/// tell little those of the surface's form (find_surface_features). Matches are found by FLANN, poses are
/// what RANSAC finds most of them to agree on. The same calls give the same bits.
class FeaturesRelocalizer : public Relocalizer {
 public:
  FeaturesRelocalizer(const Rig& rig, const FeaturesRelocalizerOptions& options);

  void remember(const Frame& frame, const SurfaceMap& seen,
                const Eigen::Isometry3d& camera_from_model) override;
  std::vector<Eigen::Isometry3d> candidates(const Frame& frame, const SurfaceMap& seen) override;

 private:
  /// The features of all keyframes, and what finds them.
  struct Known {
    ModelFeatures features;
    std::unique_ptr<FeatureIndex> index;
  };

  void gather();
  std::vector<AlignmentResult> by_color(const Frame& frame, const SurfaceMap& seen) const;
  std::vector<AlignmentResult> by_surface(const SurfaceMap& seen) const;

  Rig rig_;
  FeaturesRelocalizerOptions options_;
  std::optional<Keyframes> keyframes_;
  Known color_, surface_;
  bool is_gathered_ = false;  ///< whether these are of the keyframes as they are
};

void register_features_relocalizer(Registry& registry);

}  // namespace pliant
