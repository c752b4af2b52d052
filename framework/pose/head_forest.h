#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "framework/pose/depth_patch.h"

namespace pliant {

/// A question about a patch: whether one box of it lies by more than so much behind another.
struct PatchTest {
  CellBox first;
  CellBox second;
  float threshold = 0;  ///< mm

  float value(const DepthPatch& patch) const { return patch.mean(first) - patch.mean(second); }
  bool is_above(const DepthPatch& patch) const { return value(patch) > threshold; }
};

/// What the patches of training that ended in a leaf had in common.
struct HeadLeaf {
  float head_share = 0;  ///< how many of them were on a head
  // Of those on a head: mean, and the square root of the trace of the covariance.
  /// mm, from the patch's point to the head's centre, camera frame; of a refining tree from where it was
  /// taken to be, head's frame.
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();
  /// Radians: see head_rotation; of a refining tree the rotation from what it was taken to be: axis times
  /// angle.
  Eigen::Vector3f angles = Eigen::Vector3f::Zero();
  float offset_spread = 0;  ///< mm
  float angle_spread = 0;   ///< radians
};

/// A tree of questions. What a question leads to is the index of another, or ~index of a leaf.
struct HeadTree {
  struct Node {
    PatchTest test;
    int below = -1;  ///< where it goes on if the answer is no
    int above = -1;
  };
  std::vector<Node> nodes;  ///< begins with the first one; empty: there is only one leaf
  std::vector<HeadLeaf> leaves;

  const HeadLeaf& leaf_of(const DepthPatch& patch) const;
};

/// A random regression forest that tells from patches of a depth map where a head is and where it looks,
/// after Fanelli, Gall, Van Gool, "Real time head pose estimation with random regression forests", CVPR 2011,
/// and Fanelli, Weise, Gall, Van Gool, "Real time head pose estimation from consumer depth cameras", DAGM
/// 2011.
///
/// The forest has two kinds of trees. Those of the papers vote for centre and angles; on their patches the
/// place within the head is what tells most, and the angles come out coarsely. So others, grown in the same
/// way, are shown the head as it would look from the front if the pose were right, and tell by how much it is
/// not: asked again and again, they come close [after Dollar, Welinder, Perona, "Cascaded pose regression",
/// CVPR 2010].
struct HeadForest {
  std::vector<HeadTree> voting;    ///< of `patch_around`
  std::vector<HeadTree> refining;  ///< of `patch_of_head`
};

/// From the head's frame (x to its left, y up, z where it looks) to a camera's (x right, y down, z forward).
/// `angles`: yaw about the camera's y axis, after pitch about x, after roll about z; all are 0 where the head
/// looks straight into the camera.
Eigen::Matrix3d head_rotation(const Eigen::Vector3d& angles);
/// The angles of a rotation; yaw within pi, pitch within pi / 2.
Eigen::Vector3d head_angles(const Eigen::Matrix3d& camera_from_head);

/// A motion by mm, and about an axis by its length in radians.
Eigen::Isometry3d moved(const Eigen::Vector3d& offset, const Eigen::Vector3d& turn);

/// The bytes of a forest file, and back: little-endian, see head_forest_file.cpp. Numbers are rounded there
/// to 1/32 mm and 1e-4 radians.
std::vector<std::uint8_t> write_head_forest(const HeadForest& forest);
/// Throws DataError, which begins with `name`, when it is no such file, one of another version, truncated or
/// damaged.
HeadForest read_head_forest(const std::vector<std::uint8_t>& bytes, const std::string& name);

}  // namespace pliant
