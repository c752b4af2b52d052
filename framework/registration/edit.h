#pragma once

#include <string>
#include <utility>
#include <vector>

#include "framework/device/device.h"
#include "framework/geometry/frame.h"
#include "framework/registration/handle.h"
#include "framework/registration/nonrigid_method.h"
#include "framework/registration/nonrigid_result.h"

namespace pliant {

/// What came of bending a surface by handles. Vectors over points follow the order of `source`.
struct EditResult {
  Surface source;
  std::vector<Eigen::Vector3f> points;   ///< mm, as bent
  std::vector<Eigen::Vector3f> normals;  ///< of `points`
  std::vector<Eigen::Vector3f> node_positions;
  std::vector<GraphCell> graph_cells;

  /// How far the points that a handle holds are from where it wants them, mm.
  struct HandleFit {
    std::string name;
    int points = 0;
    double initial_mean = 0;
    double mean = 0;
    double max = 0;
  };
  std::vector<HandleFit> handles;
  HandleFit all_handles() const;

  NonRigidResult::Counts counts;  ///< there are no outer iterations: nothing is matched
  NonRigidResult::Energy energy;  ///< per iteration of the solver
  NonRigidResult::SolverRecord solver;
  std::vector<std::string> warnings;  ///< of the pair, then what was done otherwise than asked for
  double total_ms = 0;
  StageTimes time_ms;
};

using NamedHandles = std::vector<std::pair<std::string, Handle>>;

/// Bends the source of a pair by handles [Sumner et al. 2007]: the problem of a registration, with the points
/// that handles hold as its constraints, minimised once from the identity. Of the method this uses graph,
/// transform, energies and solver; the target plays no part. Throws ConfigError for a handle that holds
/// nothing, DataError when graph or source give too little to work with, NumericalError when there is no
/// finite answer.
EditResult edit_surface(const FramePair& pair, const NamedHandles& handles, const NonRigidMethod& method,
                        Device& device);

/// The problem that edit_surface solves, at its start.
std::unique_ptr<Problem> make_edit_problem(const FramePair& pair, const NamedHandles& handles,
                                           const NonRigidMethod& method, Device& device);

/// The points of the source of a pair. Throws DataError when there is none, and as check_source does.
Surface source_surface(const FramePair& pair);

}  // namespace pliant
