#pragma once

#include <Eigen/Core>
#include <set>
#include <utility>
#include <vector>

#include "framework/deformation/node_selection.h"
#include "framework/registration/nonrigid.h"

namespace pliant {

/// Keeps what some of the outer iterations came to: mm, camera frame. Vectors over points follow the order of
/// the source.
class IterationRecorder {
 public:
  struct Graph {
    std::vector<int> nodes;  ///< indices of points
    std::vector<Edge> edges;
    std::vector<GraphCell> cells;
  };
  struct Iteration {
    int number = 0;
    std::vector<Eigen::Vector3f> points;  ///< as they are moved then
    std::size_t graph = 0;                ///< which of graphs()
    /// Those with a match: where the point is then, and where its match was before.
    std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>> constraints;
  };

  /// `numbers`: of the iterations that are kept, 1 for the first.
  IterationRecorder(Device& device, std::set<int> numbers) : device_(device), numbers_(std::move(numbers)) {}

  /// Refers to this.
  Observer observer();

  const std::vector<Eigen::Vector3f>& rest() const {
    return rest_;
  }                                                             ///< what was moved; empty without iterations
  const std::vector<Graph>& graphs() const { return graphs_; }  ///< the first one, and each that is another
  const std::vector<Iteration>& iterations() const { return iterations_; }

 private:
  void keep_graph(const EmbeddedGraph& graph);
  void record(const IterationView& view);
  std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>> matched(const IterationView& view) const;

  Device& device_;
  std::set<int> numbers_;
  std::vector<Eigen::Vector3f> rest_;
  std::vector<Graph> graphs_;
  std::vector<Iteration> iterations_;
};

}  // namespace pliant
