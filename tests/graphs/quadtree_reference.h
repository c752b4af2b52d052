#pragma once

#include <memory>
#include <vector>

#include "framework/deformation/node_selection.h"
#include "framework/geometry/surface.h"
#include "graphs/quadtree/quadtree.h"

namespace pliant {

/// [Alg. 1-3] as a tree of cells that own their children.
class QuadtreeReference {
 public:
  /// `settings.levels` must leave at least a pixel to each cell. `surface` must outlive the tree.
  QuadtreeReference(const QuadtreeGraph::Settings& settings, const Surface& surface);
  ~QuadtreeReference();

  void adapt(const std::vector<float>& residuals);

  /// Nodes of the leaves, ascending.
  std::vector<int> points() const;
  /// Of the leaves, by level, within a level in Morton order.
  std::vector<GraphCell> cells() const;

 private:
  struct Cell;
  struct Root {
    int left, top, side;
  };

  Root enclose() const;
  std::unique_ptr<Cell> make_cell(int level, int column, int row) const;
  std::vector<std::unique_ptr<Cell>> make_children(const Cell& cell) const;
  double mean_residual(const Cell& cell, const std::vector<float>& residuals) const;
  void grow(Cell& cell, int levels) const;
  void refine(Cell& cell, const std::vector<float>& residuals) const;
  void collapse(Cell& cell, const std::vector<float>& residuals) const;

  QuadtreeGraph::Settings settings_;
  const Surface& surface_;
  Root root_;
  std::unique_ptr<Cell> whole_;  ///< level 0, always divided
};

}  // namespace pliant
