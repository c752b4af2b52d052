#pragma once

#include "framework/registration/correspondence.h"

namespace pliant {

/// Matches a point with the target point at the pixel that it projects to [thesis 4.2].
class ProjectiveCorrespondence : public Correspondence {
 public:
  /// A match further than `max_distance` (mm), or whose normals differ by more than `max_angle` (radians),
  /// is rejected. A point or pixel without a normal is judged by distance alone.
  ProjectiveCorrespondence(double max_distance, double max_angle);

  void match(Device& device, const PointSet& moved, const Array<int>& selected, const Target& target,
             Constraints& constraints) const override;

  /// Plain C++ reference of `match`.
  void match_reference(const PointSet& moved, const Array<int>& selected, const Target& target,
                       Constraints& constraints) const;

 private:
  float max_distance_;
  float least_cosine_;
};

}  // namespace pliant
