#pragma once

#include <Eigen/Core>
#include <vector>

namespace pliant {

/// Two nodes whose motions must agree; directed: `from` predicts where `to` goes [Eq. 4.4].
struct Edge {
  int from = 0;
  int to = 0;
  bool operator==(const Edge&) const = default;
};

/// The deformation graph of embedded deformation [thesis 4.1]: nodes on the source surface, each of which
/// will carry a transform. Positions in mm in the camera's frame.
struct DeformationGraph {
  std::vector<Eigen::Vector3f> nodes;
  std::vector<Edge> edges;  ///< both directions of every neighbourhood, sorted by (from, to)
};

}  // namespace pliant
