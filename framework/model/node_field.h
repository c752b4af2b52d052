#pragma once

#include <Eigen/Geometry>
#include <utility>
#include <vector>

#include "framework/deformation/skinning.h"
#include "framework/device/array.h"

namespace pliant {

/// Nodes that move the points around them [Eq. 4.1], at rest in one frame of reference (mm), each with an
/// affine form (see warp.h). On one device.
class NodeField {
 public:
  bool empty() const { return positions_.empty(); }
  const std::vector<Eigen::Vector3f>& positions() const { return positions_; }  ///< of the nodes, mm
  const Array<float>& points() const { return points_; }                        ///< the same, x y z each
  const Array<float>& affine() const { return affine_; }  ///< affine_size numbers a node
  int nearest_nodes() const { return nearest_nodes_; }    ///< k of [Eq. 4.1]

  /// Adds those points of a surface (mm) as nodes that are further than `spacing` (mm) from all nodes so far,
  /// and a good part of it from one another: in order, the first ones first. They begin as the field moves
  /// what is there, so that a motion common to all nodes goes on. Waits for the device where it adds some.
  void grow(Device& device, const std::vector<Eigen::Vector3f>& surface, double spacing);

  /// Gives all nodes their forms; only enqueues. Throws std::invalid_argument unless there is one a node.
  void take(const Array<float>& affine, int nearest_nodes);

  /// The same field as another frame sees it; only enqueues.
  NodeField seen_from(Device& device, const Eigen::Isometry3d& other_from_this) const;

  Influences influences(Device& device, const Array<float>& points) const {
    return compute_influences(device, points, positions_, nearest_nodes_);
  }

 private:
  std::vector<Eigen::Vector3f> positions_;
  Array<float> points_, affine_;
  int nearest_nodes_ = 4;
};

/// The affine forms of nodes in a frame that is turned against theirs. Only enqueues.
Array<float> turned_forms(Device& device, const Array<float>& affine, const Eigen::Matrix3d& other_from_this);

/// The affine forms of nodes (at rest, mm) whose deformation is followed by a motion of all, in the same
/// frame. Waits for the device.
Array<float> moved_forms(const Array<float>& affine, const std::vector<Eigen::Vector3f>& nodes,
                         const Eigen::Isometry3d& motion);

/// Points that a field moves, x y z each, mm, in its frame.
class CarriedPoints {
 public:
  CarriedPoints() = default;
  explicit CarriedPoints(Array<float> rest) : rest_(std::move(rest)), moved_(rest_.size()) {}

  /// Moves them as the field is now; a field may grow from one call to the next, and must not be another one.
  /// Only enqueues.
  void move(Device& device, const NodeField& field);
  const Array<float>& rest() const { return rest_; }
  /// Where they are: at rest before the first move().
  const Array<float>& now() const { return nodes_ == 0 ? rest_ : moved_; }

 private:
  Array<float> rest_, moved_;
  Influences influences_;
  std::size_t nodes_ = 0;  // that these are of
  int nearest_nodes_ = 0;  // likewise
};

/// Where points were at rest that the field has moved to `moved` (mm, x y z each): by a fixed-point
/// iteration, which converges where the field turns and stretches what is around a point by less than about
/// 45 degrees or three quarters. Only enqueues.
Array<float> points_at_rest(Device& device, const NodeField& field, const Array<float>& moved);

}  // namespace pliant
