#pragma once

#include <numbers>
#include <optional>

#include "framework/core/angle.h"
#include "framework/registration/correspondence.h"

namespace pliant {

/// Which match a point gets and which it is denied. A point or pixel without a normal is judged by distance
/// alone.
struct ProjectiveOptions {
  double max_distance = 100;       ///< mm; a match further away is rejected
  double max_angle = 75 * degree;  ///< radians; a match whose normals differ by more is rejected
  /// Radians between a point's normal and the way to the camera; a point turned further away cannot be seen
  /// and has no match.
  double max_view_angle = std::numbers::pi / 2;
  int search_radius =
      0;          ///< pixels in u and v in which another is looked for where a match is rejected; 0: none
  int steps = 0;  ///< of the walk from the projected pixel to the closest point; 0: the projected one it is
  int rim =
      0;  ///< pixels; a match so near to where the target ends or jumps in depth is rejected; 0: none is
  bool symmetric = false;  ///< planes half-way between both normals of a match, not those of the target
};

/// Matches a point with the target point at the pixel that it projects to [thesis 4.2], or goes on from
/// there.
class ProjectiveCorrespondence : public Correspondence {
 public:
  explicit ProjectiveCorrespondence(const ProjectiveOptions& options);

  void match(Device& device, const PointSet& moved, const Array<int>& selected, const SurfaceMap& target,
             Constraints& constraints) const override;
  void measure(Device& device, const PointSet& moved, const SurfaceMap& target,
               Array<float>& distances) const override;
  bool measures_matches() const override {
    return options_.search_radius == 0 && options_.steps == 0 && options_.rim == 0;
  }

  /// Plain C++ references.
  void match_reference(const PointSet& moved, const Array<int>& selected, const SurfaceMap& target,
                       Constraints& constraints) const;
  void measure_reference(const PointSet& moved, const SurfaceMap& target,
                         std::vector<float>& distances) const;

 private:
  /// Pixels around one without a target point in which another is taken in its place: a walk may begin there,
  /// and a target with holes is no target that is missed.
  int hole_radius() const { return options_.steps > 0 ? 1 : 0; }

  using Pixel = std::optional<std::size_t>;
  Pixel match_point(const SurfaceMap& target, const Eigen::Vector3f& point,
                    const Eigen::Vector3f& normal) const;
  std::size_t walk(const SurfaceMap& target, const Eigen::Vector3f& point, std::size_t pixel) const;
  Pixel search(const SurfaceMap& target, const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
               int radius) const;
  bool is_facing(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) const;
  bool is_rim(const SurfaceMap& target, std::size_t pixel) const;
  bool accepts(const SurfaceMap& target, std::size_t pixel, const Eigen::Vector3f& point,
               const Eigen::Vector3f& normal) const;

  ProjectiveOptions options_;
  float max_distance_;
  float least_cosine_;
  float least_facing_;
};

}  // namespace pliant
