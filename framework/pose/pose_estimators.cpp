#include <memory>

#include "framework/core/angle.h"
#include "framework/pose/pose_estimator.h"
#include "framework/pose/projective_icp.h"

namespace pliant {
namespace {

class ProjectiveIcpKind : public PoseEstimatorKind {
 public:
  explicit ProjectiveIcpKind(const ProjectiveIcpOptions& options) : options_(options) {}
  std::unique_ptr<PoseEstimator> make(Device& device) const override {
    return std::make_unique<ProjectiveIcp>(device, options_);
  }

 private:
  ProjectiveIcpOptions options_;
};

ParameterTable icp_table() {
  const ProjectiveIcpOptions options;
  return {
      real("max_distance", options.max_distance)
          .unit("mm")
          .above(0)
          .doc("matches further apart are rejected"),
      real("noise", options.noise)
          .at_least(0)
          .doc("matches may be further apart by so many standard deviations of a structured-light camera's "
               "depth, which is more than 10 mm beyond 1.5 m; 0: they may not"),
      real("max_angle", whole_degrees(options.max_angle))
          .unit("degree")
          .range(0, 180)
          .doc("matches whose normals differ by more are rejected"),
      integer("levels", options.levels)
          .range(1, 6)
          .doc("from coarse to fine; the last one takes all points, each before half as many in u and v"),
      integer("iterations", options.iterations).range(1, 1000).doc("at most, in each level"),
      real("coarse_distance", options.coarse_distance)
          .unit("mm")
          .above(0)
          .doc("max_distance of the coarsest level; those between by equal factors"),
      real("coarse_angle", whole_degrees(options.coarse_angle))
          .unit("degree")
          .range(0, 180)
          .doc("max_angle of the coarsest level; those between by equal steps"),
      real("tolerance", options.tolerance)
          .unit("mm")
          .above(0)
          .doc("a shorter step ends the last level, and one longer by as much as it reaches further the "
               "others"),
      real("damping", options.damping)
          .range(0, 1)
          .doc(
              "pull to the start, as a share of what an average direction is told: what the surface does not "
              "tell stays there"),
      real("min_overlap", options.min_overlap)
          .range(0, 1)
          .doc("failed where a smaller share of the model's points meets a point of the frame"),
      real("min_inliers", options.min_inliers)
          .range(0, 1)
          .doc("failed where a smaller share of these has an accepted match"),
      real("max_shift", options.max_shift)
          .unit("mm")
          .above(0)
          .doc("failed where both the camera and the middle of the model moved further than that"),
      real("max_turn", whole_degrees(options.max_turn))
          .unit("degree")
          .range(0, 180)
          .doc("failed where it turned further than that"),
  };
}

ProjectiveIcpOptions read_icp(const Parameters& section) {
  ProjectiveIcpOptions options;
  options.max_distance = section.real("max_distance");
  options.noise = section.real("noise");
  options.max_angle = section.real("max_angle") * degree;
  options.levels = static_cast<int>(section.integer("levels"));
  options.iterations = static_cast<int>(section.integer("iterations"));
  options.coarse_distance = section.real("coarse_distance");
  options.coarse_angle = section.real("coarse_angle") * degree;
  options.tolerance = section.real("tolerance");
  options.damping = section.real("damping");
  options.min_overlap = section.real("min_overlap");
  options.min_inliers = section.real("min_inliers");
  options.max_shift = section.real("max_shift");
  options.max_turn = section.real("max_turn") * degree;
  return options;
}

}  // namespace

void register_pose_estimators(Registry& registry) {
  registry.add<PoseEstimatorKind>(
      "icp_projective",
      "ICP of the model as it was seen last against the frame: all points, matched by pixel, point to plane "
      "[thesis 3.3]",
      icp_table(), [](const Parameters& section, const Registry&) {
        return std::make_unique<ProjectiveIcpKind>(read_icp(section));
      });
}

}  // namespace pliant
