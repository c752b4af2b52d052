#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "experiments/report/view_data.h"
#include "framework/deformation/node_selection.h"
#include "framework/geometry/image.h"
#include "framework/geometry/surface.h"

namespace pliant {

/// Every n-th pixel of every n-th row of a surface, for small pictures of it.
class ThinnedSurface {
 public:
  /// The finest one of at most `most` points (at least one row and column are left).
  ThinnedSurface(const Surface& surface, std::size_t most);

  std::size_t size() const { return kept_.size(); }
  const std::vector<Eigen::Vector3i>& triangles() const { return triangles_; }

  /// What the surface's points have, of those that are left.
  template <class T>
  std::vector<T> of(const std::vector<T>& values) const {
    std::vector<T> some;
    some.reserve(kept_.size());
    for (const std::size_t index : kept_) some.push_back(values[index]);
    return some;
  }

  /// The rim of a cell, along the points that are left.
  ViewData::Outline outline(const GraphCell& cell) const;

 private:
  int step_ = 1;
  std::vector<std::size_t> kept_;
  std::vector<Eigen::Vector3i> triangles_;
  Image<int> indices_;  ///< of the points that are left, at every step_-th pixel; -1 where there is none
};

}  // namespace pliant
