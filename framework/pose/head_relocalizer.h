#pragma once

#include <vector>

#include "framework/pose/head_search.h"
#include "framework/pose/relocalizer.h"

namespace pliant {

/// The forest that comes with Pliant: framework/pose/head.forest, see docs/relocalisation.md.
HeadForest own_head_forest();

/// Which of several motions that should be one they agree upon: the mean of those that are near to the one
/// that is nearest to all. At least one.
Eigen::Isometry3d agreed_motion(const std::vector<Eigen::Isometry3d>& motions);

/// Finds a model that is a head by a HeadForest: where it sees the head, there the model is, as far from it
/// as in the frames that were tracked.
class HeadRelocalizer : public Relocalizer {
 public:
  /// `every`: one frame in so many is looked at to learn where the model's head is.
  HeadRelocalizer(std::shared_ptr<const HeadForest> forest, const HeadSearchOptions& options, int every);

  void remember(const Frame& frame, const SurfaceMap& seen,
                const Eigen::Isometry3d& camera_from_model) override;
  /// At most one.
  std::vector<Eigen::Isometry3d> candidates(const Frame& frame, const SurfaceMap& seen) override;

 private:
  std::optional<HeadEstimate> find(const SurfaceMap& seen) const;

  std::shared_ptr<const HeadForest> forest_;
  HeadSearchOptions options_;
  int every_;
  int frames_ = 0;                                  // that were tracked
  std::vector<Eigen::Isometry3d> head_from_model_;  // the latest ones
};

void register_head_relocalizer(Registry& registry);

}  // namespace pliant
