#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/modeller/field.h"
#include "experiments/modeller/figure.h"

namespace pliant {

/// Who a head is, and where things are in its face (mm; x towards its left, y = 0 at the height of its eyes).
/// Points are of the left half.
struct HeadMeasures {
  explicit HeadMeasures(const Parameters& identity);

  double half_width;      ///< of the skull
  double jaw;             ///< half the width between the corners of the jaw
  double brow;            ///< how far the brow stands out
  double cheek_fullness;  ///< how far cheeks are filled out
  double lips;            ///< thickness, 1 is the usual one
  double chin;            ///< how far the chin stands out
  Eigen::Vector3d eye;    ///< middle of the eyeball
  Eigen::Vector3d nose_tip;
  Eigen::Vector3d mouth;   ///< middle of the line between the lips
  Eigen::Vector3d corner;  ///< of the mouth
};

/// The mouth is modelled open as this field closes it, so that the lips are surfaces of their own.
VectorField mouth_closing(const HeadMeasures& head);

/// What the face can do. `points` are those of the head as it is modelled.
std::vector<MorphTarget> head_targets(const HeadMeasures& head, const std::vector<Eigen::Vector3d>& points);

std::vector<NamedPose> head_poses();

}  // namespace pliant
