#pragma once

#include <cstdint>
#include <vector>

#include "experiments/training/head_views.h"
#include "experiments/training/tree_growth.h"
#include "framework/core/parameters.h"
#include "framework/pose/head_forest.h"

namespace pliant {

/// How a forest is trained.
struct HeadForestTraining {
  std::uint64_t seed = 1;
  int heads = 16;         ///< identities
  int views = 3000;       ///< of heads
  int other_views = 300;  ///< of what is no head
  HeadViewOptions view;

  /// Of one of the forest's two kinds of trees.
  struct Trees {
    int count;
    int patches;  ///< of a head, in each view
    GrowthOptions growth;
  };
  Trees voting{5, 16, {.tests = 150, .looked_at = 1200, .least_patches = 20, .greatest_depth = 16}};
  Trees refining{12, 20, {.tests = 200, .looked_at = 2000, .least_patches = 10, .greatest_depth = 14}};
  double share = 0.6;  ///< of all patches that each tree sees
};

/// The keys of a file that says how, each with a default, and what they say.
ParameterTable head_forest_training_table();
HeadForestTraining read_head_forest_training(const Parameters& values);

/// What trees are grown on.
struct HeadPatches {
  std::vector<TrainingPatch> voting;    ///< of heads, and half as many of what is no head
  std::vector<TrainingPatch> refining;  ///< of poses beside the true one, and how to get there
};

/// Renders heads, on all processors.
HeadPatches draw_head_patches(const HeadForestTraining& training);

/// Grows a forest, on all processors. The same training gives the same bits, however many there are.
HeadForest grow_head_forest(const HeadPatches& patches, const HeadForestTraining& training);

}  // namespace pliant
