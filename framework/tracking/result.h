#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/surface.h"
#include "framework/pose/alignment.h"
#include "framework/registration/nonrigid_result.h"

namespace pliant {

/// What the registration of a pair came to. Vectors over points follow the order of `source`; points without
/// another word are those after non-rigid registration.
struct RegistrationResult : NonRigidResult {
  Surface source;                               ///< as given, before any alignment
  std::vector<Eigen::Vector3f> aligned_points;  ///< mm, after the initial alignment
  AlignmentResult alignment;
  double total_ms = 0;
};

}  // namespace pliant
