#pragma once

#include <utility>
#include <vector>

#include "framework/device/array.h"

namespace pliant {

/// Some of the points of a surface, chosen once or anew wherever the surface does not yet fit.
class PointSelection {
 public:
  virtual ~PointSelection() = default;

  /// Indices of points of the surface, ascending, without repetition.
  virtual const std::vector<int>& points() const = 0;

  /// How much each of `points` weighs; empty: all the same.
  virtual std::vector<float> weights() const { return {}; }

  /// Chooses anew from how far each point of the surface lies from its target: `residuals`, mm, one a point,
  /// negative where it is not known. Returns whether the selection changed.
  virtual bool adapt(Device& device, const Array<float>& residuals) = 0;

  /// Whether adapt() never changes anything, so that nobody needs to know the residuals.
  virtual bool is_fixed() const { return false; }
};

/// A selection (of whichever kind) that never changes.
template <class Selection>
class FixedSelection : public Selection {
 public:
  explicit FixedSelection(std::vector<int> points) : points_(std::move(points)) {}
  const std::vector<int>& points() const override { return points_; }
  bool adapt(Device&, const Array<float>&) override { return false; }
  bool is_fixed() const override { return true; }

 private:
  std::vector<int> points_;
};

}  // namespace pliant
