#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/deformation/graph.h"
#include "framework/device/array.h"

namespace pliant {

/// Which nodes move each point, and how much: `per_point` entries a point, stored point by point, the
/// nearest node first. The weights of a point sum to one.
struct Influences {
  int per_point = 0;
  Array<int> nodes;
  Array<float> weights;
};

/// Most nodes that may influence one point.
inline constexpr int max_influences = 16;

/// Weights of [Eq. 4.7] (Sumner et al. 2007): w_j(p) = (1 - |p - g_j| / d_max)^2 over the k nearest
/// nodes, d_max the distance to the (k+1)-th, normalised. Points in which all k nodes lie at d_max get
/// equal weights. A graph of `nearest` nodes or fewer moves every point by all of them; d_max is then twice
/// the distance to the farthest, so that each weighs something.
/// `points`: x y z per point, mm. Throws DataError when there is no node.
Influences compute_influences(Device& device, const Array<float>& points,
                              const std::vector<Eigen::Vector3f>& nodes, int nearest);

/// The influences of some of the points: `points` are indices of those that `influences` tells of. Its nodes
/// are picked on the host, where the structure of a problem is made of them, its weights on the device.
Influences pick_influences(Device& device, const Influences& influences, const Array<int>& points);

/// Plain C++ reference of compute_influences; the tests hold both together.
Influences compute_influences_reference(const std::vector<float>& points,
                                        const std::vector<Eigen::Vector3f>& nodes, int nearest);

/// Sumner's neighbourhood: two nodes are neighbours when they influence a common point.
std::vector<Edge> find_edges(const Influences& influences, int node_count);

}  // namespace pliant
