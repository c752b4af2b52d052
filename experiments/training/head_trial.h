#pragma once

#include <cstdint>
#include <vector>

#include "experiments/training/head_views.h"
#include "framework/pose/head_search.h"

namespace pliant {

/// How a forest does on views whose truth is known.
struct HeadTrial {
  int views = 0;
  int found = 0;
  // Of each head that was found:
  std::vector<double> position;         ///< mm from its true centre
  std::vector<Eigen::Vector3d> angles;  ///< degrees, without sign: yaw, pitch, roll
  std::vector<double> rotation;         ///< degrees: the angle of the rotation between
  std::vector<double> milliseconds;     ///< of every search
};

/// Figures of heads whose identities are drawn at random.
std::vector<Figure> random_heads(int count, std::uint64_t seed, std::uint64_t stream);

/// Searches `count` views that are drawn for it. `without_mean_offset`: of heads whose own centre and
/// direction are other than those of the forest's heads, what is constant is taken out first.
HeadTrial try_head_forest(const HeadForest& forest, const HeadSearchOptions& options, const HeadViews& views,
                          int count, std::uint64_t seed, bool without_mean_offset = false);

/// Mean, and what 95 of 100 stay below.
struct MeanAndMost {
  double mean = 0;
  double most = 0;
};
MeanAndMost mean_and_most(std::vector<double> values);

}  // namespace pliant
