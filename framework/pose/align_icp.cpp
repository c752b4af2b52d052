#include "framework/pose/align_icp.h"

#include <fmt/format.h>

#include <memory>

#include "framework/core/angle.h"
#include "framework/core/error.h"
#include "framework/geometry/has_point.h"

namespace pliant {
namespace {

/// The pixels of every fourth row and column that have a point, as offsets in a window that holds all of
/// them.
Array<int> pixels_on_grid(const Frame& frame, const PixelWindow& window) {
  std::vector<int> pixels;
  for (int v = 2; v < frame.depth.height(); v += 4)
    for (int u = 2; u < frame.depth.width(); u += 4)
      if (has_point(frame, u, v)) pixels.push_back(static_cast<int>(window.offset(u, v)));
  return Array<int>(std::move(pixels));
}

class IcpAlignment : public Alignment {
 public:
  explicit IcpAlignment(const RigidIcpOptions& options) : options_(options) {}

  AlignmentResult align(const AlignmentInput& input) const override {
    const RigidIcpResult found = run_icp(input, options_, Eigen::Isometry3d::Identity());
    if (found.failed)
      throw DataError(fmt::format("{}: alignment `icp` failed: {}", input.pair.name, found.reason));
    AlignmentResult result;
    result.reason = described(found);
    if (!is_clearly_nearer(found)) {
      result.reason += ": not clearly nearer, so the source stays";
      return result;
    }
    result.motion = found.pose;
    result.method = "icp";
    return result;
  }

 private:
  RigidIcpOptions options_;
};

}  // namespace

RigidIcpResult run_icp(const AlignmentInput& input, const RigidIcpOptions& options,
                       const Eigen::Isometry3d& start) {
  const Array<int> target_pixels = pixels_on_grid(input.pair.target, input.target.window);
  return RigidIcp(input.device, options)
      .align({input.source, input.source_pixels}, {input.target, target_pixels}, start);
}

bool is_clearly_nearer(const RigidIcpResult& result) {
  constexpr double least_gain = 1.0 / 3;
  return !result.failed && result.after.mean < (1 - least_gain) * result.before.mean;
}

bool is_nearer(const RigidIcpResult& result) {
  return !result.failed && result.after.mean < result.before.mean;
}

std::string described(const RigidIcpResult& result) {
  if (result.failed) return "ICP failed: " + result.reason;
  return fmt::format("ICP: two-way residual {:.2f} -> {:.2f} mm, {} of {} points match to {:.2f} mm{}{}",
                     result.before.mean, result.after.mean, result.inliers, result.samples, result.mean_error,
                     result.reason.empty() ? "" : ", ", result.reason);
}

std::vector<Parameter> icp_rows() {
  const RigidIcpOptions defaults;
  return {
      real("max_distance", defaults.max_distance)
          .unit("mm")
          .above(0)
          .doc("Matches further apart are rejected"),
      real("max_angle", 20)
          .unit("degree")
          .range(0, 180)
          .doc("Matches whose normals differ by more are rejected"),
      integer("step", defaults.step)
          .range(1, 1000000)
          .doc("Every so-many-th point of the source is matched; 1: all"),
      integer("levels", defaults.levels)
          .range(1, 10)
          .doc("From coarse to fine, each with a quarter of the next one's points"),
      integer("iterations", defaults.iterations).range(1, 1000).doc("At most, in each level"),
      real("coarse_distance", defaults.coarse_distance)
          .at_least(0)
          .doc("max_distance of the coarsest level, in extents of the source (root mean square distance of "
               "its points from their mean)"),
      real("coarse_angle", 75).unit("degree").range(0, 180).doc("max_angle of the coarsest level"),
      real("trim", defaults.trim)
          .at_least(0)
          .doc(
              "In the last level matches are rejected too whose distance to the plane is more than this many "
              "root mean squares of those accepted before: what deforms does not pull at the rest; 0: none"),
      real("search_angle", 30)
          .unit("degree")
          .range(0, 90)
          .doc("Starts are tried that put the middle of the source on the target's, unturned and turned by "
               "this, and by twice this, about each axis; 0: only where it is"),
  };
}

RigidIcpOptions read_icp_options(const Parameters& section) {
  RigidIcpOptions options;
  options.max_distance = section.real("max_distance");
  options.max_angle = section.real("max_angle") * degree;
  options.step = static_cast<int>(section.integer("step"));
  options.levels = static_cast<int>(section.integer("levels"));
  options.iterations = static_cast<int>(section.integer("iterations"));
  options.coarse_distance = section.real("coarse_distance");
  options.coarse_angle = section.real("coarse_angle") * degree;
  options.trim = section.real("trim");
  options.search_angle = section.real("search_angle") * degree;
  return options;
}

void register_icp_alignment(Registry& registry) {
  registry.add<Alignment>(
      "icp",
      "Rigid ICP by depth alone: projective matches, point to plane, coarse to fine [thesis 3.3]. Where it "
      "lowers the two-way residual by less than a third, as of an object that only deforms, the source stays",
      ParameterTable(icp_rows()), [](const Parameters& parameters, const Registry&) {
        return std::make_unique<IcpAlignment>(read_icp_options(parameters));
      });
}

}  // namespace pliant
