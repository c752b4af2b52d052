#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace pliant {

/// Points of the source (`from`) and of the target (`to`) that are believed to be the same, in mm.
struct PointMatches {
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  std::vector<float> confidence;  ///< of each, above 0 and at most 1: factor of its squared residual

  void add(const Eigen::Vector3d& source, const Eigen::Vector3d& target, float certainty = 1) {
    from.push_back(source);
    to.push_back(target);
    confidence.push_back(certainty);
  }

  std::size_t size() const { return from.size(); }
};

}  // namespace pliant
