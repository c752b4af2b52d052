#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/core/stopwatch.h"
#include "framework/deformation/node_selection.h"
#include "framework/registration/nonrigid_method.h"

namespace pliant {

/// What a non-rigid registration came to. Vectors over points follow the order of the source.
struct NonRigidResult {
  std::vector<Eigen::Vector3f> points;   ///< mm, camera frame, deformed
  std::vector<Eigen::Vector3f> normals;  ///< of `points`
  /// Per point: whether it has a match at the end. What has none (hidden, cut off, too far) went with its
  /// neighbours.
  std::vector<std::uint8_t> matched;
  std::vector<Eigen::Vector3f> node_positions;  ///< mm, on the source at rest, of the graph that led here
  std::vector<GraphCell> graph_cells;           ///< of that graph; empty where it has none

  struct Counts {
    int source_points = 0;
    int matched_points = 0;
    int nodes = 0;
    int edges = 0;
    int constraints = 0;
    int unknowns = 0;  ///< 12 a node of transform `affine`, 6 of `quaternion`
    int outer_iterations = 0;
    int solver_iterations = 0;
  } counts;

  struct Energy {
    double initial = 0;
    double final = 0;
    std::vector<double> per_iteration;  ///< at the end of each outer iteration
  } energy;

  /// What was measured before the first and after each outer iteration: over all points of the source where
  /// nodes or constraints adapt to it, else over those that are constrained.
  struct Step {
    double residual_mean = 0;  ///< mm, of the accepted matches
    double robust = 0;         ///< mm, Residual::robust
    int matched = 0;           ///< points that have an accepted match at their pixel
  };
  std::vector<Step> history;
  int returned_iteration = 0;  ///< whose result this is: of those in `history` the one with least `robust`

  struct SolverRecord {
    std::string name;
    std::string linear_solver;
    std::string termination;  ///< of the last solve
  } solver;

  /// Why the outer loop ended: "residual", "no_progress" or "max_iterations"; "no_constraints" or "no_nodes"
  /// when nothing was left to go on with; "failed" when an iteration had no finite answer. After the last
  /// three the result is that of the best iteration before.
  std::string termination;
  /// Of one of those three, in words; or that none of the iterations was better than the start.
  std::string reason;
  std::vector<std::string> warnings;  ///< what was done otherwise than asked for
  StageTimes time_ms;                 ///< see docs/results.md
};

/// What was done otherwise than the method asks for.
std::vector<std::string> warnings_of(const NonRigidMethod& method, const NonRigidResult::Counts& counts);

}  // namespace pliant
