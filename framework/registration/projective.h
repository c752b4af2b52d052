#pragma once

#include <optional>

#include "framework/registration/correspondence.h"

namespace pliant {

/// Matches a point with the target point at the pixel that it projects to [thesis 4.2] or, where that one is
/// rejected, with the nearest acceptable one around it: what projects beside the target's outline is drawn
/// in.
class ProjectiveCorrespondence : public Correspondence {
 public:
  /// A match further than `max_distance` (mm), or whose normals differ by more than `max_angle` (radians),
  /// is rejected. A point or pixel without a normal is judged by distance alone. `search_radius`: pixels in u
  /// and v within which another match is looked for; 0: none is.
  ProjectiveCorrespondence(double max_distance, double max_angle, int search_radius);

  void match(Device& device, const PointSet& moved, const Array<int>& selected, const Target& target,
             Constraints& constraints) const override;

  /// Of matches at the pixel that a point projects to alone: looking around for every point would cost more
  /// than the registration.
  void measure(Device& device, const PointSet& moved, const Target& target,
               Array<float>& distances) const override;

  /// Plain C++ reference of `measure`.
  void measure_reference(const PointSet& moved, const Target& target, std::vector<float>& distances) const;

  /// Plain C++ reference of `match`.
  void match_reference(const PointSet& moved, const Array<int>& selected, const Target& target,
                       Constraints& constraints) const;

 private:
  std::optional<std::size_t> match_point(const Target& target, const Eigen::Vector3f& point,
                                         const Eigen::Vector3f& normal) const;
  bool accepts(const Target& target, std::size_t pixel, const Eigen::Vector3f& point,
               const Eigen::Vector3f& normal) const;

  float max_distance_;
  float least_cosine_;
  int search_radius_;
};

}  // namespace pliant
