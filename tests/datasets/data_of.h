#pragma once

#include <memory>
#include <string>

#include "experiments/datasets/frame_source.h"

namespace pliant::test {

/// The frame source that a section of an experiment file describes, e.g. "{type: synthetic_sheet, noise: 1}".
std::unique_ptr<FrameSource> data_of(const std::string& section);

/// The device that the tests of a program share.
Device& shared_device();

/// The first two frames of a source and what is known of them.
struct LoadedPair : FramePair {
  std::optional<PairTruth> truth;
  const Eigen::Vector3f& motion(int u, int v) const { return truth.value().scene_flow(u, v); }
};
LoadedPair load(const FrameSource& source, std::uint64_t seed);

/// Pixels that have depth.
int count_points(const DepthImage& depth);

/// The message of the ConfigError that this throws, "" with a failure when it throws none.
std::string config_error_of(const std::string& section);

}  // namespace pliant::test
