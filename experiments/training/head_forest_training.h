#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiments/training/head_views.h"
#include "experiments/training/tree_growth.h"
#include "framework/core/parameters.h"
#include "framework/pose/head_forest.h"

namespace pliant {

/// How a forest is trained.
struct HeadForestTraining {
  std::uint64_t seed = 1;
  int heads = 24;          ///< identities
  int views = 3000;        ///< of heads
  int other_views = 300;   ///< of what is no head
  int patches = 24;        ///< of the head in a view, and half as many of what is no head
  int trees = 8;           ///< that vote
  int refining_trees = 12;
  int refining_patches = 12;  ///< of a view
  double patches_of_tree = 0.6;  ///< share of all that each tree sees
  GrowthOptions growth;
  GrowthOptions refining_growth;
  HeadViewOptions view;
};

ParameterTable head_forest_training_table();
HeadForestTraining read_head_forest_training(const Parameters& section);

/// What trees are grown on.
struct HeadPatches {
  std::vector<TrainingPatch> voting;
  std::vector<TrainingPatch> refining;
};
HeadPatches draw_head_patches(const HeadForestTraining& training);

/// Renders heads and trains a forest with them, on all processors. The same training gives the same bits,
/// however many processors there are. `tell`: of what is going on, a line each.
HeadForest grow_head_forest(const HeadPatches& patches, const HeadForestTraining& training);
HeadForest train_head_forest(const HeadForestTraining& training,
                             const std::function<void(const std::string&)>& tell);

}  // namespace pliant
